use crate::arrays::{copy_of, rows_of, Array, Row};
use crate::convert::{count, start, string, Strings};
use crate::generated::{MeshDef, MeshInfo, Paper};
use crate::{check_version, Error, Result};
use crumble_sys as sys;

/// The tetrahedral mesh of a body at rest. Never changes. Bodies rest on y = 0, centred in x and z.
#[derive(Debug)]
pub struct Mesh {
    pub(crate) handle: sys::crumble_mesh,
}

// crumble.h: [one], from any thread, by one at a time.
unsafe impl Send for Mesh {}

impl Mesh {
    fn make(create: impl FnOnce(*mut sys::crumble_mesh) -> sys::crumble_result) -> Result<Self> {
        check_version(sys::CRUMBLE_VERSION_NUMBER)?;
        let mut handle = std::ptr::null_mut();
        Error::check(create(&mut handle))?;
        Ok(Self { handle })
    }

    /// Meshes a shape; the same bits on every machine. Takes tenths of a second for the paper's bodies.
    pub fn create(def: &MeshDef) -> Result<Self> {
        let c = def.as_c(&mut Strings::default())?;
        Self::make(|handle| unsafe { sys::crumble_mesh_create(&c, handle) })
    }

    /// One of the paper's bodies.
    pub fn create_paper(body: Paper) -> Result<Self> {
        Self::make(|handle| unsafe { sys::crumble_mesh_create_paper(body.0, handle) })
    }

    /// A mesh of your own: positions in m, and four nodes for each tetrahedron, with positive volume: seen from the
    /// fourth the first three go counter-clockwise.
    pub fn create_from_tets(positions: &[[f64; 3]], tetrahedra: &[[u32; 4]]) -> Result<Self> {
        let nodes = count("positions", positions.len())?;
        let tets = count("tetrahedra", tetrahedra.len())?;
        let (positions, tetrahedra) = (start(positions) as *const f64, start(tetrahedra) as *const u32);
        Self::make(|handle| unsafe { sys::crumble_mesh_create_from_tets(positions, nodes, tetrahedra, tets, handle) })
    }

    pub fn info(&self) -> Result<MeshInfo> {
        let mut c = sys::crumble_mesh_info::default();
        Error::check(unsafe { sys::crumble_mesh_get_info(self.handle, &mut c) })?;
        Ok(MeshInfo::from_c(&c))
    }

    /// Writes it as a legacy VTK file, which ParaView and meshio read. It is replaced only when all is written.
    pub fn save_vtk(&self, path: &str) -> Result<()> {
        let path = string("path", path)?;
        Error::check(unsafe { sys::crumble_mesh_save_vtk(self.handle, path.as_ptr()) })
    }

    /// An array of the mesh, without a copy.
    pub fn view<T: Row>(&self, which: Array<T>) -> Result<&[T]> {
        let mut view = sys::crumble_view::default();
        Error::check(unsafe { sys::crumble_mesh_get_view(self.handle, which.number(), &mut view) })?;
        unsafe { rows_of(&view) } // valid until the mesh is destroyed
    }

    /// The same array as a copy.
    pub fn copy<T: Row>(&self, which: Array<T>) -> Result<Vec<T>> {
        copy_of(which, |which, dst, size, needed| unsafe {
            sys::crumble_mesh_copy(self.handle, which, dst, size, needed)
        })
    }
}

impl Drop for Mesh {
    fn drop(&mut self) {
        unsafe { sys::crumble_mesh_destroy(self.handle) };
    }
}
