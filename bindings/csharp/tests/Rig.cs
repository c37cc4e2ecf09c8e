// A small cube that stands fixed under a stick; its springs break early.
using Crumble;

static class Rig {
  static Mesh mesh;

  public static Mesh Cube {
    get {
      if (mesh == null) mesh = Mesh.Create(new MeshDef {Spacing = 0.006});
      return mesh;
    }
  }

  public static SimDef Weak() { return new SimDef {LengthLimit = 1.1}; }

  public static Simulation Sim() {
    var sim = new Simulation(Cube, Weak());
    sim.AddTool(new ToolDef {StaticFriction = 3, DynamicFriction = 1.5});
    sim.FixBelow(1e-6);
    return sim;
  }

  /// <summary>Down at 20 mm/s with a turn about the vertical: forces and torques on every axis.</summary>
  public static Pose PoseAt(int step) {
    return new Pose(new Vec3(2e-6 * step, 0.034 - 2e-5 * step, 0), new Quat(0.8, 0, 0.6, 0));
  }

  public static Wrench Press(Simulation sim, int first, int last) {
    var wrench = new Wrench();
    for (int step = first; step <= last; ++step) wrench = sim.Step(PoseAt(step));
    return wrench;
  }
}
