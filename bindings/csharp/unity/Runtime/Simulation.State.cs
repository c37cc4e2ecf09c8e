using System;

namespace Crumble {

public sealed unsafe partial class Simulation {
  /// <summary>Back to rest, unbroken, at time 0.</summary>
  public void Reset() { Check(Native.crumble_sim_reset(Handle)); }

  /// <summary>Positions of all nodes, rows of x, y, z, m, into `dst`. Returns how many numbers these are.</summary>
  public int CopyPositions(double[] dst) { return Copy(ArrayId.Positions, dst); }
  /// <summary>Velocities of all nodes, rows of x, y, z, m/s, likewise.</summary>
  public int CopyVelocities(double[] dst) { return Copy(ArrayId.Velocities, dst); }

  /// <summary>Parts of the body that intact springs hold together; removed ones count too.</summary>
  public uint CountFragments() {
    uint count;
    Check(Native.crumble_sim_count_fragments(Handle, &count));
    return count;
  }
  /// <summary>Puts a fragment to sleep, wakes it or removes it.</summary>
  public void SetFragmentState(uint fragment, FragmentState state) {
    Check(Native.crumble_sim_set_fragment_state(Handle, fragment, (uint)state));
  }
  /// <summary>What SetFragmentState made of it.</summary>
  public FragmentState GetFragmentState(uint fragment) {
    uint state;
    Check(Native.crumble_sim_get_fragment_state(Handle, fragment, &state));
    return (FragmentState)state;
  }
  /// <summary>Fragments of at most so many nodes, all slower than `maxSpeed`, m/s, that no tool holds: a view of their
  /// ids, valid until the next call of this, Restore or set-up.</summary>
  public ArrayView FindDebris(uint maxNodes, double maxSpeed) {
    ArrayView fragments;
    Check(Native.crumble_sim_find_debris(Handle, maxNodes, maxSpeed, &fragments));
    return fragments;
  }

  /// <summary>Brings the simulation's own surface arrays up to where the body is now. With a second thread take a
  /// Reader.</summary>
  public SurfaceInfo ExtractSurface() {
    var info = new SurfaceInfo { StructSize = (uint)sizeof(SurfaceInfo) };
    Check(Native.crumble_sim_extract_surface(Handle, &info));
    return info;
  }
  /// <summary>Makes the present state available to every reader at once: for programs with one thread.</summary>
  public void Publish() { Check(Native.crumble_sim_publish(Handle)); }

  /// <summary>All that the future depends on, as bytes.</summary>
  public byte[] Snapshot() {
    ulong bytes;
    Check(Native.crumble_sim_snapshot(Handle, null, 0, &bytes));
    var snapshot = new byte[bytes];
    fixed (byte* to = snapshot) Check(Native.crumble_sim_snapshot(Handle, to, bytes, &bytes));
    return snapshot;
  }
  /// <summary>Goes on from a snapshot of a simulation of the same definition, with the same bits.</summary>
  public void Restore(byte[] snapshot) {
    byte nothing = 0;
    fixed (byte* from = snapshot)
      Check(Native.crumble_sim_restore(Handle, from == null && snapshot != null ? &nothing : from,
                                       Pins.Rows(snapshot, 1, "snapshot")));
  }
  /// <summary>Equal bits, equal hash, on every machine.</summary>
  public ulong StateHash() {
    ulong hash;
    Check(Native.crumble_sim_state_hash(Handle, &hash));
    return hash;
  }

  /// <summary>From here on every step's poses and state hash are kept.</summary>
  public void BeginRecording() { Check(Native.crumble_sim_begin_recording(Handle)); }
  /// <summary>Writes what has been recorded so far; recording goes on.</summary>
  public void SaveRecording(string path) {
    fixed (byte* text = Text.Bytes(path)) Check(Native.crumble_sim_save_recording(Handle, text));
  }
  /// <summary>Ends and forgets the recording.</summary>
  public void EndRecording() { Check(Native.crumble_sim_end_recording(Handle)); }
  /// <summary>Runs a recording again. Returns how many of its steps, from the first on, reached the recorded state: all
  /// of `steps` when all is well.</summary>
  public static ulong VerifyRecording(string path, out ulong steps) {
    Library.Require();
    ulong count, equal;
    fixed (byte* text = Text.Bytes(path)) Library.Check(Native.crumble_verify_recording(text, &count, &equal));
    steps = count;
    return equal;
  }
}

}
