using System;

namespace Crumble {

/// <summary>A recording's file, opened to be looked at step by step.</summary>
public sealed unsafe class Recording : NativeObject {
  /// <summary>Loads the whole file.</summary>
  public Recording(string path) {
    Library.Require();
    IntPtr recording;
    fixed (byte* text = Text.Bytes(path)) Check(Native.crumble_recording_load(text, &recording));
    Own(recording);
  }

  /// <summary>How many steps and tools.</summary>
  public RecordingInfo GetInfo() {
    var info = new RecordingInfo { StructSize = (uint)sizeof(RecordingInfo) };
    Check(Native.crumble_recording_get_info(Handle, &info));
    return info;
  }
  /// <summary>The simulation as it was where the recording begins. It needs the recording no more.</summary>
  public Simulation CreateSim() {
    IntPtr sim;
    Check(Native.crumble_recording_create_sim(Handle, &sim));
    return new Simulation(sim);
  }
  /// <summary>Does step `step` of the recording, from 0, with all that was done to the simulation before it; `sim` is
  /// where step - 1 left it. True when it is then in the recorded state.</summary>
  public bool Step(Simulation sim, ulong step) {
    uint equal;
    Check(Native.crumble_recording_step(Handle, HandleOf(sim), step, &equal));
    GC.KeepAlive(sim);
    return equal != 0;
  }

  internal override int Release() { return Native.crumble_recording_destroy(Handle); }
}

}
