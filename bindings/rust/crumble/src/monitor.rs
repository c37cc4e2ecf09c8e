use crate::convert::{text, Strings};
use crate::generated::{HandStatus, LoopStatus, LoopTimes, SimDef, ToolDef};
use crate::looks::Looks;
use crate::{Error, Result};
use crumble_sys as sys;

/// Looks at a loop, changes what its simulation is, and can take its forces away, from any thread, while it runs. The
/// loop never waits for it. When the loop is gone, every call is answered [`STALE_HANDLE`](crate::Code::STALE_HANDLE).
#[derive(Clone, Debug)]
pub struct Monitor {
    pub(crate) handle: sys::crumble_loop,
    pub(crate) looks: Looks,
}

// crumble.h: what is called here is [any], and a handle is looked up, never followed.
unsafe impl Send for Monitor {}
unsafe impl Sync for Monitor {}

impl Monitor {
    /// Whether the loop is between start and stop.
    pub fn is_running(&self) -> Result<bool> {
        let mut running = 0;
        Error::check(unsafe { sys::crumble_loop_is_running(self.handle, &mut running) })?;
        Ok(running != 0)
    }

    /// The loop as its last tick left it.
    pub fn status(&self) -> Result<LoopStatus> {
        let mut c = sys::crumble_loop_status::default();
        Error::check(unsafe { sys::crumble_loop_get_status(self.handle, &mut c) })?;
        Ok(LoopStatus::from_c(&c))
    }

    /// One hand as the last tick left it.
    pub fn hand(&self, hand: u32) -> Result<HandStatus> {
        let mut c = sys::crumble_hand_status::default();
        Error::check(unsafe { sys::crumble_loop_get_hand(self.handle, hand, &mut c) })?;
        Ok(HandStatus::from_c(&c))
    }

    pub fn times(&self) -> Result<LoopTimes> {
        let mut c = sys::crumble_loop_times::default();
        Error::check(unsafe { sys::crumble_loop_get_times(self.handle, &mut c) })?;
        Ok(LoopTimes::from_c(&c))
    }

    /// What in the definition may be felt as a fault of the loop: one of `LoopStatus::warning_count` texts.
    pub fn warning(&self, index: u32) -> Result<String> {
        text(|dst, size, needed| unsafe { sys::crumble_loop_get_warning(self.handle, index, dst, size, needed) })
    }

    /// Another definition of the simulation, made in this thread and taken over between two steps. Several changes are
    /// made in their order; while the loop does not run, at once: then [`BUSY`](crate::Code::BUSY) while somebody
    /// [looks](crate::Loop::sim) at the simulation. [`STATE`](crate::Code::STATE): what cannot change in mid-run, as
    /// tau; or 64 changes wait for a step.
    pub fn configure(&self, def: &SimDef) -> Result<()> {
        let mut strings = Strings::default();
        let c = def.as_c(&mut strings)?;
        self.looks.change(|| Error::check(unsafe { sys::crumble_loop_configure(self.handle, &c) }))
    }

    /// Another tool, of any shape but [`Tool::SUPPORT`](crate::Tool::SUPPORT), in the place of number `tool`, likewise.
    pub fn set_tool(&self, tool: u32, def: &ToolDef) -> Result<()> {
        let c = def.as_c(&mut Strings::default())?;
        self.looks.change(|| Error::check(unsafe { sys::crumble_loop_set_tool(self.handle, tool, &c) }))
    }

    /// Friction of a tool, likewise.
    pub fn set_friction(&self, tool: u32, static_friction: f64, dynamic_friction: f64) -> Result<()> {
        self.looks.change(|| {
            Error::check(unsafe {
                sys::crumble_loop_set_friction(self.handle, tool, static_friction, dynamic_friction)
            })
        })
    }

    /// No force on any hand from the next tick on, until its fault is reset.
    pub fn halt(&self) -> Result<()> {
        Error::check(unsafe { sys::crumble_loop_halt(self.handle) })
    }

    /// A hand that is faulted waits again from the next tick on, and gets its force back by the ramp.
    pub fn reset_fault(&self, hand: u32) -> Result<()> {
        Error::check(unsafe { sys::crumble_loop_reset_fault(self.handle, hand) })
    }
}
