use crate::{Error, Pose, Result, Wrench};
use crumble_sys as sys;
use std::ops::Deref;

/// What the body does to a tool near where it is, for a loop that runs faster than the steps: plain numbers, which may
/// go to another thread. Its fields are those of C's struct.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LocalModel(pub(crate) sys::crumble_local_model);

impl LocalModel {
    /// What the body does to the tool at `pose`, N and N m. Continuous in `pose`; no memory.
    pub fn evaluate(&self, pose: &Pose) -> Result<Wrench> {
        let mut wrench = Wrench::default();
        Error::check(unsafe { sys::crumble_local_model_evaluate(&self.0, pose, &mut wrench) })?;
        Ok(wrench)
    }
}

impl Deref for LocalModel {
    type Target = sys::crumble_local_model;

    fn deref(&self) -> &Self::Target {
        &self.0
    }
}
