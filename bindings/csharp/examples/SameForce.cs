// The program that every binding has, see examples/c/same_force.c: all print the same.
using System;
using System.Globalization;
using Crumble;

static class SameForce {
  static void Main() {
    using (Mesh cube = Mesh.CreatePaper(PaperBody.Cube))
    using (var sim = new Simulation(cube)) {
      sim.FixBelow(1e-6);
      sim.AddTool(new ToolDef());

      Pose pose = Pose.Identity;
      var wrench = new Wrench();
      for (int step = 1; step <= 1500; ++step) {
        pose.Position.Y = 0.034 - 1e-5 * step;
        wrench = sim.Step(pose);
      }
      CultureInfo plain = CultureInfo.InvariantCulture;
      Console.Write(string.Format(plain, "force {0:F12} N\n", wrench.Force.Y));
      Console.Write(string.Format(plain, "cuts {0}\nhash {1:x16}\n", sim.GetCounters().Cuts, sim.StateHash()));
    }
  }
}
