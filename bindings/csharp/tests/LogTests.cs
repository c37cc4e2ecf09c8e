// What the library says to a function of the host, and what it says of its memory.
using System;
using System.Collections.Generic;
using System.Linq;
using System.Threading;
using Crumble;

static class LogTests {
  static void Fail() { Expect.Fails(ResultCode.OutOfRange, () => Mesh.CreatePaper((PaperBody)77)); }

  public static void TellsOfFailuresButNotInSteps() {
    var lines = new List<string>();
    Thread here = Thread.CurrentThread;
    using (Simulation sim = Rig.Sim()) {
      Library.SetLog((level, text) => {
        if (Thread.CurrentThread == here) lines.Add(level + " " + text); // finalizers of other tests may fail meanwhile
      });
      try {
        GC.Collect(); // nothing but the library holds the function
        string said = Expect.Fails(ResultCode.OutOfRange, () => new Simulation(Rig.Cube, new SimDef {Stiffness = -1})).Message;
        Expect.Equal("CRUMBLE_E_OUT_OF_RANGE: " + lines.Single().Substring("Error ".Length), said);
        Wrench wrench;
        AdvanceInfo info;
        Expect.Equal(ResultCode.BadPose, sim.TryStep(new Pose(), out wrench));
        Expect.Equal(ResultCode.BadPose, sim.TryAdvance(new Pose(), out wrench, out info, 3));
        Expect.Equal(1, lines.Count);
        using (new Device(new DeviceDef())) Expect.True(lines[1].StartsWith("Note opened "), lines[1]);
      } finally { Library.SetLog(null); }
    }
    Fail();
    Expect.Equal(2, lines.Count, "nowhere any more");
  }

  public static void MayUseTheLibraryAndThrow() {
    int calls = 0;
    Thread here = Thread.CurrentThread;
    Library.SetLog((level, text) => {
      if (Thread.CurrentThread == here) ++calls;
      Expect.Equal(Rig.Cube.GetInfo().NodeCount, Rig.Cube.GetInfo().NodeCount);
      throw new InvalidOperationException("thrown by a log");
    });
    try { Fail(); } finally { Library.SetLog(null); }
    Expect.Equal(1, calls);
    Expect.Equal("thrown by a log", Library.LogFailure.Message);
  }

  // As Unity's editor does: the code goes, the library stays.
  public static void GoesWithItsDomain() {
    AppDomain domain = AppDomain.CreateDomain("another");
    domain.DoCallBack(ListenThere);
    Fail();
    Expect.Equal("77", (string)domain.GetData("heard"));
    AppDomain.Unload(domain);
    Fail();
  }
  static void ListenThere() {
    Library.SetLog((level, text) => {
      if (text.Contains("77")) AppDomain.CurrentDomain.SetData("heard", "77");
    });
  }

  public static void MemoryIsCounted() {
    GC.Collect(); // what other tests left goes now, not in between
    GC.WaitForPendingFinalizers();
    GC.Collect();
    GC.WaitForPendingFinalizers();
    MemoryInfo before = Library.GetMemoryInfo();
    using (Simulation sim = Rig.Sim()) {
      MemoryInfo with = Library.GetMemoryInfo();
      Expect.True(with.Blocks > before.Blocks && with.Bytes > before.Bytes + 10000, with.Bytes + " bytes");
      Expect.True(with.MostBytes >= with.Bytes);
      Expect.Equal(0ul, with.LongestFree);
    }
    Expect.Equal(before.Blocks, Library.GetMemoryInfo().Blocks);
  }
}
