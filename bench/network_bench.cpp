// The network alone, by kernel, precision and body, 8000 springs, one thread.
//   ./network_bench --benchmark_filter=float32
// Counters: springs, nanoseconds per spring, and how the springs are laid out: which share lies in segments, and which
// share of all lanes holds a spring.
#include <benchmark/benchmark.h>

#include "crumble/base/memory.hpp"
#include "runner/measure.hpp"

namespace crumble::bench {
namespace {

struct Case {
  const BenchBody* body;
  std::string precision, kernel;
  bool torn = false;  // all springs cut
};

void solve(benchmark::State& state, const Case& c) {
  const SimulationDef& def = c.body->def;
  const SpringNetwork network = make_network(def.mesh, def.material, def.mass_rule, def.fixed_nodes);
  SolverSettings settings;
  settings.precision = parse_precision(c.precision);
  settings.kernel = c.kernel;
  settings.length_limit = def.material.length_limit;
  const auto solver = NetworkSolver::make(network, make_coefficients(network, def.step.tau, def.step.policy),
                                          def.mesh.positions, settings);
  if (c.torn) {
    for (std::uint32_t s = 0; s < network.spring_count(); ++s) solver->set_share(s, 0);
  }
  for (auto _ : state) solver->solve({});
  const LayoutReport layout = solver->layout();
  const auto springs = static_cast<double>(network.spring_count());
  state.counters["springs"] = springs;
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * network.spring_count()));
  state.counters["in_segments"] = static_cast<double>(layout.springs_in_segments) / springs;
  state.counters["lane_use"] = springs / static_cast<double>(layout.lanes);
}

// Every kernel on the unbroken body, and the fastest with every spring cut.
void add_cases(const BenchBody& body) {
  for (const std::string& precision : precision_names()) {
    for (const std::string& kernel : kernel_names()) {
      std::string name = body.structure;
      name.append("/").append(precision).append("/").append(kernel);
      benchmark::RegisterBenchmark(name.c_str(), solve, Case{&body, precision, kernel})->Unit(benchmark::kMicrosecond);
    }
    const std::string name = body.structure + "/" + precision + "/all_cut";
    benchmark::RegisterBenchmark(name.c_str(), solve, Case{&body, precision, "", true})->Unit(benchmark::kMicrosecond);
  }
}

}  // namespace
}  // namespace crumble::bench

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  crumble::Vector<crumble::bench::BenchBody> bodies;
  for (const std::string& structure : crumble::bench::structure_names()) {
    bodies.push_back(crumble::bench::make_body(8000, structure, "paper"));
  }
  for (const auto& body : bodies) crumble::bench::add_cases(body);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
