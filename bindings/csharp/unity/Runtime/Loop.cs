using System;

namespace Crumble {

/// <summary>The haptic loop: reads devices, moves tools, steps the body, and sends what is fit for a hand. While it runs,
/// simulation and devices are its own (CRUMBLE_E_BUSY). As long as it exists they exist, whoever forgets them.</summary>
public sealed unsafe class Loop : NativeObject {
  /// <summary>A loop that does not run yet. Without a definition: defaults.</summary>
  public Loop(Simulation sim, LoopDef def, params HandDef[] hands) {
    Library.Require();
    IntPtr loop;
    using (var pins = new Pins()) {
      Native.HandDef[] natives = ToNative(hands, pins);
      Native.LoopDef native = def == null ? default(Native.LoopDef) : def.ToNative(pins);
      fixed (Native.HandDef* all = natives)
        Check(Native.crumble_loop_create(HandleOf(sim), def == null ? null : &native, all, (uint)natives.Length, &loop));
    }
    GC.KeepAlive(sim);
    GC.KeepAlive(hands);
    Own(loop);
  }

  static Native.HandDef[] ToNative(HandDef[] hands, Pins pins) {
    var natives = new Native.HandDef[hands == null ? 0 : hands.Length];
    for (int i = 0; i < natives.Length; ++i) natives[i] = hands[i].ToNative(pins);
    return natives;
  }

  /// <summary>The choices of the paper for a loop and its hands; the safety stages stay.</summary>
  public static void ApplyPaperPreset(LoopDef def, params HandDef[] hands) {
    using (var pins = new Pins()) {
      Native.LoopDef loop = def.ToNative(pins);
      Native.HandDef[] natives = ToNative(hands, pins);
      fixed (Native.HandDef* all = natives)
        Library.Check(Native.crumble_loop_apply_paper_preset(&loop, all, (uint)natives.Length));
      def.FromNative(loop);
      for (int i = 0; i < natives.Length; ++i) hands[i].FromNative(natives[i]);
    }
  }

  /// <summary>Begins to tick.</summary>
  public void Start() { Check(Native.crumble_loop_start(Handle)); }
  /// <summary>Returns when the last tick is over and every device has been sent zero.</summary>
  public void Stop() { Check(Native.crumble_loop_stop(Handle)); }
  /// <summary>One tick, with LoopDriver Host. Makes no garbage.</summary>
  public void Tick() { Check(Native.crumble_loop_tick(Handle)); }
  /// <summary>Where a tool stands that no hand moves.</summary>
  public void Place(uint tool, Pose pose) { Check(Native.crumble_loop_place(Handle, tool, &pose)); }
  /// <summary>What became of the thread's options; "" where the thread is not ours.</summary>
  public string GetScheduling() {
    ulong bytes;
    Check(Native.crumble_loop_get_scheduling(Handle, null, 0, &bytes));
    fixed (byte* text = new byte[bytes]) {
      Check(Native.crumble_loop_get_scheduling(Handle, text, bytes, &bytes));
      return Text.From(text);
    }
  }

  // The rest may be asked from any thread, at any time.

  /// <summary>Between Start and Stop.</summary>
  public bool IsRunning() {
    uint running;
    Check(Native.crumble_loop_is_running(Handle, &running));
    return running != 0;
  }
  /// <summary>The loop as its last tick left it.</summary>
  public LoopStatus GetStatus() {
    var status = new LoopStatus { StructSize = (uint)sizeof(LoopStatus) };
    Check(Native.crumble_loop_get_status(Handle, &status));
    return status;
  }
  /// <summary>One hand as the last tick left it.</summary>
  public HandStatus GetHand(uint hand) {
    var status = new HandStatus { StructSize = (uint)sizeof(HandStatus) };
    Check(Native.crumble_loop_get_hand(Handle, hand, &status));
    return status;
  }
  /// <summary>Times of ticks, s.</summary>
  public LoopTimes GetTimes() {
    var times = new LoopTimes { StructSize = (uint)sizeof(LoopTimes) };
    Check(Native.crumble_loop_get_times(Handle, &times));
    return times;
  }
  /// <summary>What in the definition may be felt as a fault of the loop, of LoopStatus.WarningCount texts one.</summary>
  public string GetWarning(uint index) {
    ulong bytes;
    Check(Native.crumble_loop_get_warning(Handle, index, null, 0, &bytes));
    fixed (byte* text = new byte[bytes]) {
      Check(Native.crumble_loop_get_warning(Handle, index, text, bytes, &bytes));
      return Text.From(text);
    }
  }
  /// <summary>No force on any hand from the next tick on, until its fault is reset.</summary>
  public void Halt() { Check(Native.crumble_loop_halt(Handle)); }
  /// <summary>A hand that is faulted waits again from the next tick on.</summary>
  public void ResetFault(uint hand) { Check(Native.crumble_loop_reset_fault(Handle, hand)); }
  /// <summary>Changes the simulation's definition between two steps. The loop does not wait for it; several changes are
  /// made in their order, one a step, and up to 64 may wait. While the loop does not run they are made at once.</summary>
  public void Configure(SimDef def) {
    using (var pins = new Pins()) {
      Native.SimDef native = def == null ? default(Native.SimDef) : def.ToNative(pins);
      Check(Native.crumble_loop_configure(Handle, def == null ? null : &native));
    }
  }
  /// <summary>Puts another tool in the place of number `tool`, likewise.</summary>
  public void SetTool(uint tool, ToolDef def) {
    using (var pins = new Pins()) {
      Native.ToolDef native = def == null ? default(Native.ToolDef) : def.ToNative(pins);
      Check(Native.crumble_loop_set_tool(Handle, tool, def == null ? null : &native));
    }
  }
  /// <summary>Changes friction of a tool, likewise.</summary>
  public void SetFriction(uint tool, double staticFriction, double dynamicFriction) {
    Check(Native.crumble_loop_set_friction(Handle, tool, staticFriction, dynamicFriction));
  }
  /// <summary>"device_lost" and so on.</summary>
  public static string FaultName(Fault fault) {
    Library.Require();
    return Text.From(Native.crumble_fault_name((uint)fault));
  }
  /// <summary>The same as a sentence for people.</summary>
  public static string FaultReason(Fault fault) {
    Library.Require();
    return Text.From(Native.crumble_fault_reason((uint)fault));
  }

  internal override int Release() { return Native.crumble_loop_destroy(Handle); }
}

}
