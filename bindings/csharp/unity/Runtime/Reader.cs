using System;

namespace Crumble {

/// <summary>Looks at a simulation from another thread, which draws, listens or logs at its own pace. Neither thread ever
/// waits for the other. A reader outlives its simulation, with the last state.</summary>
public sealed unsafe class Reader : ArraySource {
  /// <summary>Holds the state that the simulation is in. While it exists the simulation cannot be set up.</summary>
  public Reader(Simulation sim, ReaderDef def = null) {
    Library.Require();
    IntPtr reader;
    using (var pins = new Pins()) {
      Native.ReaderDef native = def == null ? default(Native.ReaderDef) : def.ToNative(pins);
      Check(Native.crumble_reader_create(HandleOf(sim), def == null ? null : &native, &reader));
    }
    GC.KeepAlive(sim);
    Own(reader);
  }

  /// <summary>Takes the newest state, brings the arrays and the surface up to it, and asks for the next.</summary>
  public ReaderInfo Update() {
    var info = new ReaderInfo { StructSize = (uint)sizeof(ReaderInfo) };
    Check(Native.crumble_reader_update(Handle, &info));
    return info;
  }

  /// <summary>Positions of all nodes, rows of x, y, z, m, into `dst`. Returns how many numbers these are.</summary>
  public int CopyPositions(double[] dst) { return Copy(ArrayId.Positions, dst); }
  /// <summary>Vertices of the surface, rows of x, y, z, m, likewise.</summary>
  public int CopySurfacePositions(double[] dst) { return Copy(ArrayId.SurfacePositions, dst); }
  /// <summary>Triangles of the surface, rows of three vertices, counter-clockwise; skin first.</summary>
  public int CopySurfaceTriangles(uint[] dst) { return Copy(ArrayId.SurfaceTriangles, dst); }
  /// <summary>Unit normals, a row of nine numbers for the three corners of each triangle.</summary>
  public int CopySurfaceNormals(float[] dst) { return Copy(ArrayId.SurfaceNormals, dst); }

  /// <summary>One fragment as of the last update.</summary>
  public FragmentInfo GetFragment(uint fragment) {
    var info = new FragmentInfo { StructSize = (uint)sizeof(FragmentInfo) };
    Check(Native.crumble_reader_get_fragment(Handle, fragment, &info));
    return info;
  }
  /// <summary>Its nodes, tetrahedra or triangles, without a copy, valid until the next Update.</summary>
  public ArrayView GetFragmentList(uint fragment, FragmentList which) {
    ArrayView list;
    Check(Native.crumble_reader_get_fragment_list(Handle, fragment, (uint)which, &list));
    return list;
  }
  /// <summary>Spreads texture coordinates over the skin: `boundary` has u and v at each corner of the boundary triangles
  /// of the mesh, `skin` receives them for the skin triangles, six numbers each.</summary>
  public void SpreadOverSkin(float[] boundary, float[] skin) {
    fixed (float* from = boundary)
    fixed (float* to = skin)
      Check(Native.crumble_reader_spread_over_skin(Handle, from, to, Pins.Rows(skin, 6, "skin")));
  }
  /// <summary>Takes the oldest events that this reader has not read. Returns how many; as many as `events` has room for
  /// means that there may be more.</summary>
  public int ReadEvents(Event[] events) {
    uint count;
    fixed (Event* to = events)
      Check(Native.crumble_reader_read_events(Handle, to, Pins.Rows(events, 1, "events"), &count));
    return (int)count;
  }

  internal override int Release() { return Native.crumble_reader_destroy(Handle); }
  internal override int CopyArray(uint which, void* dst, ulong bytes, ulong* needed) {
    return Native.crumble_reader_copy(Handle, which, dst, bytes, needed);
  }
  internal override int ViewArray(uint which, ArrayView* view) {
    return Native.crumble_reader_get_view(Handle, which, view);
  }
}

}
