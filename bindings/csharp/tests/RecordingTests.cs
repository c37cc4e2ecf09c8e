using System.IO;
using System.Linq;
using Crumble;

static class RecordingTests {
  // 90 steps from step 30 on, with changes in their midst
  static string Record(out ulong end) {
    string path = Path.Combine(Runner.Work, "schritte-ü.crec");
    using (Simulation sim = Rig.Sim()) {
      Rig.Press(sim, 1, 30);
      sim.BeginRecording();
      Rig.Press(sim, 31, 60);
      SimDef def = sim.GetDef();
      def.Stiffness = 20;
      sim.Configure(def);
      sim.SetFriction(0, 0.5, 0.2);
      Rig.Press(sim, 61, 120);
      sim.SaveRecording(path);
      end = sim.StateHash();
    }
    return path;
  }

  public static void AreGoneThroughStepByStep() {
    ulong end;
    string path = Record(out end);
    var recording = new Recording(path);
    RecordingInfo info = recording.GetInfo();
    Expect.Equal(1u, info.ToolCount);
    Expect.Equal(90ul, info.StepCount);
    Expect.Equal(30ul, info.FirstStep);
    using (Simulation sim = recording.CreateSim()) {
      for (ulong step = 0; step < 90; ++step) Expect.True(recording.Step(sim, step), "step " + step);
      Expect.Equal(end, sim.StateHash());
      Expect.Equal(20.0, sim.GetDef().Stiffness);
      Expect.True(!recording.Step(sim, 3), "not from where step 2 left it");
      Expect.Fails(ResultCode.OutOfRange, () => recording.Step(sim, 90), "crumble_recording_step", "step is 90");
      Expect.Fails(ResultCode.Null, () => recording.Step(null, 0), "sim");
      recording.Destroy();
      Expect.Fails(ResultCode.StaleHandle, () => recording.Step(sim, 0), "recording");
      Expect.Equal(120ul, sim.GetStepInfo().Step - 1); // outlives it; one step more
    }
    Expect.Fails(ResultCode.StaleHandle, () => recording.GetInfo());
    Expect.Fails(ResultCode.StaleHandle, recording.Destroy, "crumble_recording_destroy");
    recording.Dispose();
  }

  public static void BadFilesAreRefused() {
    ulong end;
    byte[] bytes = File.ReadAllBytes(Record(out end));
    string half = Path.Combine(Runner.Work, "half.crec");
    File.WriteAllBytes(half, bytes.Take(bytes.Length / 2).ToArray());
    Expect.Fails(ResultCode.Corrupt, () => new Recording(half));
    Expect.Fails(ResultCode.Io, () => new Recording("/nowhere/at.all"), "/nowhere/at.all");
    Expect.Fails(ResultCode.Null, () => new Recording(null), "crumble_recording_load", "path");
  }
}
