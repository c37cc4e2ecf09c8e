using System;
using System.Collections.Generic;

namespace Crumble {

/// <summary>A haptic device, or what stands in for one: a sample comes out of it, a force goes into it. Positions, m, and
/// forces, N, are in the device's own frame: x right, y up, z towards the user.</summary>
public sealed unsafe class Device : NativeObject {
  readonly CustomDevice custom;

  /// <summary>Opens a device of any kind.</summary>
  public Device(DeviceDef def) { Open(def); }

  /// <summary>Opens a device of your own. What `def` has for other kinds is not looked at.</summary>
  public Device(CustomDevice custom, DeviceDef def = null) {
    if (custom == null) throw new ArgumentNullException("custom");
    this.custom = custom;
    def = def ?? new DeviceDef();
    DeviceKind kind = def.Kind;
    IntPtr before = def.Callbacks;
    using (var pins = new Pins()) {
      Native.DeviceCallbacks table = custom.Attach(pins);
      try {
        def.Kind = DeviceKind.Custom;
        def.Callbacks = (IntPtr)(&table);
        Open(def);
      } catch {
        custom.Detach();
        throw;
      } finally {
        def.Kind = kind;
        def.Callbacks = before;
      }
    }
  }

  void Open(DeviceDef def) {
    Library.Require();
    IntPtr device;
    using (var pins = new Pins()) {
      Native.DeviceDef native = def == null ? default(Native.DeviceDef) : def.ToNative(pins);
      Check(Native.crumble_device_open(def == null ? null : &native, &device));
    }
    Own(device);
  }

  /// <summary>The kinds that this build opens, as "hand" and so on.</summary>
  public static string[] KindNames() {
    Library.Require();
    var names = new List<string>();
    for (uint i = 0; ; ++i) {
      string name = Text.From(Native.crumble_device_kind_name(i));
      if (name == null) return names.ToArray();
      names.Add(name);
    }
  }
  /// <summary>The kind called so, that a user chooses by a word.</summary>
  public static DeviceKind KindOf(string name) {
    Library.Require();
    uint kind;
    fixed (byte* text = Text.Bytes(name)) Library.Check(Native.crumble_device_kind(text, &kind));
    return (DeviceKind)kind;
  }
  /// <summary>Hardware that the kinds of this build are for. `library`: path of HDAPI, or null.</summary>
  public static AttachedDevice[] FindAttached(string library = null) {
    Library.Require();
    var found = new AttachedDevice[16]; // more are not at one computer
    uint count;
    fixed (byte* text = Text.Bytes(library))
    fixed (AttachedDevice* to = found)
      Library.Check(Native.crumble_device_find_attached(text, to, (uint)found.Length, &count));
    Array.Resize(ref found, (int)count);
    return found;
  }
  /// <summary>Makes a .ctraj file of a text log that HAPI's DeviceLog wrote; its lengths are in units of `lengthUnit`,
  /// m.</summary>
  public static void ImportHapi(string log, double lengthUnit, string trajectory) {
    Library.Require();
    fixed (byte* from = Text.Bytes(log))
    fixed (byte* to = Text.Bytes(trajectory))
      Library.Check(Native.crumble_trajectory_import_hapi(from, lengthUnit, to));
  }

  /// <summary>What it is and what it bears.</summary>
  public DeviceInfo GetInfo() {
    var info = new DeviceInfo { StructSize = (uint)sizeof(DeviceInfo) };
    Check(Native.crumble_device_get_info(Handle, &info));
    return info;
  }
  /// <summary>What is wrong with the device, for people; "" when nothing is.</summary>
  public string GetText() {
    byte* text;
    Check(Native.crumble_device_get_text(Handle, &text));
    return Text.From(text);
  }
  /// <summary>Writes what was recorded so far (RecordCapacity) as a .ctraj file.</summary>
  public void SaveTrajectory(string path) {
    fixed (byte* text = Text.Bytes(path)) Check(Native.crumble_device_save_trajectory(Handle, text));
  }
  /// <summary>The next sample, for programs that do without a loop.</summary>
  public DeviceSample Read() {
    var sample = new DeviceSample { StructSize = (uint)sizeof(DeviceSample) };
    Check(Native.crumble_device_read(Handle, &sample));
    return sample;
  }
  /// <summary>Force, N, and torque, N m, on the hand until the next write: past all safety stages, which a loop
  /// has.</summary>
  public void Write(Vec3 force, Vec3 torque) {
    Check(Native.crumble_device_write(Handle, (double*)&force, (double*)&torque));
  }

  internal override int Release() { return Native.crumble_device_destroy(Handle); }
  internal override void Released() { if (custom != null) custom.Detach(); }
}

public unsafe partial struct DeviceInfo {
  /// <summary>Name as text.</summary>
  public string NameText { get { fixed (byte* text = Name) return Text.From(text); } }
  /// <summary>Driver as text.</summary>
  public string DriverText { get { fixed (byte* text = Driver) return Text.From(text); } }
  /// <summary>Serial as text.</summary>
  public string SerialText { get { fixed (byte* text = Serial) return Text.From(text); } }
}

public unsafe partial struct AttachedDevice {
  /// <summary>Name as text.</summary>
  public string NameText { get { fixed (byte* text = Name) return Text.From(text); } }
  /// <summary>Note as text.</summary>
  public string NoteText { get { fixed (byte* text = Note) return Text.From(text); } }
}

}
