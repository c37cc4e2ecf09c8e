// What a call of step costs in C and with crumble.hpp: a body of one tetrahedron, which no tool touches. The two take
// turns, and the least of their times counts. bindings/csharp/examples/StepCost.cs measures the same in C#.
#include <algorithm>
#include <chrono>
#include <crumble/crumble.hpp>
#include <cstdio>

namespace {

constexpr int kCalls = 500000;

template <class Call>
double nanoseconds(Call&& call) {
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < kCalls; ++i) call();
  return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count() / kCalls;
}

}  // namespace

int main() try {
  const double corners[] = {0, 0, 0, 0.01, 0, 0, 0, 0, 0.01, 0, 0.01, 0};
  const std::uint32_t tetrahedron[] = {0, 2, 1, 3};
  crumble::c::Sim sim(crumble::c::Mesh::create_from_tets(corners, tetrahedron));
  sim.fix_below(1);
  sim.add_tool(crumble::c::ToolDef());
  const crumble_pose pose = crumble::c::pose_at(0, 0.5, 0);
  double sum = 0, best[4] = {1e9, 1e9, 1e9, 1e9};
  for (int round = 0; round < 9; ++round) {
    const double took[] = {nanoseconds([&] {
                             crumble_wrench wrench;
                             if (crumble_sim_step(sim.get(), &pose, &wrench) != CRUMBLE_OK) return;
                             sum += wrench.force[1];
                           }),
                           nanoseconds([&] { sum += sim.step(pose).force[1]; }), nanoseconds([&] {
                             double drag = 0;
                             if (crumble_sim_get_held_drag(sim.get(), 0, &drag) == CRUMBLE_OK) sum += drag;
                           }),
                           nanoseconds([&] { sum += sim.get_held_drag(0); })};
    for (int i = 0; i < 4; ++i) best[i] = std::min(best[i], took[i]);
  }
  std::printf("C    %.1f ns a step, %.1f ns a call that does little\n", best[0], best[2]);
  std::printf("C++  %.1f ns a step, %.1f ns a call that does little\n", best[1], best[3]);
  return sum == 0 ? 0 : 1;
} catch (const crumble::c::Error& error) {
  std::fprintf(stderr, "%s: %s\n", error.name(), error.what());
  return 1;
}
