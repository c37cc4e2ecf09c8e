use crate::convert::memory;
use crate::generated::Code;
use crate::{Error, Result};
use crumble_sys as sys;
use std::fmt;
use std::marker::PhantomData;
use std::os::raw::c_void;

/// The name of an array with rows of type `T`: see [`array`](crate::array).
pub struct Array<T> {
    number: u32,
    rows: PhantomData<fn() -> T>,
}

impl<T> Array<T> {
    pub(crate) const fn new(number: u32) -> Self {
        Self { number, rows: PhantomData }
    }

    /// C's number.
    pub const fn number(self) -> u32 {
        self.number
    }
}

impl<T> Clone for Array<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Array<T> {}

impl<T> fmt::Debug for Array<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Array({})", self.number)
    }
}

/// What the rows of an array are. The library has no others.
pub trait Row: Copy + Default + sealed::Row + 'static {}

mod sealed {
    pub trait Row {
        const SCALAR: u32;
        const COMPONENTS: u32;
    }
}

macro_rules! rows {
    ($($row:ty: $scalar:ident $components:literal),*) => {
        $(impl sealed::Row for $row {
            const SCALAR: u32 = sys::$scalar;
            const COMPONENTS: u32 = $components;
        }
        impl Row for $row {})*
    };
}
rows!(f64: CRUMBLE_SCALAR_FLOAT64 1, [f64; 3]: CRUMBLE_SCALAR_FLOAT64 3, [f32; 9]: CRUMBLE_SCALAR_FLOAT32 9,
      u32: CRUMBLE_SCALAR_UINT32 1, [u32; 2]: CRUMBLE_SCALAR_UINT32 2, [u32; 3]: CRUMBLE_SCALAR_UINT32 3,
      [u32; 4]: CRUMBLE_SCALAR_UINT32 4, u8: CRUMBLE_SCALAR_UINT8 1);

/// The rows that a view shows.
///
/// # Safety
/// The library has just written `view`, and its memory does not change for as long as `'a`.
pub(crate) unsafe fn rows_of<'a, T: Row>(view: &sys::crumble_view) -> Result<&'a [T]> {
    let packed = view.stride as usize == std::mem::size_of::<T>();
    if view.scalar_type != T::SCALAR || view.components != T::COMPONENTS || !packed {
        return Err(Error::new(Code::UNSUPPORTED, format!("the array has other rows: {view:?}")));
    }
    if view.count == 0 || view.data.is_null() {
        return Ok(&[]);
    }
    Ok(std::slice::from_raw_parts(view.data as *const T, view.count as usize))
}

/// A copy of array `which` from one of the functions crumble_x_copy.
pub(crate) fn copy_of<T: Row>(
    which: Array<T>,
    copy: impl Fn(u32, *mut c_void, u64, *mut u64) -> sys::crumble_result,
) -> Result<Vec<T>> {
    memory(|dst, size, needed| copy(which.number, dst, size, needed))
}
