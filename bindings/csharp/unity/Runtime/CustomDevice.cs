using System;
using System.Runtime.InteropServices;

namespace Crumble {

/// <summary>Marks what native code calls; IL2CPP looks for an attribute of this name.</summary>
[AttributeUsage(AttributeTargets.Method)]
sealed class MonoPInvokeCallbackAttribute : Attribute {
  public MonoPInvokeCallbackAttribute(Type type) {}
}

/// <summary>A device of your own: override Read and Write, and open it with new Device(custom).</summary>
/// <remarks>They are called from one thread at a time, which is the loop's own when it has one: the garbage collector can
/// stop that thread too, and a loop takes the force away when it stays out for 20 ms. The first exception loses the
/// device; Failure keeps it. Servo-driven devices (DeviceFlag.ServoDriven) are not for C#.</remarks>
public abstract unsafe class CustomDevice {
  // native code knows these as long as the program runs
  static readonly DeviceCallbacksRead ReadCall = OnRead;
  static readonly DeviceCallbacksWrite WriteCall = OnWrite;
  GCHandle self;

  /// <summary>What the device tells of itself: name, what it measures, what it bears. Read when it is opened.</summary>
  public readonly DeviceCallbacks About = new DeviceCallbacks();
  /// <summary>What Read or Write threw when the device was lost; null before.</summary>
  public Exception Failure { get; private set; }

  /// <summary>Fills a sample, which comes with a unit orientation, its number and zeros.</summary>
  protected abstract void Read(ref DeviceSample sample);
  /// <summary>Force, N, and torque, N m, on the hand until the next write. Zeros also after a failure.</summary>
  protected abstract void Write(Vec3 force, Vec3 torque);

  internal Native.DeviceCallbacks Attach(Pins pins) {
    if (self.IsAllocated) throw new InvalidOperationException("this CustomDevice is open already");
    self = GCHandle.Alloc(this);
    Native.DeviceCallbacks table = About.ToNative(pins);
    table.User = GCHandle.ToIntPtr(self);
    table.Read = Marshal.GetFunctionPointerForDelegate(ReadCall);
    table.Write = Marshal.GetFunctionPointerForDelegate(WriteCall);
    return table;
  }
  internal void Detach() { if (self.IsAllocated) self.Free(); }

  [MonoPInvokeCallback(typeof(DeviceCallbacksRead))]
  static int OnRead(DeviceSample* sample, IntPtr user) {
    var device = (CustomDevice)GCHandle.FromIntPtr(user).Target;
    try {
      device.Read(ref *sample);
      return 0;
    } catch (Exception error) { return device.Lose(error); }
  }

  [MonoPInvokeCallback(typeof(DeviceCallbacksWrite))]
  static int OnWrite(double* force, double* torque, IntPtr user) {
    var device = (CustomDevice)GCHandle.FromIntPtr(user).Target;
    try {
      device.Write(*(Vec3*)force, *(Vec3*)torque);
      return 0;
    } catch (Exception error) { return device.Lose(error); }
  }

  int Lose(Exception error) {
    Failure = Failure ?? error;
    return (int)ResultCode.DeviceLost;
  }
}

}
