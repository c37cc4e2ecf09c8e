//! The C API of crumble as it is in `crumble.h`, whose comments stand here too. For a safe interface take the crate
//! `crumble`, which is made of this one.
//!
//! Sizes and offsets of all structs are compared with those of the C compiler while this crate is compiled: a wrong one
//! is "overflowing in-bounds pointer arithmetic" or a failed assertion in a constant.
//!
//! ```compile_fail
//! #[repr(C)]
//! pub struct Pair { first: u32, second: f64 }
//! crumble_sys::layout!(Pair, 16, first: 0, second: 4); // `second` is at 8
//! ```
//! ```
//! #[repr(C)]
//! pub struct Pair { first: u32, second: f64 }
//! crumble_sys::layout!(Pair, 16, first: 0, second: 8);
//! ```
#![allow(non_camel_case_types)]

/// All zeros, but struct_size and what is given.
macro_rules! zeros {
    ($name:ident $(, $field:ident: $value:expr)?) => {
        impl Default for $name {
            fn default() -> Self {
                // Numbers, pointers and optional functions, for all of which zero is a value.
                let zeros: Self = unsafe { std::mem::zeroed() };
                Self { $($field: $value,)? ..zeros }
            }
        }
    };
}

/// Fails to compile unless the struct has this size and its fields these offsets. A pointer that is moved back by the
/// offset and then on by the size stays within the struct only if the offset is right.
#[doc(hidden)]
#[macro_export]
macro_rules! layout {
    ($name:ident, $size:literal $(, $field:ident: $offset:literal)*) => {
        const _: () = {
            assert!(std::mem::size_of::<$name>() == $size);
            let some = std::mem::MaybeUninit::<$name>::uninit();
            let start = some.as_ptr();
            $(let _ = unsafe { (std::ptr::addr_of!((*start).$field) as *const u8).sub($offset).add($size) };)*
        };
    };
}

#[rustfmt::skip]
mod generated;
pub use generated::*;
