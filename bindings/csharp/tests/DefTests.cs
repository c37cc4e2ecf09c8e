using Crumble;

static class DefTests {
  public static void DefaultsAreTheLibrarys() {
    var mesh = new MeshDef();
    Expect.Equal(0.03, mesh.Size.Y);
    Expect.Equal(0.0044, mesh.Spacing);
    var sim = new SimDef();
    Expect.Equal(30.0, sim.Stiffness);
    Expect.Equal(-9.81, sim.Gravity.Y);
    Expect.Equal(TimeStepPolicy.Guard, sim.TimeStepPolicy);
    Expect.Equal(null, sim.Kernel);
    var tool = new ToolDef();
    Expect.Equal(ToolShape.Stick, tool.Shape);
    Expect.Equal(0.004, tool.Radius);
    Expect.Equal(1.0, tool.Offset.Orientation.W);
    Expect.Equal(1.0, new WallDef().Normal.Y);
    Expect.Equal(0.05, new ReaderDef().Settle);
    var device = new DeviceDef();
    Expect.Equal(double.NegativeInfinity, device.ReplayFrom);
    Expect.Equal(0.02, device.WanderHigh.Z);
    Expect.Equal(10001u, device.Inverse3Port);
    Expect.Equal(0.001, new LoopDef().Tick);
    Expect.Equal(-1, new LoopDef().Processor);
    Expect.Equal(3.0, new HandDef().MaxForce);
    Expect.Equal(Senses.Position, new DeviceCallbacks().Measured);
  }

  public static void GoThroughTheLibraryAndBack() {
    var given = new SimDef {
      Stiffness = 40, Gravity = new Vec3(0, -1, 0.5), MassRule = MassRule.Equal, CutFade = 0.01,
      TimeStepPolicy = TimeStepPolicy.Substep, Kernel = "scalar", BallContact = 0, SpringDamping = 0.001
    };
    using (var sim = new Simulation(Rig.Cube, given)) {
      SimDef got = sim.GetDef();
      Expect.Equal(40.0, got.Stiffness);
      Expect.Equal(0.5, got.Gravity.Z);
      Expect.Equal(MassRule.Equal, got.MassRule);
      Expect.Equal(TimeStepPolicy.Substep, got.TimeStepPolicy);
      Expect.Equal("scalar", got.Kernel);
      Expect.Equal(0u, got.BallContact);
      Expect.Equal(0.001, got.SpringDamping);
      Expect.Equal("scalar", Library.KernelName(sim.GetInfo().Kernel));
      got.Mass = 0.05;
      sim.Configure(got);
      Expect.Equal(0.05, sim.GetDef().Mass);
      Expect.Fails(ResultCode.Unsupported, () => new Simulation(Rig.Cube, new SimDef {Kernel = "wümme"}), "wümme");
    }
  }

  public static void PaperPresets() {
    using (Simulation sim = Rig.Sim()) {
      sim.ApplyPaperPreset();
      Expect.Equal(2.9e-3, sim.GetDef().Tau);
      Expect.Equal(1.1, sim.GetDef().LengthLimit);
    }
    var loop = new LoopDef {Tick = 0.002};
    var hand = new HandDef();
    Loop.ApplyPaperPreset(loop, hand);
    Expect.Equal(Coupling.Paper, loop.Coupling);
    Expect.Equal(0.002, loop.Tick);
    Expect.Equal(0u, hand.Coupling);
  }

  public static void TheLibraryTellsOfItself() {
    Expect.True(Library.Version.StartsWith("0.1."));
    Expect.True(Library.BuildInfo.Contains(Library.Version));
    Expect.Equal("scalar", Library.KernelName(0));
    Expect.Equal(null, Library.KernelName(99));
  }
}
