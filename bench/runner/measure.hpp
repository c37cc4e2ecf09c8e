// One line of the benchmark: the network alone beside its baselines, then whole steps of a press.
#pragma once

#include <optional>
#include <string>

#include "crumble/base/memory.hpp"
#include "crumble/sim/simulation.hpp"
#include "runner/body.hpp"
#include "runner/clocks.hpp"

namespace crumble::bench {

Vector<std::string> precision_names();
/// Throws Error(unsupported).
Precision parse_precision(const std::string& name);
inline constexpr std::uint32_t kMostThreads = 64;
inline constexpr std::size_t kMostSteps = 1'000'000;

struct Settings {
  std::string precision = "float32";
  std::string kernel;  // empty: the solver's choice
  std::uint32_t threads = 1;
  std::size_t steps = 2000;  // in the timed window
};

/// Times in microseconds. With more than one thread CPU times are those of the thread that steps, which shares the work
/// and then waits for the others: Linux knows other running threads' times to the next tick only.
struct Row {
  std::string structure, stick, lattice, precision, kernel;
  std::size_t wanted_springs = 0, springs = 0, nodes = 0, steps = 0;
  std::uint32_t threads = 1;
  LayoutReport layout;

  // medians over rounds in which the contestants take turns; CPU time of one step of the network alone
  double network = 0;
  double plain = 0;                         // on the nodes in lattice row order
  std::optional<double> plain_as_it_comes;  // of a shuffled body: the plain loop on the shuffled nodes
  std::optional<double> bullet;             // nothing: not installed
  double ratio = 0;                         // median over the rounds of plain / network
  std::optional<double> bullet_ratio;       // the same of bullet / network
  double network_wall = 0;
  double difference_from_plain = 0;  // of positions after 100 steps, metres

  Percentiles step_cpu;                     // of each step the median of three passes
  Percentiles step_raw, step_wall;          // of all passes: CPU and wall time
  Percentiles control_raw, control_wall;    // the same of an empty loop that takes as long as the median step
  StepProfile stages;                       // medians of wall time
  std::uint64_t cuts = 0, cuts_before = 0;  // in the timed window, and before it
  std::uint32_t contacts = 0;               // at its end
  std::uint64_t hash = 0;                   // of the state at its end
};

/// Throws Error: unsupported, out_of_range (a setting), diverged.
Row measure(const BenchBody& body, const Settings& settings);

}  // namespace crumble::bench
