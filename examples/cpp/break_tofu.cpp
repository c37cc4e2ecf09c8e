// Presses a round stick of 8 mm diameter 15 mm into the paper's tofu cube, at 10 mm/s, and prints the force.
#include <crumble/bubblemesh/presets.hpp>
#include <crumble/sim/simulation.hpp>
#include <cstdio>

int main() try {
  crumble::SimulationDef def;
  def.mesh = crumble::generate_paper_body(crumble::PaperBody::cube).mesh;
  def.fixed_nodes = crumble::nodes_below(def.mesh, 1e-6);          // the bottom sticks to the table
  def.tools = {{crumble::make_round_stick(0.004, 0.05, 16), {}}};  // lying across the top face
  crumble::Simulation sim(std::move(def));

  crumble::Pose pose;
  for (int step = 1; step <= 1500; ++step) {
    pose.position.y() = 0.034 - 1e-5 * step;
    sim.step({&pose, 1});
    if (step % 100 == 0) std::printf("depth %4.1f mm  force %6.3f N\n", 0.01 * step, sim.wrench(0).force.y());
  }
  std::printf("%llu springs cut\n", static_cast<unsigned long long>(sim.counters().cuts));
} catch (const crumble::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
