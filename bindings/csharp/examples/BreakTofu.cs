// Presses a round stick of 8 mm diameter 15 mm into the paper's tofu cube, at 10 mm/s, and prints the force.
using System;
using System.Globalization;
using Crumble;

static class BreakTofu {
  static int Main() {
    try {
      Break();
      return 0;
    } catch (CrumbleException error) {
      Console.Error.WriteLine(error.Message);
      return 1;
    }
  }

  static void Break() {
    using (Mesh cube = Mesh.CreatePaper(PaperBody.Cube))
    using (var sim = new Simulation(cube)) { // tofu, 1 ms steps
      sim.FixBelow(1e-6);                    // the bottom sticks to the table
      sim.AddTool(new ToolDef());            // the 8 mm stick

      Pose pose = Pose.Identity; // lying across the top face
      for (int step = 1; step <= 1500; ++step) {
        pose.Position.Y = 0.034 - 1e-5 * step;
        Wrench wrench = sim.Step(pose);
        if (step % 100 == 0)
          Console.Write(string.Format(CultureInfo.InvariantCulture, "depth {0,4:F1} mm  force {1,6:F3} N\n", 0.01 * step,
                                      wrench.Force.Y));
      }
      Console.Write(sim.GetCounters().Cuts + " springs cut\n");
    }
  }
}
