use crate::convert::{owned, static_text, string, Strings};
use crate::custom_device::Custom;
use crate::generated::{AttachedDevice, CustomDeviceDef, DeviceDef, DeviceInfo, DeviceKind, DeviceSample};
use crate::{check_version, CustomDevice, Error, Result};
use crumble_sys as sys;
use std::os::raw::c_void;
use std::sync::Arc;

/// A haptic device, or what stands in for one: a sample comes out of it, a force goes into it. Positions, velocities
/// and forces are in the device's own frame: x right, y up, z towards the user.
#[derive(Debug)]
pub struct Device {
    pub(crate) handle: sys::crumble_device,
    custom: Option<Arc<Custom>>, // which the library calls
}

// crumble.h: [one], from any thread, by one at a time; and a custom device is Send itself.
unsafe impl Send for Device {}

impl Device {
    /// Opens a device of any kind but [`DeviceKind::CUSTOM`].
    pub fn open(def: &DeviceDef) -> Result<Self> {
        let mut strings = Strings::default();
        Self::open_c(&def.as_c(&mut strings)?, None)
    }

    /// Opens a device of the host's own. Of `def` count what is for any kind: `record_capacity`. Its thread is the
    /// loop's: `SERVO_DRIVEN` is refused.
    pub fn open_custom(def: &DeviceDef, custom_def: &CustomDeviceDef, device: Box<dyn CustomDevice>) -> Result<Self> {
        let mut strings = Strings::default();
        let custom = Custom::new(device);
        let callbacks = sys::crumble_device_callbacks {
            user: Arc::as_ptr(&custom) as *mut c_void,
            read: Some(Custom::read),
            write: Some(Custom::write),
            ..custom_def.as_c(&mut strings)?
        };
        let mut c = def.as_c(&mut strings)?;
        c.kind = DeviceKind::CUSTOM.0;
        c.callbacks = &callbacks;
        Self::open_c(&c, Some(custom))
    }

    fn open_c(def: &sys::crumble_device_def, custom: Option<Arc<Custom>>) -> Result<Self> {
        check_version(sys::CRUMBLE_VERSION_NUMBER)?;
        let mut handle = std::ptr::null_mut();
        Error::check(unsafe { sys::crumble_device_open(def, &mut handle) })?;
        Ok(Self { handle, custom })
    }

    pub fn info(&self) -> Result<DeviceInfo> {
        let mut c = sys::crumble_device_info::default();
        Error::check(unsafe { sys::crumble_device_get_info(self.handle, &mut c) })?;
        Ok(DeviceInfo::from_c(&c))
    }

    /// What is wrong with the device, for people; empty when nothing is. Also while a loop has it.
    pub fn text(&self) -> Result<String> {
        let mut text = std::ptr::null();
        Error::check(unsafe { sys::crumble_device_get_text(self.handle, &mut text) })?;
        Ok(owned(text).unwrap_or_default())
    }

    /// What was recorded of it so far, as a .ctraj file.
    pub fn save_trajectory(&self, path: &str) -> Result<()> {
        let path = string("path", path)?;
        Error::check(unsafe { sys::crumble_device_save_trajectory(self.handle, path.as_ptr()) })
    }

    /// The next sample, for programs that do without a loop.
    pub fn read(&mut self) -> Result<DeviceSample> {
        let mut c = sys::crumble_device_sample::default();
        Error::check(unsafe { sys::crumble_device_read(self.handle, &mut c) })?;
        Ok(DeviceSample::from_c(&c))
    }

    /// Force, N, and torque, N m, on the hand, until the next write: past all safety stages, which a loop has.
    pub fn write(&mut self, force: &[f64; 3], torque: Option<&[f64; 3]>) -> Result<()> {
        let torque = torque.map_or(std::ptr::null(), |t| t.as_ptr());
        Error::check(unsafe { sys::crumble_device_write(self.handle, force.as_ptr(), torque) })
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        // Refused while there is a loop that was forgotten: then what the library calls has to stay.
        if unsafe { sys::crumble_device_destroy(self.handle) } != sys::CRUMBLE_OK {
            std::mem::forget(self.custom.take());
        }
    }
}

impl DeviceKind {
    /// The kind called `name`, so that a user chooses by a word.
    pub fn named(name: &str) -> Result<Self> {
        let (name, mut kind) = (string("name", name)?, 0);
        Error::check(unsafe { sys::crumble_device_kind(name.as_ptr(), &mut kind) })?;
        Ok(Self(kind))
    }

    /// The kinds that the library opens, as "hand" and so on.
    pub fn names() -> impl Iterator<Item = &'static str> {
        (0..).map_while(|index| static_text(unsafe { sys::crumble_device_kind_name(index) }))
    }
}

/// Hardware on USB that the kinds of this build are for, and drivers without it. `library`: HDAPI, as
/// `DeviceDef::phantom_library`.
pub fn find_attached(library: Option<&str>) -> Result<Vec<AttachedDevice>> {
    let library = library.map(|l| string("library", l)).transpose()?;
    let library = library.as_ref().map_or(std::ptr::null(), |l| l.as_ptr());
    let mut found = [sys::crumble_attached_device::default(); 32];
    let mut count = 0;
    let room = found.len() as u32;
    Error::check(unsafe { sys::crumble_device_find_attached(library, found.as_mut_ptr(), room, &mut count) })?;
    Ok(found[..count as usize].iter().map(AttachedDevice::from_c).collect())
}

/// Makes a .ctraj file of a text log that HAPI's DeviceLog wrote. `length_unit`: m per unit of its lengths.
pub fn import_hapi(log: &str, length_unit: f64, trajectory: &str) -> Result<()> {
    let (log, trajectory) = (string("log", log)?, string("trajectory", trajectory)?);
    Error::check(unsafe { sys::crumble_trajectory_import_hapi(log.as_ptr(), length_unit, trajectory.as_ptr()) })
}
