//! Support functions of the host's own.
use crate::generated::Code;
use crate::{Error, Result};
use std::collections::BTreeMap;
use std::fmt;
use std::os::raw::c_void;
use std::panic::{catch_unwind, AssertUnwindSafe};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::Arc;

pub(crate) type SupportFunction = dyn Fn([f64; 3]) -> [f64; 3] + Send + Sync;

pub(crate) struct Support {
    function: Box<SupportFunction>,
    inside: [f64; 3],
    panicked: AtomicBool,
}

/// What the library calls while a simulation lives.
#[derive(Default)]
pub(crate) struct Supports {
    of_tools: BTreeMap<u32, Arc<Support>>,
    replaced: Vec<Arc<Support>>, // a change may still be on its way to a loop's thread
}

impl Support {
    pub(crate) fn new(function: Box<SupportFunction>, inside: [f64; 3]) -> Arc<Self> {
        Arc::new(Self { function, inside, panicked: AtomicBool::new(false) })
    }

    /// A panic may not pass through C: the point inside stands for the answer, and the next step tells.
    pub(crate) unsafe extern "C" fn call(context: *mut c_void, direction: *const f64, point: *mut f64) {
        let support = &*(context as *const Support);
        let direction = *(direction as *const [f64; 3]);
        let answer = catch_unwind(AssertUnwindSafe(|| (support.function)(direction))).unwrap_or_else(|_| {
            support.panicked.store(true, Ordering::Relaxed);
            support.inside
        });
        *(point as *mut [f64; 3]) = answer;
    }

    pub(crate) fn check(&self) -> Result<()> {
        if self.panicked.load(Ordering::Relaxed) {
            return Err(Error::new(Code::INTERNAL, "a tool's support function panicked"));
        }
        Ok(())
    }
}

impl Supports {
    /// Tool `tool` is known by `support` from now on, or by none.
    pub(crate) fn set(&mut self, tool: u32, support: Option<Arc<Support>>) {
        let before = match support {
            Some(support) => self.of_tools.insert(tool, support),
            None => self.of_tools.remove(&tool),
        };
        self.replaced.extend(before);
    }

    pub(crate) fn check(&self) -> Result<()> {
        self.of_tools.values().try_for_each(|support| support.check())
    }

    pub(crate) fn leak(&mut self) {
        std::mem::forget(std::mem::take(self));
    }
}

impl fmt::Debug for Supports {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} support functions", self.of_tools.len())
    }
}
