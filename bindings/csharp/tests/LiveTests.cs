// Changes between two steps, several steps at once, the books of the energy.
using System;
using System.IO;
using System.Linq;
using Crumble;

static class LiveTests {
  public static void WhatStaysTheSameChangesNoBit() {
    using (Simulation sim = Rig.Sim())
    using (Simulation never = Rig.Sim()) {
      Rig.Press(sim, 1, 250);
      Expect.True(sim.GetCounters().Cuts > 0);
      ulong here = sim.StateHash();
      sim.Configure(sim.GetDef());
      sim.SetTool(0, new ToolDef {StaticFriction = 3, DynamicFriction = 1.5});
      sim.SetFriction(0, 3, 1.5);
      sim.FixBelow(1e-6);
      Expect.Equal(here, sim.StateHash());
      Rig.Press(sim, 251, 300);
      Rig.Press(never, 1, 300);
      Expect.Equal(never.StateHash(), sim.StateHash());
    }
  }

  public static void StiffnessChangesTheForce() {
    using (Simulation sim = Rig.Sim()) {
      double soft = Rig.Press(sim, 1, 60).Force.Y;
      SimDef def = sim.GetDef();
      def.Stiffness = 60;
      sim.Configure(def);
      Expect.Near(2, Rig.Press(sim, 61, 61).Force.Y / soft, 0.3);
      Expect.Equal(60.0, sim.GetDef().Stiffness);
      Expect.Equal(61ul, sim.GetStepInfo().Step);
    }
  }

  public static void ToolsAndWallsAreReplaced() {
    using (Simulation sim = Rig.Sim()) {
      Rig.Press(sim, 1, 40);
      sim.SetTool(0, new ToolDef {Shape = ToolShape.Ball});
      Expect.Equal(0.0, Rig.Press(sim, 41, 41).Force.Y, "another solid lets go");
      Expect.True((sim.GetStepInfo().Flags & StepFlag.ContactSuspended) != 0);
      sim.AddWall(new WallDef {Offset = -0.001});
      sim.SetWall(1, new WallDef {Offset = 0.001}); // number 0 is the floor
      Rig.Press(sim, 42, 43);
      double[] rest = Rig.Cube.GetDoubles(ArrayId.RestPositions), now = sim.GetDoubles(ArrayId.PositionsY);
      double lowest = Enumerable.Range(0, now.Length).Where(i => rest[3 * i + 1] > 1e-6).Min(i => now[i]);
      Expect.True(lowest >= 0.001 - 1e-12, "behind the wall: " + lowest);
      Expect.Fails(ResultCode.OutOfRange, () => sim.SetWall(2, new WallDef()), "wall is 2", "there are 2");
      Expect.Fails(ResultCode.OutOfRange, () => sim.SetTool(1, new ToolDef()), "tool is 1", "there are 1");
      Expect.Fails(ResultCode.OutOfRange, () => sim.SetFriction(0, 1, 2), "friction");
      Expect.Fails(ResultCode.Null, () => sim.SetTool(0, null), "crumble_sim_set_tool");
      Expect.Fails(ResultCode.Null, () => sim.SetWall(0, null), "crumble_sim_set_wall");
    }
  }

  public static void SomeThingsStayAsTheyAre() {
    using (Simulation sim = Rig.Sim()) {
      Rig.Press(sim, 1, 20);
      ulong before = sim.StateHash();
      SimDef def = sim.GetDef();
      def.Tau = 0.002;
      Expect.Fails(ResultCode.State, () => sim.Configure(def), "crumble_sim_configure", "tau is 0.001", "0.002");
      Expect.Fails(ResultCode.State, () => sim.AddTool(new ToolDef()), "20 steps");
      Expect.Equal(before, sim.StateHash());
      Expect.Equal(0.001, sim.GetDef().Tau);
    }
  }

  public static void SeveralStepsAreDoneInOneCall() {
    using (Simulation sim = Rig.Sim())
    using (Simulation other = Rig.Sim()) {
      Rig.Press(sim, 1, 30);
      Rig.Press(other, 1, 30);
      Wrench mean;
      AdvanceInfo info = sim.Advance(Rig.PoseAt(46), out mean, 16);
      Expect.Equal(16u, info.Steps);
      Expect.Equal(0u, info.Dropped);
      Expect.Near(0.046, info.Time, 1e-9);
      Expect.True(info.Seconds > 0);
      double sum = 0;
      for (int step = 31; step <= 46; ++step) sum += other.Step(Rig.PoseAt(step)).Force.Y;
      Expect.Near(sum / 16, mean.Force.Y, 1e-6, "the mean");
      double[] mine = sim.GetDoubles(ArrayId.Positions), theirs = other.GetDoubles(ArrayId.Positions);
      for (int i = 0; i < mine.Length; ++i) Expect.Near(theirs[i], mine[i], 1e-9);
      // with a budget that no step keeps to, one is done
      info = sim.Advance(Rig.PoseAt(96), out mean, 50, 1e-9);
      Expect.Equal(1u, info.Steps);
      Expect.Equal(49u, info.Dropped);
      Expect.True((info.Flags & StepFlag.Dropped) != 0);
      Expect.Equal(49ul, sim.GetCounters().DroppedSteps);
    }
  }

  public static void SeveralToolsAdvance() {
    using (Simulation sim = Rig.Sim()) {
      sim.AddTool(new ToolDef {Shape = ToolShape.Ball});
      var means = new Wrench[2];
      sim.Advance(new[] {Rig.PoseAt(0), new Pose(0, 0.1, 0)}, means, 1);
      AdvanceInfo info = sim.Advance(new[] {Rig.PoseAt(100), new Pose(0, 0.05, 0)}, means, 100);
      Expect.Equal(100u, info.Steps);
      Expect.True(means[0].Force.Y > 0.01 && means[1].Force.Y == 0);
      Expect.Throws<ArgumentException>(() => sim.Advance(new Pose[2], new Wrench[1], 1));
    }
  }

  public static void AdvanceRefusesNonsense() {
    using (Simulation sim = Rig.Sim()) {
      Rig.Press(sim, 1, 100);
      Wrench mean;
      AdvanceInfo info;
      Expect.Fails(ResultCode.OutOfRange, () => sim.Advance(Rig.PoseAt(1), out mean, 0), "crumble_sim_advance", "steps");
      Expect.Fails(ResultCode.InvalidValue, () => sim.Advance(Rig.PoseAt(1), out mean, 1, double.NaN), "budget");
      mean.Force.Y = 7;
      Expect.Equal(ResultCode.BadPose, sim.TryAdvance(new Pose(), out mean, out info, 3));
      Expect.Equal(0.0, mean.Force.Y);
      Expect.Equal(100ul, sim.GetStepInfo().Step);
    }
  }

  public static void TheBooksAreKeptWhenAskedFor() {
    using (Simulation sim = Rig.Sim()) Expect.Fails(ResultCode.State, () => sim.GetEnergy(), "energy_audit");
    using (var sim = new Simulation(Rig.Cube, new SimDef {LengthLimit = 1.1, EnergyAudit = 1})) {
      sim.AddTool(new ToolDef {StaticFriction = 3, DynamicFriction = 1.5});
      sim.FixBelow(1e-6);
      Rig.Press(sim, 1, 250);
      Energy energy = sim.GetEnergy();
      Expect.True(energy.ToolWork > 0 && energy.Cut > 0);
      Expect.Near(energy.Stored, energy.ToolWork + energy.ExternalWork - energy.Dissipated - energy.Cut, 1e-9 * energy.ToolWork);
      Expect.True(energy.GainMaxRelative < 1e-12);
    }
  }

  public static void MeshesAreSavedForOthersToRead() {
    string path = Path.Combine(Runner.Work, "würfel.vtk");
    Rig.Cube.SaveVtk(path);
    string all = File.ReadAllText(path);
    MeshInfo info = Rig.Cube.GetInfo();
    Expect.True(all.Contains("POINTS " + info.NodeCount) && all.Contains("CELLS " + info.TetrahedronCount));
    Expect.Fails(ResultCode.Io, () => Rig.Cube.SaveVtk("/nowhere/at/all.vtk"), "/nowhere/at/all.vtk");
    Expect.Fails(ResultCode.Null, () => Rig.Cube.SaveVtk(null), "path");
  }
}
