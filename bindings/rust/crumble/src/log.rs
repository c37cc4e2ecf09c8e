//! What the library has to say.
use crate::generated::Log;
use crate::{Error, Result};
use crumble_sys as sys;
use std::ffi::CStr;
use std::os::raw::{c_char, c_void};
use std::panic::{catch_unwind, AssertUnwindSafe};
use std::sync::{Arc, RwLock};

type LogFunction = Arc<dyn Fn(Log, &str) + Send + Sync>;

static FUNCTION: RwLock<Option<LogFunction>> = RwLock::new(None);

/// What the library has to say goes to `function` from here on, line by line; `None` (default): nowhere. It is called
/// in the thread that made the call it tells of, before that returns; never in a step, a tick, or a read or write of a
/// device. It may call this API. If it panics, what it was told is lost. Other threads may still be in the one before.
pub fn log_set(function: Option<Box<dyn Fn(Log, &str) + Send + Sync>>) -> Result<()> {
    let before = {
        let mut now = FUNCTION.write().unwrap_or_else(|poisoned| poisoned.into_inner());
        std::mem::replace(&mut *now, function.map(Arc::from))
    };
    drop(before); // outside the lock: it may call this API

    // Always the same one, so that the order of two calls on two threads does not matter.
    Error::check(unsafe { sys::crumble_log_set(Some(tell), std::ptr::null_mut()) })
}

unsafe extern "C" fn tell(level: u32, text: *const c_char, _user: *mut c_void) {
    let function = FUNCTION.read().unwrap_or_else(|poisoned| poisoned.into_inner()).clone();
    let text = CStr::from_ptr(text).to_string_lossy();
    // A panic may not pass through C. The function is dropped in here too: it may be the last to hold what it captured.
    let _ = catch_unwind(AssertUnwindSafe(move || {
        if let Some(function) = function {
            function(Log(level), &text);
        }
    }));
}
