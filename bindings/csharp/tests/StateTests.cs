using System.IO;
using System.Linq;
using Crumble;

static unsafe class StateTests {
  public static void SnapshotsGoOnWithTheSameBits() {
    using (Simulation sim = Rig.Sim())
    using (Simulation other = Rig.Sim()) {
      Rig.Press(sim, 1, 150);
      byte[] snapshot = sim.Snapshot();
      Rig.Press(sim, 151, 300);
      other.Restore(snapshot);
      Expect.True(sim.StateHash() != other.StateHash());
      Rig.Press(other, 151, 300);
      Expect.Equal(sim.StateHash(), other.StateHash());
      snapshot[snapshot.Length / 2] ^= 1;
      Expect.Fails(ResultCode.Corrupt, () => other.Restore(snapshot));
      Expect.Fails(ResultCode.Corrupt, () => other.Restore(new byte[0]));
      Expect.Fails(ResultCode.Null, () => other.Restore(null));
      sim.Reset();
      Expect.Equal(0ul, sim.GetStepInfo().Step);
    }
  }

  public static void RecordingsAreVerified() {
    string path = Path.Combine(Runner.Work, "aufnahme-ü.crec");
    using (Simulation sim = Rig.Sim()) {
      Expect.Fails(ResultCode.State, () => sim.SaveRecording(path));
      sim.BeginRecording();
      Rig.Press(sim, 1, 50);
      sim.SaveRecording(path);
      sim.EndRecording();
    }
    ulong steps;
    Expect.Equal(50ul, Simulation.VerifyRecording(path, out steps));
    Expect.Equal(50ul, steps);
    byte[] bytes = File.ReadAllBytes(path);
    File.WriteAllBytes(path, bytes.Take(bytes.Length / 2).ToArray());
    Expect.Fails(ResultCode.Corrupt, () => Simulation.VerifyRecording(path, out steps));
    Expect.Fails(ResultCode.Io, () => Simulation.VerifyRecording("/nowhere/at.all", out steps), "/nowhere/at.all");
  }

  public static void FragmentsHaveStates() {
    using (var sim = new Simulation(Rig.Cube, new SimDef {LengthLimit = 1.05})) {
      sim.FixBelow(1e-6);
      sim.AddTool(new ToolDef());
      Expect.Equal(1u, sim.CountFragments());
      for (int step = 1; step <= 1200 && sim.CountFragments() < 3; ++step) sim.Step(Rig.PoseAt(step));
      Expect.True(sim.CountFragments() > 1);
      Expect.Equal(FragmentState.Active, sim.GetFragmentState(1));
      sim.SetFragmentState(1, FragmentState.Asleep);
      Expect.Equal(FragmentState.Asleep, sim.GetFragmentState(1));
      Expect.Fails(ResultCode.OutOfRange, () => sim.SetFragmentState(999, FragmentState.Asleep), "999");
      Expect.True(sim.FindDebris(100000, 1e6).UIntSpan.ToArray().Contains(1u));
      sim.SetFragmentState(1, FragmentState.Removed);
      Expect.True(sim.GetCounters().RemovedNodes > 0);
    }
  }
}
