use crate::{cube, error};
use crumble::*;

#[test]
fn a_box_has_what_its_info_says() {
    let mesh = cube();
    let info = mesh.info().unwrap();
    let positions = mesh.view(array::REST_POSITIONS).unwrap();
    let tetrahedra = mesh.view(array::TETRAHEDRA).unwrap();
    assert_eq!(positions.len(), info.node_count as usize);
    assert_eq!(tetrahedra.len(), info.tetrahedron_count as usize);
    assert_eq!(mesh.view(array::SPRINGS).unwrap().len(), info.spring_count as usize);
    assert_eq!(mesh.view(array::BOUNDARY).unwrap().len(), info.boundary_triangle_count as usize);
    let volumes: f64 = mesh.view(array::NODE_VOLUMES).unwrap().iter().sum();
    assert!((volumes - info.volume).abs() < 1e-12 && (info.volume - 8e-6).abs() < 1e-9);
    let on_surface = mesh.view(array::NODE_KINDS).unwrap().iter().filter(|&&kind| kind < 3).count();
    assert_eq!(on_surface, info.surface_node_count as usize);
}

#[test]
fn a_view_is_the_librarys_memory_and_a_copy_is_not() {
    let mesh = cube();
    let first = mesh.view(array::REST_POSITIONS).unwrap();
    let again = mesh.view(array::REST_POSITIONS).unwrap();
    let copy = mesh.copy(array::REST_POSITIONS).unwrap();
    assert_eq!(first.as_ptr(), again.as_ptr());
    assert_ne!(first.as_ptr(), copy.as_ptr());
    assert_eq!(first, &copy[..]);
}

#[test]
fn the_papers_cube_has_its_nodes() {
    let info = Mesh::create_paper(Paper::CUBE).unwrap().info().unwrap();
    assert_eq!((info.surface_node_count, info.node_count), (306, 600));
}

#[test]
fn tetrahedra_of_ones_own_make_a_mesh() {
    let corners = [[0.0, 0.0, 0.0], [0.01, 0.0, 0.0], [0.0, 0.0, 0.01], [0.0, 0.01, 0.0]];
    let mesh = Mesh::create_from_tets(&corners, &[[0, 2, 1, 3]]).unwrap();
    assert!((mesh.info().unwrap().volume - 1e-6 / 6.0).abs() < 1e-15);
    assert_eq!(mesh.view(array::SPRINGS).unwrap(), &[[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]]);
}

#[test]
fn bad_tetrahedra_are_told_by_their_index() {
    let corners = [[0.0, 0.0, 0.0], [0.01, 0.0, 0.0], [0.0, 0.0, 0.01], [0.0, 0.01, 0.0]];
    let inverted = error(Mesh::create_from_tets(&corners, &[[0, 1, 2, 3]]));
    assert_eq!(inverted.code(), Code::MESH);
    assert!(inverted.text().contains("crumble_mesh_create_from_tets"), "{inverted}");
    let nothing = error(Mesh::create_from_tets(&[], &[]));
    assert_eq!(nothing.code(), Code::EMPTY);
}

#[test]
fn a_mesh_is_saved_for_paraview() {
    let mesh = cube();
    let path = std::env::temp_dir().join(format!("crumble-{}.vtk", std::process::id()));
    mesh.save_vtk(path.to_str().unwrap()).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::remove_file(&path).unwrap();
    let info = mesh.info().unwrap();
    assert!(text.starts_with("# vtk DataFile") && text.contains("DATASET UNSTRUCTURED_GRID"));
    assert!(text.contains(&format!("POINTS {} ", info.node_count)));
    assert!(text.contains(&format!("CELLS {} ", info.tetrahedron_count)));
    assert_eq!(error(mesh.save_vtk("no/such/folder/mesh.vtk")).code(), Code::IO);
}

#[test]
fn an_array_of_another_object_is_out_of_range() {
    assert_eq!(error(cube().view(array::POSITIONS_X)).code(), Code::OUT_OF_RANGE);
    assert_eq!(error(cube().copy(array::POSITIONS)).code(), Code::OUT_OF_RANGE);
}
