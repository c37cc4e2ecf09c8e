using System;
using System.Linq;
using Crumble;

static unsafe class ArrayTests {
  public static void OfAMesh() {
    MeshInfo info = Rig.Cube.GetInfo();
    Expect.Near(2.7e-5, info.Volume, 1e-9);
    double[] rest = Rig.Cube.GetDoubles(ArrayId.RestPositions);
    Expect.Equal(3 * (int)info.NodeCount, rest.Length);
    uint[] tetrahedra = Rig.Cube.GetUInts(ArrayId.Tetrahedra);
    Expect.Equal(4 * (int)info.TetrahedronCount, tetrahedra.Length);
    Expect.Equal((int)info.NodeCount, Rig.Cube.GetBytes(ArrayId.NodeKinds).Length);
    Expect.Near(info.Volume, Rig.Cube.GetDoubles(ArrayId.NodeVolumes).Sum(), 1e-12);
    // the same mesh from its own arrays
    using (Mesh again = Mesh.CreateFromTets(rest, tetrahedra)) {
      Expect.Same(rest, again.GetDoubles(ArrayId.RestPositions));
      Expect.Same(Rig.Cube.GetUInts(ArrayId.Springs), again.GetUInts(ArrayId.Springs));
    }
    tetrahedra[0] = 1000000;
    Expect.Fails(ResultCode.Mesh, () => Mesh.CreateFromTets(rest, tetrahedra), "1000000");
  }

  public static void ViewsAndCopiesAgree() {
    using (Simulation sim = Rig.Sim()) {
      Rig.Press(sim, 1, 200);
      double[] packed = sim.GetDoubles(ArrayId.Positions);
      ArrayView y = sim.GetView(ArrayId.PositionsY);
      Expect.Equal(packed.Length, 3 * y.Length);
      for (int i = 0; i < y.Length; ++i) Expect.Equal(packed[3 * i + 1], y.Doubles[i]);
      ReadOnlySpan<double> span = y.DoubleSpan;
      Expect.Equal(y.Length, span.Length);
      Expect.Equal(packed[1], span[0]);
      ArrayView intact = sim.GetView(ArrayId.Intact);
      Expect.Equal((int)sim.GetCounters().Cuts, intact.ByteSpan.ToArray().Count(b => b == 0));
      Expect.True(Rig.Cube.GetView(ArrayId.Tetrahedra).Components == 4);
      Expect.Same(Rig.Cube.GetUInts(ArrayId.Tetrahedra), Rig.Cube.GetView(ArrayId.Tetrahedra).UIntSpan.ToArray());
      Expect.Throws<InvalidOperationException>(() => { double* wrong = intact.Doubles; }, "Uint8", "Float64");
      Expect.Fails(ResultCode.Unsupported, () => sim.GetView(ArrayId.Positions));
      Expect.Fails(ResultCode.State, () => sim.GetView(ArrayId.SurfacePositions));
      Expect.Fails(ResultCode.OutOfRange, () => sim.GetView((ArrayId)99), "99");
    }
  }

  public static void CopiesCheckTypeAndRoom() {
    using (Simulation sim = Rig.Sim()) {
      int length = sim.GetLength(ArrayId.Positions);
      var room = new double[length + 5];
      room[length] = 7;
      Expect.Equal(length, sim.CopyPositions(room));
      Expect.Equal(7.0, room[length]);
      Expect.Equal(length, sim.CopyVelocities(room));
      Expect.Fails(ResultCode.BufferTooSmall, () => sim.CopyPositions(new double[length - 1]));
      Expect.Fails(ResultCode.BufferTooSmall, () => sim.CopyPositions(new double[0]));
      Expect.Throws<ArgumentException>(() => sim.Copy(ArrayId.Intact, new double[100000]), "Intact", "Uint8");
      Expect.Equal(0, sim.Copy(ArrayId.NewCuts, new uint[0]));
    }
  }

  public static void OfASurface() {
    using (Simulation sim = Rig.Sim()) {
      Rig.Press(sim, 1, 300);
      SurfaceInfo info = sim.ExtractSurface();
      uint[] triangles = sim.GetUInts(ArrayId.SurfaceTriangles);
      Expect.Equal(3 * (int)info.TriangleCount, triangles.Length);
      Expect.True(info.SkinTriangleCount < info.TriangleCount, "cracks");
      Expect.Equal(info.VertexCount - 1, triangles.Max());
      // closed: every edge is there once in each direction
      var edges = triangles.Select((v, i) => ((ulong)v << 32) | triangles[i % 3 == 2 ? i - 2 : i + 1]).ToArray();
      Expect.Equal(edges.Length, edges.Distinct().Count());
      Expect.True(edges.All(new System.Collections.Generic.HashSet<ulong>(edges.Select(e => e << 32 | e >> 32)).Contains));
      float[] normals = sim.GetFloats(ArrayId.SurfaceNormals);
      Expect.Equal(9 * (int)info.TriangleCount, normals.Length);
      Expect.Near(1, Math.Sqrt(normals.Take(3).Sum(n => n * n)), 1e-5);
    }
  }
}
