using System;

namespace Crumble {

/// <summary>The tetrahedral mesh of a body at rest. Never changes. Bodies rest on y = 0, centred in x and z.</summary>
public sealed unsafe class Mesh : ArraySource {
  Mesh(IntPtr handle) { Own(handle); }

  /// <summary>Meshes a shape. Takes tenths of a second for the paper's bodies.</summary>
  public static Mesh Create(MeshDef def) {
    Library.Require();
    IntPtr mesh;
    using (var pins = new Pins()) {
      Native.MeshDef native = def == null ? default(Native.MeshDef) : def.ToNative(pins);
      Library.Check(Native.crumble_mesh_create(def == null ? null : &native, &mesh));
    }
    return new Mesh(mesh);
  }

  /// <summary>One of the paper's bodies.</summary>
  public static Mesh CreatePaper(PaperBody body) {
    Library.Require();
    IntPtr mesh;
    Library.Check(Native.crumble_mesh_create_paper((uint)body, &mesh));
    return new Mesh(mesh);
  }

  /// <summary>A mesh of your own: rows of x, y, z in metres, and rows of four nodes, of which seen from the fourth the
  /// first three go counter-clockwise.</summary>
  public static Mesh CreateFromTets(double[] positions, uint[] tetrahedra) {
    uint nodes = Pins.Rows(positions, 3, "positions"), count = Pins.Rows(tetrahedra, 4, "tetrahedra");
    Library.Require();
    IntPtr mesh;
    fixed (double* p = positions)
    fixed (uint* t = tetrahedra) Library.Check(Native.crumble_mesh_create_from_tets(p, nodes, t, count, &mesh));
    return new Mesh(mesh);
  }

  /// <summary>Counts, and the volume in m^3.</summary>
  public MeshInfo GetInfo() {
    var info = new MeshInfo { StructSize = (uint)sizeof(MeshInfo) };
    Check(Native.crumble_mesh_get_info(Handle, &info));
    return info;
  }

  /// <summary>Writes it as a legacy VTK file, for ParaView and meshio.</summary>
  public void SaveVtk(string path) {
    fixed (byte* text = Text.Bytes(path)) Check(Native.crumble_mesh_save_vtk(Handle, text));
  }

  internal override int Release() { return Native.crumble_mesh_destroy(Handle); }
  internal override int CopyArray(uint which, void* dst, ulong bytes, ulong* needed) {
    return Native.crumble_mesh_copy(Handle, which, dst, bytes, needed);
  }
  internal override int ViewArray(uint which, ArrayView* view) {
    return Native.crumble_mesh_get_view(Handle, which, view);
  }
}

}
