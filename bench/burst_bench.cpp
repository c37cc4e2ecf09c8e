// What a burst of cuts costs the servo loop: the step in which most springs break at once, against an ordinary step
// and against labelling the whole body once.
//   ./burst_bench
// A block of about 8000 springs hangs from its top face under a weight that tears it at once: the springs of a layer
// are equally long, so they break in the same step.
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>

#include "crumble/base/clock.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/fracture/fragments.hpp"
#include "crumble/sim/simulation.hpp"
#include "crumble/tetmesh/lattice_box.hpp"

namespace crumble {
namespace {

constexpr int kRepetitions = 51;
constexpr std::size_t kSteps = 500, kWarmUp = 5;

SimulationDef hanging_block(Precision precision) {
  SimulationDef def;
  def.mesh = make_lattice_box({0.03, 0.03, 0.03}, 0.003);
  for (std::uint32_t n = 0; n < def.mesh.node_count(); ++n) {
    if (def.mesh.positions[n].y() > 0.03 - 1e-6) def.fixed_nodes.push_back(n);
  }
  def.gravity = {0, -160000, 0};
  def.walls.clear();
  def.step.precision = precision;
  return def;
}

double median(crumble::Vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

// Pages that the system had to give this thread so far: none should be in a step.
long page_faults() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_minflt + usage.ru_majflt;
}

template <class Work>
double microseconds(Work&& work) {
  const double before = thread_cpu_seconds();
  work();
  return 1e6 * (thread_cpu_seconds() - before);
}

void report(Precision precision) {
  Simulation sim(hanging_block(precision));
  crumble::Vector<double> ordinary;
  long faults = 0;
  crumble::Vector<crumble::Vector<std::uint8_t>> snapshots;  // before each step
  std::size_t worst = 0;
  std::uint32_t most = 0;
  for (std::size_t step = 0; step < kSteps; ++step) {
    snapshots.push_back(sim.snapshot());
    const long faults_before = page_faults();
    ordinary.push_back(microseconds([&] { sim.step({}); }));
    faults += page_faults() - faults_before;
    if (sim.info().new_cuts > most) most = sim.info().new_cuts, worst = step;
  }
  crumble::Vector<double> burst, labelling;
  FragmentLabeler labeler(sim.mesh().node_count(), sim.mesh().springs);
  for (int i = 0; i < kRepetitions; ++i) {
    const std::size_t first = worst > kWarmUp ? worst - kWarmUp : 0;
    sim.restore(snapshots[first]);
    for (std::size_t step = first; step < worst; ++step) sim.step({});  // what a restore has thrown out of the caches
    burst.push_back(microseconds([&] { sim.step({}); }));
    labelling.push_back(microseconds([&] { labeler.label(sim.intact()); }));
  }
  std::printf(
      "%s: %zu springs; ordinary step %.1f us, step with %u cuts %.1f us, one labelling %.1f us: %.2f of 2 steps + "
      "labelling; %ld page faults in %zu steps\n",
      precision == Precision::float32 ? "float32" : "float64", sim.mesh().springs.size(), median(ordinary), most,
      median(burst), median(labelling), median(burst) / (2 * median(ordinary) + median(labelling)), faults, kSteps);
}

}  // namespace
}  // namespace crumble

int main() {
  crumble::report(crumble::Precision::float64);
  crumble::report(crumble::Precision::float32);
}
