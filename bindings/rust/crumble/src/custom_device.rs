//! Devices of the host's own.
use crate::convert::Strings;
use crate::generated::{Code, DeviceSample};
use crate::Result;
use crumble_sys as sys;
use std::fmt;
use std::os::raw::c_void;
use std::panic::{catch_unwind, AssertUnwindSafe};
use std::sync::{Arc, Mutex};

/// A device of the host's own, for [`Device::open_custom`](crate::Device::open_custom). Its functions are called by one
/// thread at a time: by the loop's or the watchdog's, or by that which calls [`Loop::tick`](crate::Loop::tick) or
/// [`Device::read`](crate::Device::read). An error or a panic means that the device is lost from then on; `write` is
/// still called then, with zeros. They must not block, nor take memory, when a loop is to keep its time.
pub trait CustomDevice: Send {
    /// Fills the sample, which comes with status [`ReadStatus::OK`](crate::ReadStatus::OK), a unit orientation, its
    /// number and zeros. Device frame, m, m/s, rad/s, s.
    fn read(&mut self, sample: &mut DeviceSample) -> Result<()>;

    /// Force, N, and torque, N m, on the hand, device frame, until the next write.
    fn write(&mut self, force: &[f64; 3], torque: &[f64; 3]) -> Result<()>;
}

/// The library promises one caller at a time. The lock makes it so even if it should not keep that.
pub(crate) struct Custom(Mutex<Box<dyn CustomDevice>>);

impl Custom {
    pub(crate) fn new(device: Box<dyn CustomDevice>) -> Arc<Self> {
        Arc::new(Self(Mutex::new(device)))
    }

    fn call(&self, function: impl FnOnce(&mut dyn CustomDevice) -> Result<()>) -> sys::crumble_result {
        let answer = catch_unwind(AssertUnwindSafe(|| match self.0.try_lock() {
            Ok(mut device) => function(&mut **device),
            Err(std::sync::TryLockError::Poisoned(device)) => function(&mut **device.into_inner()),
            Err(std::sync::TryLockError::WouldBlock) => Err(crate::Error::new(Code::BUSY, "the device is in use")),
        }));
        match answer {
            Ok(Ok(())) => sys::CRUMBLE_OK,
            Ok(Err(error)) if error.code() != Code::OK => error.code().0,
            _ => sys::CRUMBLE_E_INTERNAL,
        }
    }

    pub(crate) unsafe extern "C" fn read(sample: *mut sys::crumble_device_sample, user: *mut c_void) -> i32 {
        let (custom, sample) = (&*(user as *const Custom), &mut *sample);
        custom.call(|device| {
            let mut told = DeviceSample::from_c(sample);
            device.read(&mut told)?;
            *sample = told.as_c(&mut Strings::default())?;
            Ok(())
        })
    }

    pub(crate) unsafe extern "C" fn write(force: *const f64, torque: *const f64, user: *mut c_void) -> i32 {
        let custom = &*(user as *const Custom);
        let (force, torque) = (&*(force as *const [f64; 3]), &*(torque as *const [f64; 3]));
        custom.call(|device| device.write(force, torque))
    }
}

impl fmt::Debug for Custom {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a device of the host's own")
    }
}
