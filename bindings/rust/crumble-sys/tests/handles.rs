//! What the safe crate makes impossible: the library answers it all the same.
use crumble_sys::*;
use std::ffi::CStr;

fn last_error() -> String {
    unsafe { CStr::from_ptr(crumble_last_error()) }.to_str().unwrap().to_string()
}

#[test]
fn a_destroyed_handle_is_answered() {
    unsafe {
        let mut mesh = std::ptr::null_mut();
        let corners = [0.0, 0.0, 0.0, 0.01, 0.0, 0.0, 0.0, 0.0, 0.01, 0.0, 0.01, 0.0];
        assert_eq!(crumble_mesh_create_from_tets(corners.as_ptr(), 4, [0, 2, 1, 3].as_ptr(), 1, &mut mesh), CRUMBLE_OK);
        assert_eq!(crumble_mesh_destroy(mesh), CRUMBLE_OK);
        assert_eq!(crumble_mesh_destroy(mesh), CRUMBLE_E_STALE_HANDLE);
        assert!(last_error().contains("crumble_mesh_destroy"), "{}", last_error());
        assert_eq!(crumble_mesh_get_info(mesh, &mut crumble_mesh_info::default()), CRUMBLE_E_STALE_HANDLE);
        assert!(last_error().contains("crumble_mesh_get_info"), "{}", last_error());
        assert_eq!(crumble_sim_reset(mesh as crumble_sim), CRUMBLE_E_BAD_HANDLE);
        assert_eq!(crumble_sim_reset(std::ptr::null_mut()), CRUMBLE_E_NULL);
        let mut sim = std::ptr::null_mut();
        assert_eq!(crumble_sim_create(std::ptr::null_mut(), std::ptr::null(), &mut sim), CRUMBLE_E_NULL);
        assert_eq!(last_error(), "crumble_sim_create: mesh must not be NULL");
    }
}

#[test]
fn a_size_that_nobody_set_is_answered() {
    let mut def = crumble_tool_def { struct_size: 0, ..crumble_tool_def::default() };
    assert_eq!(unsafe { crumble_tool_def_init(&mut def, 0) }, CRUMBLE_E_UNINITIALIZED);
    assert_eq!(crumble_tool_def::default().struct_size as usize, std::mem::size_of::<crumble_tool_def>());
}
