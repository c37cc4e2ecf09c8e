using System.Collections.Generic;
using System.Linq;
using System.Threading;
using Crumble;

static unsafe class ReaderTests {
  public static void FollowTheirSimulation() {
    using (Simulation sim = Rig.Sim())
    using (var reader = new Reader(sim, new ReaderDef {SurfaceMode = SurfaceMode.Fragments})) {
      Expect.Fails(ResultCode.InUse, () => sim.AddTool(new ToolDef()), "crumble_sim_add_tool");
      Rig.Press(sim, 1, 300);
      sim.Publish();
      ReaderInfo info = reader.Update();
      Expect.Equal(300ul, info.Step);
      Expect.Equal(sim.GetCounters().Cuts, info.Cuts);
      Expect.Same(sim.GetDoubles(ArrayId.Positions), reader.GetDoubles(ArrayId.Positions));
      Expect.Same(sim.GetBytes(ArrayId.Intact), reader.GetView(ArrayId.Intact).ByteSpan.ToArray());
      Expect.Equal(3 * (int)info.TriangleCount, reader.CopySurfaceTriangles(new uint[100000]));
      Expect.Equal(3 * (int)info.VertexCount, reader.CopySurfacePositions(new double[100000]));
      FragmentInfo whole = reader.GetFragment(0);
      Expect.Equal(Native.None, whole.Parent);
      Expect.True(whole.Mass > 0 && whole.Inertia[0] > 0);
      Expect.Equal((int)whole.NodeCount, reader.GetFragmentList(0, FragmentList.Nodes).Length);
      sim.Destroy();
      Expect.Equal(300ul, reader.Update().Step);
    }
  }

  public static void HearEvents() {
    using (Simulation sim = Rig.Sim())
    using (var reader = new Reader(sim)) {
      Rig.Press(sim, 1, 300);
      var heard = new List<Event>();
      var some = new Event[16];
      int count;
      do {
        count = reader.ReadEvents(some);
        heard.AddRange(some.Take(count));
      } while (count == some.Length);
      Expect.Equal(sim.GetCounters().Cuts, (ulong)heard.Count(e => e.Kind == EventKind.Cut));
      Expect.True(heard.Where(e => e.Kind == EventKind.Cut).All(e => e.Energy > 0 && e.Holder == Native.None));
      Expect.True(heard.Any(e => e.Kind == EventKind.ContactBegin && e.Holder == 0));
    }
  }

  public static void SpreadTextures() {
    using (Simulation sim = Rig.Sim())
    using (var reader = new Reader(sim)) {
      ReaderInfo info = reader.Update();
      var boundary = Enumerable.Repeat(0.25f, 2 * Rig.Cube.GetLength(ArrayId.Boundary)).ToArray();
      var skin = new float[6 * info.SkinTriangleCount];
      reader.SpreadOverSkin(boundary, skin);
      Expect.True(skin.All(uv => uv == 0.25f));
      Expect.Fails(ResultCode.BufferTooSmall, () => reader.SpreadOverSkin(boundary, new float[6]));
    }
  }

  public static void LookFromAnotherThread() {
    using (Simulation sim = Rig.Sim())
    using (var reader = new Reader(sim)) {
      ulong seen = 0;
      bool stop = false;
      var looking = new Thread(() => { while (!Volatile.Read(ref stop)) seen = reader.Update().Step; });
      looking.Start();
      Rig.Press(sim, 1, 400);
      Volatile.Write(ref stop, true);
      looking.Join();
      reader.Update();
      Rig.Press(sim, 401, 420);
      Expect.True(reader.Update().Step > 300, "the reader stands at " + seen);
    }
  }
}
