use crate::convert::string;
use crate::generated::RecordingInfo;
use crate::{check_version, Error, Result, Simulation};
use crumble_sys as sys;

/// A recording's file, opened to be looked at step by step.
#[derive(Debug)]
pub struct Recording {
    handle: sys::crumble_recording,
}

// crumble.h: [one], from any thread, by one at a time.
unsafe impl Send for Recording {}

impl Recording {
    pub fn load(path: &str) -> Result<Self> {
        check_version(sys::CRUMBLE_VERSION_NUMBER)?;
        let (path, mut handle) = (string("path", path)?, std::ptr::null_mut());
        Error::check(unsafe { sys::crumble_recording_load(path.as_ptr(), &mut handle) })?;
        Ok(Self { handle })
    }

    pub fn info(&self) -> Result<RecordingInfo> {
        let mut c = sys::crumble_recording_info::default();
        Error::check(unsafe { sys::crumble_recording_get_info(self.handle, &mut c) })?;
        Ok(RecordingInfo::from_c(&c))
    }

    /// The simulation as it was where the recording begins. It outlives the recording.
    pub fn create_sim(&self) -> Result<Simulation> {
        let mut handle = std::ptr::null_mut();
        Error::check(unsafe { sys::crumble_recording_create_sim(self.handle, &mut handle) })?;
        Ok(Simulation::of(handle))
    }

    /// Does step `step`, from 0, with all that the host did before it, and moves `sim` from where `step` - 1 left it.
    /// Whether it is then in the recorded state.
    pub fn step(&self, sim: &mut Simulation, step: u64) -> Result<bool> {
        let mut equal = 0;
        Error::check(unsafe { sys::crumble_recording_step(self.handle, sim.handle, step, &mut equal) })?;
        sim.supports.check()?;
        Ok(equal != 0)
    }
}

impl Drop for Recording {
    fn drop(&mut self) {
        unsafe { sys::crumble_recording_destroy(self.handle) };
    }
}
