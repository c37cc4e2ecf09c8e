// What runs in a servo loop makes no garbage.
using System;
using Crumble;

static class GarbageTests {
  static long Allocated(Action work) {
    long before = GC.GetAllocatedBytesForCurrentThread();
    work();
    return GC.GetAllocatedBytesForCurrentThread() - before;
  }

  static void ExpectNone(string what, Action work) {
    work(); // what the compiler and the first call take
    int collections = GC.CollectionCount(0);
    Expect.Equal(0L, Allocated(work), "bytes of " + what);
    Expect.Equal(collections, GC.CollectionCount(0), "collections of " + what);
  }

  public static void TheCounterCounts() {
    byte[] kept = null;
    Expect.True(Allocated(() => { for (int i = 0; i < 1000; ++i) kept = new byte[1000]; }) >= 1000000);
    GC.KeepAlive(kept);
  }

  public static void StepsMakeNone() {
    using (Simulation sim = Rig.Sim()) {
      var contacts = new Contact[200];
      int at = 0;
      ExpectNone("steps", () => {
        for (int i = 0; i < 500; ++i) sim.Step(Rig.PoseAt(++at));
      });
      ExpectNone("steps without exceptions, also those that fail", () => {
        Wrench wrench;
        for (int i = 0; i < 500; ++i) sim.TryStep(i % 2 == 0 ? new Pose() : Rig.PoseAt(at), out wrench);
      });
      ExpectNone("several steps at once", () => {
        Wrench mean;
        AdvanceInfo info;
        for (int i = 0; i < 50; ++i) sim.TryAdvance(Rig.PoseAt(at), out mean, out info, 5);
      });
      ExpectNone("changes of friction", () => sim.SetFriction(0, 3, 1.5));
      ExpectNone("questions", () => {
        sim.GetStepInfo();
        sim.GetCounters();
        sim.GetContacts(contacts);
        LocalModel model;
        sim.GetLocalModel(0, out model);
        model.Evaluate(model.At);
      });
    }
  }

  public static void CopiesAndReadersMakeNone() {
    using (Simulation sim = Rig.Sim())
    using (var reader = new Reader(sim)) {
      Rig.Press(sim, 1, 200);
      var positions = new double[sim.GetLength(ArrayId.Positions)];
      var triangles = new uint[300000];
      var normals = new float[900000];
      var events = new Event[64];
      ExpectNone("copies and views", () => {
        sim.CopyPositions(positions);
        sim.GetView(ArrayId.PositionsX);
        sim.Publish();
        reader.Update();
        reader.CopyPositions(positions);
        reader.CopySurfaceTriangles(triangles);
        reader.CopySurfaceNormals(normals);
        reader.ReadEvents(events);
      });
    }
  }

  public static void TicksMakeNone() {
    using (Simulation sim = Rig.Sim())
    using (var device = new Device(new DeviceDef()))
    using (var loop = new Loop(sim, new LoopDef {Driver = Driver.Host}, new HandDef {Device = device})) {
      ExpectNone("ticks", () => {
        for (int i = 0; i < 500; ++i) loop.Tick();
        loop.GetHand(0);
        loop.GetStatus();
      });
    }
  }
}
