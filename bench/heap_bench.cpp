// What a heap of crumbs costs the servo loop beside the body that it was: CPU time of a step of the paper's cube
//   intact and fixed at its bottom, intact and loose on the floor,
//   being stirred to 200 fragments and on, and as the heap that is left, at rest.
//   ./heap_bench
// No tool touches the body but where it is stirred. The stages are medians of wall time, with their names of
// StepProfile.
#include <algorithm>
#include <cstdio>

#include "crumble/base/clock.hpp"
#include "crumble/base/memory.hpp"
#include "sim/heap_rig.hpp"

namespace crumble {
namespace {

constexpr int kSteps = 2000;
constexpr std::size_t kFragments = 200;

double quantile(crumble::Vector<double>& values, double share) {
  const auto place = values.begin() + static_cast<long>(share * static_cast<double>(values.size()));
  std::nth_element(values.begin(), place, values.end());
  return 1e6 * *place;
}

// Prints a row, beside `unit`, the median of another (0: this row's own). Returns the median, microseconds.
template <class Step>
double report(const char* name, HeapRig& rig, double unit, Step&& step) {
  crumble::Vector<double> cpu, find, project, touch, solve, cut;
  for (int s = 0; s < kSteps; ++s) {
    const double before = thread_cpu_seconds();
    step();
    cpu.push_back(thread_cpu_seconds() - before);
    const StepProfile& profile = rig.sim.profile();
    find.push_back(profile.find_contacts), project.push_back(profile.project_contacts);
    touch.push_back(profile.touch_fragments);
    solve.push_back(profile.solve_network), cut.push_back(profile.cut_springs);
  }
  const double p50 = quantile(cpu, 0.5), p99 = quantile(cpu, 0.99);
  std::printf("  %-26s %3zu fragments %4zu pairs  p50 %6.1f (%.2f)  p99 %6.1f (%.2f)   %6.1f %6.1f %6.1f %6.1f %6.1f\n",
              name, rig.fragment_count(), rig.sim.ball_contact_count(), p50, p50 / (unit > 0 ? unit : p50), p99,
              p99 / (unit > 0 ? unit : p50), quantile(find, 0.5), quantile(project, 0.5), quantile(touch, 0.5),
              quantile(solve, 0.5), quantile(cut, 0.5));
  return p50;
}

void report(Precision precision) {
  std::printf(
      "%s: CPU microseconds of a step (in parentheses: / median of the loose intact body);  find project touch solve "
      "cut\n",
      precision == Precision::float32 ? "float32" : "float64");
  HeapRig rig(precision), fixed(precision);
  SimulationDef def = HeapRig::definition(precision);
  def.fixed_nodes = nodes_below(def.mesh, 1e-6);
  fixed.sim = Simulation(std::move(def));
  rig.wait(1000), fixed.wait(1000);  // until what sags has sagged
  const double unit = report("intact, loose on the floor", rig, 0, [&] { rig.wait(1); });
  report("intact, fixed", fixed, unit, [&] { fixed.wait(1); });
  rig.stir_until(kFragments, 60);
  report("stirred", rig, unit, [&] { rig.stir(); });
  rig.lift();
  rig.wait(2000);
  report("at rest", rig, unit, [&] { rig.wait(1); });
}

}  // namespace
}  // namespace crumble

int main() {
  crumble::report(crumble::Precision::float32);
  crumble::report(crumble::Precision::float64);
}
