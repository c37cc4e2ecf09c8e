use crate::convert::static_text;
use crate::generated::{Fault, MemoryInfo};
use crate::{Error, Result};
use crumble_sys as sys;

/// Of the library: major * 1000000 + minor * 1000 + patch.
pub fn version() -> u32 {
    unsafe { sys::crumble_version() }
}

/// The same as "major.minor.patch".
pub fn version_string() -> &'static str {
    static_text(unsafe { sys::crumble_version_string() }).unwrap_or_default()
}

/// One line for bug reports: version, source revision, compiler, kernels.
pub fn build_info() -> &'static str {
    static_text(unsafe { sys::crumble_build_info() }).unwrap_or_default()
}

/// The kernels that this processor runs, slowest first, for `SimDef::kernel`. All give the same bits.
pub fn kernel_names() -> impl Iterator<Item = &'static str> {
    (0..).map_while(|index| static_text(unsafe { sys::crumble_kernel_name(index) }))
}

/// Whether a program made for `header_version` can use this library. Meshes and devices ask it when they are made.
pub fn check_version(header_version: u32) -> Result<()> {
    Error::check(unsafe { sys::crumble_check_version(header_version) })
}

/// What the library's objects of this process have taken: bytes, and the most that there were.
pub fn memory_info() -> Result<MemoryInfo> {
    let mut c = sys::crumble_memory_info::default();
    Error::check(unsafe { sys::crumble_memory_get_info(&mut c) })?;
    Ok(MemoryInfo::from_c(&c))
}

impl Fault {
    /// "device_lost" and so on.
    pub fn name(self) -> &'static str {
        static_text(unsafe { sys::crumble_fault_name(self.0) }).unwrap_or_default()
    }

    /// The same as a sentence for people.
    pub fn reason(self) -> &'static str {
        static_text(unsafe { sys::crumble_fault_reason(self.0) }).unwrap_or_default()
    }
}
