use crate::convert::{count, text, Strings};
use crate::generated::{HandDef, LoopDef, Pose};
use crate::looks::{Look, Looks};
use crate::{Device, Error, Monitor, Result, Simulation};
use crumble_sys as sys;
use std::ops::Deref;

/// The haptic loop: reads devices, moves tools, steps the body, and sends what is fit for a hand. It has its simulation
/// and devices to itself for as long as it exists. What is asked of a [`Monitor`] can be asked of a loop too.
#[derive(Debug)]
pub struct Loop<'a> {
    monitor: Monitor,
    // Never lent as &mut: swapped for others they could be changed by a tick while somebody looks.
    sim: &'a mut Simulation,
    devices: Vec<&'a mut Device>,
}

impl<'a> Loop<'a> {
    /// A loop that does not run yet. Each hand is one device that moves one tool.
    pub fn create(sim: &'a mut Simulation, def: &LoopDef, hands: Vec<(HandDef, &'a mut Device)>) -> Result<Self> {
        let mut strings = Strings::default();
        let c = def.as_c(&mut strings)?;
        let (mut c_hands, mut devices) = (Vec::new(), Vec::new());
        for (hand, device) in hands {
            c_hands.push(sys::crumble_hand_def { device: device.handle, ..hand.as_c(&mut strings)? });
            devices.push(device);
        }
        let number = count("hands", c_hands.len())?;
        let mut handle = std::ptr::null_mut();
        Error::check(unsafe { sys::crumble_loop_create(sim.handle, &c, c_hands.as_ptr(), number, &mut handle) })?;
        Ok(Self { monitor: Monitor { handle, looks: Looks::default() }, sim, devices })
    }

    /// For other threads.
    pub fn monitor(&self) -> Monitor {
        self.monitor.clone()
    }

    /// Begins to tick; hands wait as at the beginning.
    pub fn start(&mut self) -> Result<()> {
        Error::check(unsafe { sys::crumble_loop_start(self.handle) })
    }

    /// Returns when the last tick is over and every device has been sent zero.
    pub fn stop(&mut self) -> Result<()> {
        Error::check(unsafe { sys::crumble_loop_stop(self.handle) })
    }

    /// One tick, with [`Driver::HOST`](crate::Driver::HOST), with or without start.
    pub fn tick(&mut self) -> Result<()> {
        Error::check(unsafe { sys::crumble_loop_tick(self.handle) })
    }

    /// Where tool (or, behind the tools, attachment) `tool` stands, which no hand moves.
    pub fn place(&mut self, tool: u32, pose: &Pose) -> Result<()> {
        Error::check(unsafe { sys::crumble_loop_place(self.handle, tool, pose) })
    }

    /// What became of the thread's options, as "SCHED_FIFO 80", or why not.
    pub fn scheduling(&self) -> Result<String> {
        text(|dst, size, needed| unsafe { sys::crumble_loop_get_scheduling(self.handle, dst, size, needed) })
    }

    /// To look at while the loop does not run; else it is [`BUSY`](crate::Code::BUSY). Nobody can change what the
    /// simulation is before the look is dropped.
    pub fn sim(&self) -> Look<'_> {
        self.monitor.looks.look(self.sim)
    }

    /// The device of hand `hand`, likewise.
    pub fn device(&self, hand: usize) -> Option<&Device> {
        self.devices.get(hand).map(|device| &**device)
    }
}

// crumble.h: [one], from any thread, by one at a time.
unsafe impl Send for Loop<'_> {}

impl Deref for Loop<'_> {
    type Target = Monitor;

    fn deref(&self) -> &Monitor {
        &self.monitor
    }
}

impl Drop for Loop<'_> {
    fn drop(&mut self) {
        unsafe { sys::crumble_loop_destroy(self.handle) };
    }
}

impl LoopDef {
    /// The choices of the paper, for a loop and its hands.
    pub fn apply_paper_preset(&mut self, hands: &mut [HandDef]) -> Result<()> {
        let mut strings = Strings::default();
        let mut c = self.as_c(&mut strings)?;
        let mut c_hands = hands.iter().map(|h| h.as_c(&mut strings)).collect::<Result<Vec<_>>>()?;
        let number = count("hands", hands.len())?;
        Error::check(unsafe { sys::crumble_loop_apply_paper_preset(&mut c, c_hands.as_mut_ptr(), number) })?;
        *self = LoopDef::from_c(&c);
        for (hand, c) in hands.iter_mut().zip(&c_hands) {
            *hand = HandDef::from_c(c);
        }
        Ok(())
    }
}
