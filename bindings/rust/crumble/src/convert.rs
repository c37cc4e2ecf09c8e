//! Between C's values and ours.
use crate::generated::Code;
use crate::{Error, Result};
use crumble_sys as sys;
use std::ffi::{CStr, CString};
use std::os::raw::{c_char, c_void};

/// Keeps what C is shown for the time of one call.
#[derive(Default)]
pub(crate) struct Strings(Vec<CString>);

impl Strings {
    pub(crate) fn keep(&mut self, name: &str, text: &Option<String>) -> Result<*const c_char> {
        match text {
            None => Ok(std::ptr::null()),
            Some(text) => {
                self.0.push(string(name, text)?);
                Ok(self.0[self.0.len() - 1].as_ptr())
            }
        }
    }
}

pub(crate) fn string(name: &str, text: &str) -> Result<CString> {
    CString::new(text).map_err(|_| Error::new(Code::INVALID_VALUE, format!("{name} holds a zero byte")))
}

/// A copy of C's text; None for NULL.
pub(crate) fn owned(text: *const c_char) -> Option<String> {
    // Not NULL: the library's own text, which ends with a zero.
    (!text.is_null()).then(|| unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned())
}

/// Text of the library that lives as long as the program.
pub(crate) fn static_text(text: *const c_char) -> Option<&'static str> {
    // As for `owned`; that the text is static is what crumble.h says of the functions that this is used with.
    (!text.is_null()).then(|| unsafe { CStr::from_ptr(text) }.to_str().unwrap_or("not UTF-8"))
}

/// The text in an array, up to the first zero.
pub(crate) fn fixed(text: &[c_char]) -> String {
    let bytes: Vec<u8> = text.iter().map(|&c| c as u8).take_while(|&c| c != 0).collect();
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Where an array begins; NULL when it is empty.
pub(crate) fn start<T>(rows: &[T]) -> *const c_void {
    if rows.is_empty() {
        std::ptr::null()
    } else {
        rows.as_ptr() as *const c_void
    }
}

pub(crate) fn count(name: &str, length: usize) -> Result<u32> {
    u32::try_from(length).map_err(|_| Error::new(Code::TOO_LARGE, format!("{name} has {length} rows")))
}

/// For `Default`, which cannot fail: it does so only with a library of another version.
pub(crate) fn defaults(result: sys::crumble_result) {
    if let Err(error) = Error::check(result) {
        panic!("{error}");
    }
}

/// Text from a function that writes it to a buffer.
pub(crate) fn text(mut write: impl FnMut(*mut c_char, u64, *mut u64) -> sys::crumble_result) -> Result<String> {
    let mut bytes = memory(|dst, size, needed| write(dst as *mut c_char, size, needed))?;
    bytes.truncate(bytes.iter().position(|&b| b == 0).unwrap_or(bytes.len()));
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// Values from a function that writes them to a buffer: bytes, or rows of an array.
pub(crate) fn memory<T: Copy + Default>(
    mut write: impl FnMut(*mut c_void, u64, *mut u64) -> sys::crumble_result,
) -> Result<Vec<T>> {
    let size = std::mem::size_of::<T>() as u64;
    let mut needed = 0;
    Error::check(write(std::ptr::null_mut(), 0, &mut needed))?;
    if needed % size != 0 {
        return Err(Error::new(Code::UNSUPPORTED, format!("{needed} bytes are not in rows of {size}")));
    }
    let mut rows = vec![T::default(); (needed / size) as usize];
    Error::check(write(rows.as_mut_ptr() as *mut c_void, needed, &mut needed))?;
    Ok(rows)
}
