// Objects that nobody destroys go with the garbage collector, in whatever order it finds them.
using System;
using System.Runtime.CompilerServices;
using System.Threading;
using Crumble;

static unsafe class LifetimeTests {
  /// <summary>Handles of a mesh, a simulation, a reader, a device and a loop that nobody keeps. On a thread of its own,
  /// whose stack is gone when the collector looks for what is still in use.</summary>
  static IntPtr[] Abandoned() {
    IntPtr[] handles = null;
    var thread = new Thread(() => handles = Make());
    thread.Start();
    thread.Join();
    return handles;
  }

  [MethodImpl(MethodImplOptions.NoInlining)]
  static IntPtr[] Make() {
    Mesh mesh = Mesh.Create(new MeshDef {Spacing = 0.01});
    var sim = new Simulation(mesh);
    sim.AddTool(new ToolDef());
    var reader = new Reader(sim);
    var device = new Device(new Falling());
    var loop = new Loop(sim, new LoopDef {Driver = Driver.Host}, new HandDef {Device = device});
    return new[] {mesh.Handle, sim.Handle, reader.Handle, device.Handle, loop.Handle};
  }

  static bool[] Gone(IntPtr[] handles) {
    MeshInfo mesh;
    StepInfo step;
    ReaderInfo reader;
    DeviceInfo device;
    LoopStatus loop;
    mesh.StructSize = (uint)sizeof(MeshInfo);
    step.StructSize = (uint)sizeof(StepInfo);
    reader.StructSize = (uint)sizeof(ReaderInfo);
    device.StructSize = (uint)sizeof(DeviceInfo);
    loop.StructSize = (uint)sizeof(LoopStatus);
    int stale = (int)ResultCode.StaleHandle;
    return new[] {
      Native.crumble_mesh_get_info(handles[0], &mesh) == stale, Native.crumble_sim_get_step_info(handles[1], &step) == stale,
      Native.crumble_reader_update(handles[2], &reader) == stale,
      Native.crumble_device_get_info(handles[3], &device) == stale, Native.crumble_loop_get_status(handles[4], &loop) == stale
    };
  }

  public static void TheCollectorTakesAllInAnyOrder() {
    IntPtr[] handles = Abandoned();
    Expect.Same(new[] {false, false, false, false, false}, Gone(handles), "alive at first");
    bool[] gone = null;
    for (int round = 0; round < 50; ++round) {
      GC.Collect();
      GC.WaitForPendingFinalizers();
      gone = Gone(handles);
      if (Array.TrueForAll(gone, it => it)) return;
      Thread.Sleep(10);
    }
    throw new Exception("still there of mesh, sim, reader, device, loop: " + string.Join(", ", gone));
  }

  public static void ALoopKeepsWhatItNeeds() {
    Loop loop = LoopAlone();
    for (int round = 0; round < 5; ++round) {
      GC.Collect();
      GC.WaitForPendingFinalizers();
      loop.Tick();
    }
    Expect.Equal(5ul, loop.GetStatus().Ticks);
    loop.Destroy();
  }

  [MethodImpl(MethodImplOptions.NoInlining)]
  static Loop LoopAlone() {
    return new Loop(Rig.Sim(), new LoopDef {Driver = Driver.Host}, new HandDef {Device = new Device(new Falling())});
  }

  public static void DisposeInTheWrongOrderIsMadeUpFor() {
    Simulation sim = Rig.Sim();
    var device = new Device(new DeviceDef());
    var loop = new Loop(sim, new LoopDef {Driver = Driver.Host}, new HandDef {Device = device});
    sim.Dispose(); // the loop needs it
    loop.Tick();
    loop.Dispose();
    sim.Dispose();
    Expect.Fails(ResultCode.StaleHandle, () => sim.GetStepInfo());
    device.Destroy();
  }
}
