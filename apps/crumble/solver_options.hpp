// Who computes a step: options that change no bit of what comes out.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "crumble/sim/definition.hpp"

namespace crumble::app {

struct SolverOptions {
  std::string kernel;  // empty: the library's choice
  int threads = 1;
};

/// --kernel and --threads.
void add_options(CLI::App& command, SolverOptions& options);
/// Throws Error naming the option and the value: unsupported, out_of_range.
void check(const SolverOptions& options);
void apply(const SolverOptions& options, StepSettings& settings);

}  // namespace crumble::app
