// examples/c/same_force.c with crumble.hpp, the C API for C++: prints the same.
#include <cinttypes>
#include <crumble/crumble.hpp>
#include <cstdio>

int main() try {
  namespace cr = crumble::c;
  const cr::Mesh cube = cr::Mesh::create_paper(CRUMBLE_PAPER_CUBE);
  cr::Sim sim(cube);
  sim.fix_below(1e-6);
  sim.add_tool(cr::ToolDef());

  crumble_pose pose = cr::pose_at(0, 0, 0);
  crumble_wrench wrench{};
  for (int step = 1; step <= 1500; ++step) {
    pose.position[1] = 0.034 - 1e-5 * step;
    wrench = sim.step(pose);
  }
  std::printf("force %.12f N\ncuts %" PRIu64 "\nhash %016" PRIx64 "\n", wrench.force[1], sim.get_counters().cuts,
              sim.state_hash());
} catch (const crumble::c::Error& error) {
  std::fprintf(stderr, "%s: %s\n", error.name(), error.what());
  return 1;
}
