using System.Threading;
using Crumble;

static class LoopTests {
  static Device Hand() {
    var def = new DeviceDef {
      Kind = DeviceKind.Hand,
      Points = new[] {new MotionPoint {Time = 0.7}, new MotionPoint {Time = 1.2, Move = new Vec3(0, -0.008, 0)}}
    };
    def.Start.Position.Y = 0.002;
    return new Device(def);
  }

  static HandDef Holding(Device device) {
    var hand = new HandDef {Device = device};
    hand.Workspace.Position.Y = 0.034;
    return hand;
  }

  public static void TheHostTicks() {
    using (Simulation sim = Rig.Sim())
    using (Device device = Hand())
    using (var loop = new Loop(sim, new LoopDef {Driver = Driver.Host}, Holding(device))) {
      double most = 0;
      for (int tick = 0; tick < 1500; ++tick) {
        loop.Tick();
        most = System.Math.Max(most, loop.GetHand(0).Force.Y);
      }
      HandStatus hand = loop.GetHand(0);
      Expect.Equal(HandState.Running, hand.State);
      Expect.Equal(Fault.None, hand.Fault);
      Expect.True(most > 0.05, "the hand feels " + most);
      Expect.Equal(1500ul, loop.GetStatus().Ticks);
      Expect.Equal(1500ul, sim.GetStepInfo().Step);
      loop.Halt();
      loop.Tick();
      Expect.Equal(Fault.Halted, loop.GetHand(0).Fault);
      loop.ResetFault(0);
      loop.Tick();
      Expect.Equal(HandState.Waiting, loop.GetHand(0).State);
      Expect.Fails(ResultCode.OutOfRange, () => loop.ResetFault(3), "3");
      Expect.Fails(ResultCode.State, () => loop.Place(0, Pose.Identity));
    }
    Expect.Equal("halted", Loop.FaultName(Fault.Halted));
    Expect.True(Loop.FaultReason(Fault.Speed).Length > 10);
  }

  // a press that stands in the body from tick 400 on
  static Device Press() {
    var def = new DeviceDef {Kind = DeviceKind.Press, PressSpeed = 0.01, PressDepth = 0.006};
    def.Start.Position.Y = 0.036;
    return new Device(def);
  }
  static HandDef Stiff(Device device) { return new HandDef {Device = device, Coupling = 0, RampTime = 0}; }

  public static void TheBodyChangesUnderTheHand() {
    using (Simulation sim = Rig.Sim())
    using (Device device = Press())
    using (var loop = new Loop(sim, new LoopDef {Driver = Driver.Host, Watchdog = 0}, Stiff(device))) {
      SimDef def = sim.GetDef();
      loop.Start();
      for (int tick = 0; tick < 500; ++tick) loop.Tick();
      double soft = loop.GetHand(0).Body.Force.Y;
      Expect.True(soft > 0.01, soft + " N, " + loop.GetHand(0).Fault);
      def.Stiffness = 60;
      loop.Configure(def);
      Expect.Equal(soft, loop.GetHand(0).Body.Force.Y, "not before the next step");
      loop.Tick();
      Expect.Near(2, loop.GetHand(0).Body.Force.Y / soft, 0.3);
      loop.SetFriction(0, 0, 0);
      loop.SetTool(0, new ToolDef {Shape = ToolShape.Ball});
      loop.Tick();
      loop.Tick(); // one change a step
      Expect.Equal(0.0, loop.GetHand(0).Body.Force.Y, "another solid lets go");
      def.Tau = 0.002;
      Expect.Fails(ResultCode.State, () => loop.Configure(def), "crumble_loop_configure", "tau");
      Expect.Fails(ResultCode.OutOfRange, () => loop.SetTool(1, new ToolDef()), "crumble_loop_set_tool", "tool is 1");
      Expect.Fails(ResultCode.OutOfRange, () => loop.SetFriction(0, 1, 2), "crumble_loop_set_friction", "friction");
      Expect.Fails(ResultCode.Null, () => loop.Configure(null), "crumble_loop_configure");
      loop.Stop();
      Expect.Equal(60.0, sim.GetDef().Stiffness);
    }
  }

  public static void AnotherThreadChangesTheBody() {
    using (Simulation sim = Rig.Sim())
    using (Device device = Press())
    using (var loop = new Loop(sim, new LoopDef {Driver = Driver.OwnThread, Priority = 0}, Stiff(device))) {
      SimDef def = sim.GetDef();
      loop.Start();
      for (int i = 0; i < 20; ++i) {
        def.Stiffness = 31 + i;
        loop.Configure(def);
        loop.SetFriction(0, 2, 1);
        ulong until = loop.GetStatus().Ticks + 3;
        for (int wait = 0; wait < 5000 && loop.GetStatus().Ticks < until; ++wait) Thread.Sleep(1);
      }
      loop.Stop();
      Expect.Equal(50.0, sim.GetDef().Stiffness);
    }
  }

  public static void AThreadOfItsOwnTicks() {
    using (Simulation sim = Rig.Sim())
    using (Device device = Hand())
    using (var loop = new Loop(sim, new LoopDef {Driver = Driver.OwnThread, Priority = 0}, Holding(device))) {
      Expect.True(!loop.IsRunning());
      loop.Start();
      Expect.True(loop.IsRunning());
      for (int i = 0; i < 500 && loop.GetStatus().Ticks < 200; ++i) Thread.Sleep(10);
      Expect.Fails(ResultCode.Busy, () => sim.StateHash(), "crumble_sim_state_hash");
      Wrench wrench;
      Expect.Equal(ResultCode.Busy, sim.TryStep(Pose.Identity, out wrench));
      Expect.Fails(ResultCode.State, loop.Start);
      loop.GetScheduling();
      loop.Stop();
      Expect.True(loop.GetStatus().Ticks >= 200);
      Expect.True(loop.GetTimes().Period.Count >= 199);
      sim.StateHash(); // ours again
      LoopStatus status = loop.GetStatus();
      for (uint i = 0; i < status.WarningCount; ++i) Expect.True(loop.GetWarning(i).Length > 0);
      Expect.Fails(ResultCode.OutOfRange, () => loop.GetWarning(status.WarningCount));
    }
  }
}
