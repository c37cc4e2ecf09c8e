// What a call of Step costs from C#: StepCost [STEPS] steps a body of one tetrahedron, which no tool touches.
// examples/cpp/step_cost.cpp measures the same in C and C++.
using System;
using System.Diagnostics;
using System.Globalization;
using Crumble;

static class StepCost {
  static void Main(string[] arguments) {
    int calls = arguments.Length > 0 ? int.Parse(arguments[0], CultureInfo.InvariantCulture) : 500000;
    double[] corners = {0, 0, 0, 0.01, 0, 0, 0, 0, 0.01, 0, 0.01, 0};
    using (Mesh mesh = Mesh.CreateFromTets(corners, new uint[] {0, 2, 1, 3}))
    using (var sim = new Simulation(mesh)) {
      sim.FixBelow(1);
      sim.AddTool(new ToolDef());
      var pose = new Pose(0, 0.5, 0);
      double step = Best(calls, () => { for (int i = 0; i < calls; ++i) sim.Step(pose); });
      double drag = Best(calls, () => { for (int i = 0; i < calls; ++i) sim.GetHeldDrag(0); });
      Console.Write(string.Format(CultureInfo.InvariantCulture, "C#   {0:F1} ns a step, {1:F1} ns a call that does little\n",
                                  step, drag));
    }
  }

  static double Best(int calls, Action work) {
    work(); // for the compiler
    double best = double.MaxValue;
    for (int round = 0; round < 9; ++round) {
      Stopwatch watch = Stopwatch.StartNew();
      work();
      best = Math.Min(best, 1e9 * watch.Elapsed.TotalSeconds / calls);
    }
    return best;
  }
}
