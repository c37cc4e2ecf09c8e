using System;
using System.Linq;
using System.Runtime.InteropServices;
using Crumble;

static unsafe class StepTests {
  public static void GiveForceAndTorque() {
    using (Simulation sim = Rig.Sim()) {
      Wrench wrench = Rig.Press(sim, 1, 300);
      Expect.True(wrench.Force.Y > 0.1);
      Expect.True(wrench.Torque.Y != 0);
      StepInfo info = sim.GetStepInfo();
      Expect.Equal(300ul, info.Step);
      Expect.Near(0.3, info.Time, 1e-9);
      Expect.True(info.Contacts > 0);
      Expect.True(sim.GetCounters().Cuts > 20);
      Expect.True(sim.GetProfile().SolveNetwork > 0);
    }
  }

  public static void RefuseBadPosesWithoutForce() {
    using (Simulation sim = Rig.Sim()) {
      Rig.Press(sim, 1, 100);
      Pose bad = Rig.PoseAt(101);
      bad.Position.X = double.NaN;
      Expect.Fails(ResultCode.BadPose, () => sim.Step(bad), "crumble_sim_step", "position[0]");
      Wrench wrench;
      Expect.Equal(ResultCode.BadPose, sim.TryStep(bad, out wrench));
      Expect.Equal(0.0, wrench.Force.Y);
      Expect.Fails(ResultCode.BadPose, () => sim.Step(new Pose()), "orientation");
      Expect.Equal(3ul, sim.GetCounters().BadPoses);
      Expect.Equal(100ul, sim.GetStepInfo().Step);
      Expect.Equal(ResultCode.Ok, sim.TryStep(Rig.PoseAt(101), out wrench));
      Expect.True(wrench.Force.Y > 0);
    }
  }

  public static void MoveSeveralToolsAndAttachments() {
    using (Simulation sim = Rig.Sim()) {
      Expect.Equal(1u, sim.AddTool(new ToolDef {Shape = ToolShape.Ball, Radius = 0.008}));
      uint top = TopNode();
      Expect.Equal(0u, sim.AddAttachment(new[] {top}));
      var poses = new[] {new Pose(-0.01, 0.034, 0), new Pose(0.01, 0.04, 0), Pose.Identity};
      var wrenches = new Wrench[3];
      for (int step = 0; step < 60; ++step) {
        poses[0].Position.Y -= 5e-6;
        poses[1].Position.Y -= 5e-5;
        poses[2].Position.Y += 1e-5;
        sim.StepTools(poses, wrenches);
      }
      Expect.True(wrenches[0].Force.Y > 0 && wrenches[1].Force.Y > wrenches[0].Force.Y);
      Expect.True(wrenches[2].Force.Y < 0, "an attachment that pulls up is pulled down");
      Expect.Fails(ResultCode.OutOfRange, () => sim.Step(poses[0]), "crumble_sim_step");
      Expect.Throws<ArgumentException>(() => sim.StepTools(poses, new Wrench[2]));
    }
  }

  static uint TopNode() {
    double[] rest = Rig.Cube.GetDoubles(ArrayId.RestPositions);
    int best = Enumerable.Range(0, rest.Length / 3).OrderByDescending(i => rest[3 * i + 1]).First();
    return (uint)best;
  }

  public static void MeetEveryShapeOfTool() {
    var cube = new[] {0.0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1, 1, 1, 1};
    var tools = new[] {
      new ToolDef(), new ToolDef {Shape = ToolShape.Bar}, new ToolDef {Shape = ToolShape.Ball},
      new ToolDef {Shape = ToolShape.Capsule}, new ToolDef {Shape = ToolShape.Cone}, new ToolDef {Shape = ToolShape.Blade},
      new ToolDef {
        Shape = ToolShape.Mesh, Vertices = cube.Select(x => 0.008 * (x - 0.5)).ToArray(),
        Triangles = new uint[] {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5}
      },
      new ToolDef {Shape = ToolShape.Support, Support = Marshal.GetFunctionPointerForDelegate(BallSupport)}
    };
    foreach (ToolDef tool in tools) {
      using (var sim = new Simulation(Rig.Cube)) {
        sim.FixBelow(1e-6);
        sim.AddTool(tool);
        var wrench = new Wrench();
        for (int step = 0; step < 200; ++step) wrench = sim.Step(new Pose(0.001, 0.037 - 5e-5 * step, 0));
        Expect.True(wrench.Force.Y > 0.01, tool.Shape + " feels " + wrench.Force);
      }
    }
  }

  static readonly SupportFunction BallSupport = (context, direction, point) => {
    for (int i = 0; i < 3; ++i) point[i] = 0.006 * direction[i];
  };

  public static void WallsAndFixedNodesHold() {
    using (var sim = new Simulation(Rig.Cube, new SimDef {Floor = 0})) {
      sim.AddWall(new WallDef {Offset = 5e-4});
      sim.StepTools(null, null);
      for (int step = 0; step < 50; ++step) sim.StepTools(null, null);
      Expect.Near(5e-4, sim.GetDoubles(ArrayId.PositionsY).Min(), 1e-9);
    }
    double[] rest = Rig.Cube.GetDoubles(ArrayId.RestPositions);
    using (var sim = new Simulation(Rig.Cube, new SimDef {Floor = 0})) {
      sim.FixNodes(new uint[] {5});
      sim.FixBox(new Vec3(-1, 0.025, -1), new Vec3(1, 1, 1));
      sim.FixPlane(new Vec3(1, 0, 0), -0.01);
      for (int step = 0; step < 50; ++step) sim.StepTools(null, null);
      double[] now = sim.GetDoubles(ArrayId.Positions);
      int moved = 0;
      for (int i = 0; i < rest.Length / 3; ++i) {
        bool held = i == 5 || rest[3 * i + 1] >= 0.025 || rest[3 * i] <= -0.01;
        bool same = rest[3 * i + 1] == now[3 * i + 1];
        Expect.Equal(held, same, "node " + i);
        moved += same ? 0 : 1;
      }
      Expect.True(moved > 10);
    }
  }

  public static void ContactsAddUpToTheWrench() {
    using (Simulation sim = Rig.Sim()) {
      Wrench wrench = Rig.Press(sim, 1, 200);
      Contact[] contacts = sim.GetContacts();
      Expect.Equal(contacts.Length, sim.CountContacts());
      Expect.True(contacts.Length > 2);
      double sum = contacts.Where(c => c.Holder == 0).Sum(c => c.Reaction.Y);
      Expect.Near(wrench.Force.Y, -sum, 1e-9);
      Expect.Fails(ResultCode.BufferTooSmall, () => sim.GetContacts(new Contact[1]));
      LocalModel model;
      sim.GetLocalModel(0, out model);
      LocalContact first = model.Contacts[0];
      Expect.True(model.ContactCount > 0 && first.Stiffness[0] != 0);
      Expect.Near(model.Wrench.Force.Y, model.Evaluate(model.At).Force.Y, 1e-12);
      Expect.Throws<IndexOutOfRangeException>(() => { LocalContact none = model.Contacts[96]; });
      Expect.True(sim.GetHeldDrag(0) > 0);
    }
  }

  public static void NodeForcesPull() {
    using (Simulation sim = Rig.Sim()) {
      uint top = TopNode();
      sim.SetNodeForce(top, new Vec3(0, 0.01, 0));
      for (int step = 0; step < 20; ++step) sim.Step(new Pose(0, 1, 0));
      double[] rest = Rig.Cube.GetDoubles(ArrayId.RestPositions), now = sim.GetDoubles(ArrayId.Positions);
      Expect.True(now[3 * top + 1] > rest[3 * top + 1]);
      sim.SetNodeForces(new double[rest.Length]);
      sim.SetNodeForces(null);
      Expect.Fails(ResultCode.OutOfRange, () => sim.SetNodeForces(new double[3]));
    }
  }
}
