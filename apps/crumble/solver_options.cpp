#include "solver_options.hpp"

#include "runner/choice.hpp"
#include "runner/measure.hpp"

namespace crumble::app {

void add_options(CLI::App& command, SolverOptions& options) {
  command.add_option("--kernel", options.kernel, "See --version; else $CRUMBLE_KERNEL or the fastest");
  command.add_option("--threads", options.threads, "1 to 64; a body below 50 000 springs uses one")
      ->capture_default_str();
}

void check(const SolverOptions& options) {
  if (!options.kernel.empty()) bench::require_choice("--kernel", options.kernel, kernel_names());
  require_in_range("--threads", options.threads, 1, bench::kMostThreads);
}

void apply(const SolverOptions& options, StepSettings& settings) {
  settings.kernel = options.kernel;
  settings.threads = static_cast<std::uint32_t>(options.threads);
}

}  // namespace crumble::app
