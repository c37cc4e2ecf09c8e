using System;
using System.IO;
using System.Linq;
using Crumble;

static unsafe class DeviceTests {
  public static void HaveKindsWithNames() {
    Expect.True(Device.KindNames().Contains("hand") && Device.KindNames().Contains("press"));
    Expect.Equal(DeviceKind.Replay, Device.KindOf("replay"));
    Expect.Fails(ResultCode.Unsupported, () => Device.KindOf("spoon"), "spoon", "hand");
    Expect.True(Device.FindAttached().All(found => found.NameText.Length > 0));
  }

  public static void PressMovesAsTold() {
    var def = new DeviceDef {Kind = DeviceKind.Press, PressSpeed = 0.01, PressDepth = 0.005};
    def.Start.Position.Y = 0.002;
    using (var device = new Device(def)) {
      DeviceInfo info = device.GetInfo();
      Expect.Equal(DeviceKind.Press, info.Kind);
      Expect.True(info.NameText.Length > 0);
      Expect.True((info.Flags & DeviceFlag.StepLocked) != 0);
      DeviceSample sample = device.Read();
      for (int i = 0; i < 100; ++i) sample = device.Read();
      Expect.Near(0.002 - 0.001, sample.Pose.Position.Y, 1e-9);
      Expect.Near(-0.01, sample.LinearVelocity.Y, 1e-9);
      device.Write(new Vec3(0, 1, 0), new Vec3());
      Expect.Fails(ResultCode.InvalidValue, () => device.Write(new Vec3(0, double.NaN, 0), new Vec3()), "force");
      Expect.Equal("", device.GetText());
    }
  }

  public static void PathsAreRecordedAndReplayed() {
    string path = Path.Combine(Runner.Work, "weg.ctraj");
    var def = new DeviceDef {
      Kind = DeviceKind.Path, RecordCapacity = 1000,
      Points = new[] {new MotionPoint {Time = 0.1, Move = new Vec3(0.01, 0, 0)}, new MotionPoint {Time = 0.2}}
    };
    var way = new double[200];
    using (var device = new Device(def)) {
      for (int i = 0; i < 200; ++i) way[i] = device.Read().Pose.Position.X;
      device.SaveTrajectory(path);
    }
    Expect.Near(0.01, way.Max(), 1e-4);
    using (var device = new Device(new DeviceDef {Kind = DeviceKind.Replay, Trajectory = path})) {
      for (int i = 0; i < 200; ++i) Expect.Near(way[i], device.Read().Pose.Position.X, 1e-9);
    }
    Expect.Fails(ResultCode.Empty, () => new Device(new DeviceDef {Kind = DeviceKind.Path}), "points");
    Expect.Fails(ResultCode.Io, () => new Device(new DeviceDef {Kind = DeviceKind.Replay, Trajectory = "/no/üwhere"}), "üwhere");
    Expect.Fails(ResultCode.Null, () => new Device(new DeviceDef {Kind = DeviceKind.Replay}), "trajectory");
  }

  public static void LogsOfHapiAreImported() {
    string log = Path.Combine(Runner.Work, "none.log");
    Expect.Fails(ResultCode.Io, () => Device.ImportHapi(log, 1, log + ".ctraj"), "none.log");
  }
}

/// <summary>Goes down by 10 um a read, and breaks when it is told to.</summary>
class Falling : CustomDevice {
  public int Reads, Writes, BreakAt = int.MaxValue;
  public double Height = 0.002, Stop = -1, Pushed;

  protected override void Read(ref DeviceSample sample) {
    if (++Reads >= BreakAt) throw new InvalidOperationException("unplugged");
    Height = Math.Max(Stop, Reads > 700 ? Height - 1e-5 : Height);
    sample.Pose.Position.Y = Height;
  }
  protected override void Write(Vec3 force, Vec3 torque) {
    ++Writes;
    Pushed = force.Y;
  }
}

static class CustomDeviceTests {
  public static void AreOpenedAndLost() {
    var falling = new Falling {BreakAt = 3};
    falling.About.Name = "fällt";
    falling.About.MaxForce = 3.3;
    var device = new Device(falling);
    Expect.Equal("fällt", device.GetInfo().NameText);
    Expect.Equal(3.3, device.GetInfo().MaxForce);
    Expect.Near(0.002, device.Read().Pose.Position.Y, 1e-12);
    Expect.Throws<InvalidOperationException>(() => new Device(falling), "open already");
    device.Write(new Vec3(0, 0.5, 0), new Vec3());
    Expect.Equal(0.5, falling.Pushed);
    device.Read();
    Expect.Fails(ResultCode.DeviceLost, () => device.Read(), "crumble_device_read");
    Expect.Equal("unplugged", falling.Failure.Message);
    device.Destroy();
    falling.BreakAt = int.MaxValue;
    using (var again = new Device(falling)) again.Read();
    var bad = new Falling();
    bad.About.Mass = -1;
    Expect.Fails(ResultCode.OutOfRange, () => new Device(bad), "mass");
    bad.About.Mass = 0.1;
    new Device(bad).Dispose();
  }

  public static void FeelTheBodyInALoop() {
    var falling = new Falling {Stop = -0.004};
    using (Simulation sim = Rig.Sim())
    using (var device = new Device(falling)) {
      var hand = new HandDef {Device = device};
      hand.Workspace.Position.Y = 0.034;
      using (var loop = new Loop(sim, new LoopDef {Driver = Driver.Host}, hand))
        for (int tick = 0; tick < 1500; ++tick) loop.Tick();
      Expect.True(falling.Reads >= 1500 && falling.Writes >= 1500);
      Expect.Equal(0.0, falling.Pushed); // the end of a loop sends zero
    }
  }

  // The loop's thread is foreign to the runtime, which takes it in.
  public static void WorkOnTheLoopsOwnThread() {
    var falling = new Falling {Stop = -0.002};
    using (Simulation sim = Rig.Sim())
    using (var device = new Device(falling)) {
      var hand = new HandDef {Device = device};
      hand.Workspace.Position.Y = 0.034;
      using (var loop = new Loop(sim, new LoopDef {Driver = Driver.OwnThread, Priority = 0}, hand)) {
        loop.Start();
        for (int i = 0; i < 500 && loop.GetStatus().Ticks < 100; ++i) System.Threading.Thread.Sleep(10);
        GC.Collect();
        loop.Stop();
        Expect.True(falling.Reads >= 100 && falling.Failure == null);
      }
    }
  }
}
