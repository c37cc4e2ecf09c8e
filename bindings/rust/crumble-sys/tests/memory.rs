//! The library's memory from Rust's allocator. Alone in its process: no object may be alive when the source changes.
use crumble_sys::*;
use std::alloc::{alloc, dealloc, Layout};
use std::os::raw::c_void;

/// Bytes that are taken, as told by `user`.
unsafe extern "C" fn take(bytes: u64, alignment: u64, user: *mut c_void) -> *mut c_void {
    *(user as *mut u64) += bytes;
    alloc(Layout::from_size_align(bytes as usize, alignment as usize).unwrap()) as *mut c_void
}

unsafe extern "C" fn give_back(memory: *mut c_void, bytes: u64, alignment: u64, user: *mut c_void) {
    *(user as *mut u64) -= bytes;
    dealloc(memory as *mut u8, Layout::from_size_align(bytes as usize, alignment as usize).unwrap());
}

#[test]
fn a_source_is_asked_for_what_is_counted() {
    let mut taken = 0u64;
    let user = &mut taken as *mut u64;
    let source = crumble_memory_source {
        take: Some(take),
        give_back: Some(give_back),
        user: user as *mut c_void,
        ..crumble_memory_source::default()
    };
    unsafe {
        assert_eq!(crumble_memory_set_source(&source), CRUMBLE_OK);
        let (mut mesh, mut info) = (std::ptr::null_mut(), crumble_memory_info::default());
        assert_eq!(crumble_mesh_create_paper(CRUMBLE_PAPER_CUBE, &mut mesh), CRUMBLE_OK);
        assert_eq!(crumble_memory_get_info(&mut info), CRUMBLE_OK);
        assert!(info.bytes > 0 && info.bytes == *user, "{info:?}");
        assert_eq!(crumble_memory_set_source(std::ptr::null()), CRUMBLE_E_IN_USE);
        assert_eq!(crumble_mesh_destroy(mesh), CRUMBLE_OK);
        assert_eq!(*user, 0);
        assert_eq!(crumble_memory_set_source(std::ptr::null()), CRUMBLE_OK);
    }
}
