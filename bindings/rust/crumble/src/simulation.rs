use crate::arrays::{copy_of, rows_of, Array, Row};
use crate::convert::{count, start, Strings};
use crate::generated::{
    AdvanceInfo, Code, Contact, Counters, Energy, Pose, Profile, SimDef, SimInfo, StepInfo, Wrench,
};
use crate::local_model::LocalModel;
use crate::support::Supports;
use crate::{Error, Mesh, Result};
use crumble_sys as sys;

/// One body, the tools and walls that touch it, and the step that a servo loop calls.
#[derive(Debug)]
pub struct Simulation {
    pub(crate) handle: sys::crumble_sim,
    pub(crate) supports: Supports,
}

// crumble.h: [one], from any thread, by one at a time.
unsafe impl Send for Simulation {}

/// One of C's structs that a function fills.
macro_rules! report {
    ($self:ident, $function:ident, $struct:ident, $report:ident) => {{
        let mut c = sys::$struct::default();
        Error::check(unsafe { sys::$function($self.handle, &mut c) })?;
        Ok($report::from_c(&c))
    }};
}

/// How many poses there are, when each has a wrench; else the wrenches are zero.
fn pairs(function: &str, poses: &[Pose], wrenches: &mut [Wrench]) -> Result<u32> {
    if poses.len() != wrenches.len() {
        wrenches.fill(Wrench::default());
        let text = format!("{function}: {} poses, but {} wrenches", poses.len(), wrenches.len());
        return Err(Error::new(Code::OUT_OF_RANGE, text));
    }
    count("poses", poses.len())
}

impl Simulation {
    /// A simulation of a body at rest, without tools and fixed nodes. The mesh may be dropped afterwards.
    pub fn create(mesh: &Mesh, def: &SimDef) -> Result<Self> {
        let mut strings = Strings::default();
        let c = def.as_c(&mut strings)?;
        let mut handle = std::ptr::null_mut();
        Error::check(unsafe { sys::crumble_sim_create(mesh.handle, &c, &mut handle) })?;
        Ok(Self::of(handle))
    }

    /// Of a handle that is nobody else's.
    pub(crate) fn of(handle: sys::crumble_sim) -> Self {
        Self { handle, supports: Supports::default() }
    }

    /// One tick of the servo loop for a simulation with exactly one tool and no attachment: the tool goes to `pose`,
    /// the body answers, time advances by tau. Returns what the body does to the tool, N and N m. Takes no memory
    /// except while recording.
    pub fn step(&mut self, pose: &Pose) -> Result<Wrench> {
        let mut wrench = Wrench::default();
        Error::check(unsafe { sys::crumble_sim_step(self.handle, pose, &mut wrench) })?;
        self.supports.check()?;
        Ok(wrench)
    }

    /// The same with one pose and one wrench per tool, and then one of each per attachment. On every error all
    /// wrenches are zero.
    pub fn step_tools(&mut self, poses: &[Pose], wrenches: &mut [Wrench]) -> Result<()> {
        let tools = pairs("step_tools", poses, wrenches)?;
        Error::check(unsafe {
            sys::crumble_sim_step_tools(self.handle, start(poses) as *const Pose, wrenches.as_mut_ptr(), tools)
        })?;
        self.check_supports(wrenches)
    }

    /// Several steps for a host whose frames are longer than one. In `steps` (1 to 100000) steps the tools go evenly
    /// from where they are to `poses`; `wrenches` receives the means, which times the time advanced are the impulses.
    /// At least one step is done, and another only while it can be expected to end within `budget` seconds of wall time
    /// (0: all of them); the report says how many were dropped. On every error all wrenches are zero.
    pub fn advance(&mut self, poses: &[Pose], wrenches: &mut [Wrench], steps: u32, budget: f64) -> Result<AdvanceInfo> {
        let tools = pairs("advance", poses, wrenches)?;
        let (first, mut c) = (start(poses) as *const Pose, sys::crumble_advance_info::default());
        Error::check(unsafe {
            sys::crumble_sim_advance(self.handle, first, wrenches.as_mut_ptr(), tools, steps, budget, &mut c)
        })?;
        self.check_supports(wrenches)?;
        Ok(AdvanceInfo::from_c(&c))
    }

    fn check_supports(&self, wrenches: &mut [Wrench]) -> Result<()> {
        self.supports.check().map_err(|error| {
            wrenches.fill(Wrench::default());
            error
        })
    }

    /// About the last step.
    pub fn step_info(&self) -> Result<StepInfo> {
        report!(self, crumble_sim_get_step_info, crumble_step_info, StepInfo)
    }

    /// Sums since the start.
    pub fn counters(&self) -> Result<Counters> {
        report!(self, crumble_sim_get_counters, crumble_counters, Counters)
    }

    /// Wall time of each stage of the last step, s.
    pub fn profile(&self) -> Result<Profile> {
        report!(self, crumble_sim_get_profile, crumble_profile, Profile)
    }

    /// The books of the energy audit, J, with [`SimDef::energy_audit`].
    pub fn energy(&self) -> Result<Energy> {
        report!(self, crumble_sim_get_energy, crumble_energy, Energy)
    }

    /// How steps are computed.
    pub fn info(&self) -> Result<SimInfo> {
        report!(self, crumble_sim_get_info, crumble_sim_info, SimInfo)
    }

    /// What the simulation was made with, changed by what was called since.
    pub fn def(&self) -> Result<SimDef> {
        report!(self, crumble_sim_get_def, crumble_sim_def, SimDef)
    }

    /// The nodes that tools, attachments and walls hold, in the order of holders, walls last.
    pub fn contacts(&self) -> Result<Vec<Contact>> {
        let mut count = 0;
        Error::check(unsafe { sys::crumble_sim_get_contacts(self.handle, std::ptr::null_mut(), 0, &mut count) })?;
        let mut contacts = vec![sys::crumble_contact::default(); count as usize];
        Error::check(unsafe { sys::crumble_sim_get_contacts(self.handle, contacts.as_mut_ptr(), count, &mut count) })?;
        Ok(contacts.iter().map(Contact::from_c).collect())
    }

    /// What the body does to tool `tool` near where it is; or, behind the tools, to an attachment.
    pub fn local_model(&self, tool: u32) -> Result<LocalModel> {
        let mut model = LocalModel::default();
        Error::check(unsafe { sys::crumble_sim_get_local_model(self.handle, tool, &mut model.0) })?;
        Ok(model)
    }

    /// Drag of the nodes that a tool or attachment holds, N s/m; never part of the force.
    pub fn held_drag(&self, tool: u32) -> Result<f64> {
        let mut drag = 0.0;
        Error::check(unsafe { sys::crumble_sim_get_held_drag(self.handle, tool, &mut drag) })?;
        Ok(drag)
    }

    /// An array of the simulation as the last step left it, without a copy.
    pub fn view<T: Row>(&self, which: Array<T>) -> Result<&[T]> {
        let mut view = sys::crumble_view::default();
        Error::check(unsafe { sys::crumble_sim_get_view(self.handle, which.number(), &mut view) })?;
        unsafe { rows_of(&view) } // valid until the next call that changes the simulation: all of these take &mut self
    }

    /// The same array as a copy.
    pub fn copy<T: Row>(&self, which: Array<T>) -> Result<Vec<T>> {
        copy_of(which, |which, dst, size, needed| unsafe {
            sys::crumble_sim_copy(self.handle, which, dst, size, needed)
        })
    }
}

impl Drop for Simulation {
    fn drop(&mut self) {
        // Refused while there is a loop that was forgotten: then what the library calls has to stay.
        if unsafe { sys::crumble_sim_destroy(self.handle) } != sys::CRUMBLE_OK {
            self.supports.leak();
        }
    }
}
