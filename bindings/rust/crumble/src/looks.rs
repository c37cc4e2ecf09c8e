//! Keeps changes by a monitor, which may be on any thread, away from views of a loop's simulation.
use crate::generated::Code;
use crate::{Error, Result, Simulation};
use std::ops::Deref;
use std::sync::{Arc, Mutex, MutexGuard};

/// How many look at a loop's simulation.
#[derive(Clone, Debug, Default)]
pub(crate) struct Looks(Arc<Mutex<u32>>);

/// A loop's simulation, to look at: see [`Loop::sim`](crate::Loop::sim).
#[derive(Debug)]
pub struct Look<'a> {
    sim: &'a Simulation,
    looks: &'a Looks,
}

impl Looks {
    pub(crate) fn look<'a>(&'a self, sim: &'a Simulation) -> Look<'a> {
        *self.count() += 1;
        Look { sim, looks: self }
    }

    /// Calls `make` while nobody looks. A change that is made at once may move the arrays that views show.
    pub(crate) fn change(&self, make: impl FnOnce() -> Result<()>) -> Result<()> {
        let count = self.count();
        if *count > 0 {
            return Err(Error::new(Code::BUSY, "the loop's simulation is being looked at"));
        }
        make()
    }

    fn count(&self) -> MutexGuard<'_, u32> {
        self.0.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }
}

impl Deref for Look<'_> {
    type Target = Simulation;

    fn deref(&self) -> &Simulation {
        self.sim
    }
}

impl Drop for Look<'_> {
    fn drop(&mut self) {
        *self.looks.count() -= 1;
    }
}
