using System;
using Crumble;

static class ErrorTests {
  public static void SayCodeNameAndText() {
    CrumbleException error = Expect.Fails(ResultCode.OutOfRange, () => Mesh.Create(new MeshDef {Spacing = -1}),
                                          "CRUMBLE_E_OUT_OF_RANGE: crumble_mesh_create", "spacing", "-1");
    Expect.Equal("CRUMBLE_E_OUT_OF_RANGE", error.Name);
    Expect.Fails(ResultCode.InvalidValue, () => new Simulation(Rig.Cube, new SimDef {Stiffness = double.NaN}), "stiffness");
    Expect.Fails(ResultCode.OutOfRange, () => Mesh.CreatePaper((PaperBody)77), "77");
  }

  public static void NullIsAnsweredByTheLibrary() {
    Expect.Fails(ResultCode.Null, () => new Simulation(null), "crumble_sim_create: mesh must not be NULL");
    Expect.Fails(ResultCode.Null, () => Mesh.Create(null), "crumble_mesh_create");
    Expect.Fails(ResultCode.Empty, () => Mesh.CreateFromTets(null, null), "no nodes");
    Expect.Fails(ResultCode.Null, () => new Reader(null), "crumble_reader_create");
    Expect.Fails(ResultCode.Null, () => new Device((DeviceDef)null), "crumble_device_open");
    Expect.Fails(ResultCode.Null, () => new Loop(null, null), "crumble_loop_create");
    using (Simulation sim = Rig.Sim()) {
      Expect.Fails(ResultCode.Null, () => sim.AddTool(null), "crumble_sim_add_tool");
      Expect.Fails(ResultCode.Null, () => sim.AddWall(null), "crumble_sim_add_wall");
      sim.BeginRecording();
      Expect.Fails(ResultCode.Null, () => sim.SaveRecording(null), "path");
      Expect.Throws<ArgumentNullException>(() => sim.CopyPositions(null), "dst");
    }
  }

  public static void UseAfterDestroyIsStale() {
    Mesh mesh = Mesh.Create(new MeshDef {Spacing = 0.01});
    var sim = new Simulation(mesh);
    sim.AddTool(new ToolDef());
    var reader = new Reader(sim);
    var device = new Device(new DeviceDef());
    var loop = new Loop(sim, new LoopDef {Driver = Driver.Host}, new HandDef {Device = device});
    loop.Destroy();
    device.Destroy();
    reader.Destroy();
    sim.Destroy();
    mesh.Destroy();
    Expect.Fails(ResultCode.StaleHandle, () => mesh.GetInfo(), "crumble_mesh_get_info");
    Expect.Fails(ResultCode.StaleHandle, () => sim.Step(Pose.Identity), "crumble_sim_step");
    Expect.Fails(ResultCode.StaleHandle, () => reader.Update(), "crumble_reader_update");
    Expect.Fails(ResultCode.StaleHandle, () => device.Read(), "crumble_device_read");
    Expect.Fails(ResultCode.StaleHandle, () => loop.Tick(), "crumble_loop_tick");
    Expect.Fails(ResultCode.StaleHandle, () => new Simulation(mesh), "mesh has been destroyed");
    foreach (NativeObject it in new NativeObject[] {mesh, sim, reader, device, loop}) {
      Expect.Fails(ResultCode.StaleHandle, it.Destroy, "_destroy");
      it.Dispose(); // may be called again
    }
  }

  public static void WhatALoopNeedsIsInUse() {
    using (Simulation sim = Rig.Sim())
    using (var device = new Device(new DeviceDef()))
    using (var loop = new Loop(sim, new LoopDef {Driver = Driver.Host}, new HandDef {Device = device})) {
      Expect.Fails(ResultCode.InUse, sim.Destroy, "crumble_sim_destroy");
      Expect.Fails(ResultCode.InUse, device.Destroy, "crumble_device_destroy");
      Expect.Fails(ResultCode.InUse, () => sim.AddTool(new ToolDef()), "crumble_sim_add_tool");
    }
  }

  public static void FieldsAreNamedAsInC() {
    using (Simulation sim = Rig.Sim())
    using (var device = new Device(new DeviceDef())) {
      Expect.Fails(ResultCode.OutOfRange, () => new Loop(sim, null, new HandDef {Device = device, Tool = 1}), "hands[0].tool is 1");
    }
    Expect.Fails(ResultCode.OutOfRange, () => new Device(new DeviceDef {Kind = DeviceKind.Press, PressSpeed = -1}),
                 "press_speed must be positive");
    Expect.Fails(ResultCode.DtTooLarge, () => new Simulation(Rig.Cube, new SimDef {Tau = 1}), "tau must not exceed");
  }

  public static void RowsHaveToBeWhole() {
    Expect.Throws<ArgumentException>(() => Mesh.CreateFromTets(new double[7], new uint[4]), "positions", "7");
    Expect.Throws<ArgumentException>(
        () => { using (Simulation sim = Rig.Sim()) sim.AddTool(new ToolDef {Shape = ToolShape.Mesh, Vertices = new double[10]}); },
        "ToolDef.Vertices", "10");
  }
}
