// The network alone, its baselines beside it, taking turns so that what disturbs the machine hits them alike.
#pragma once

#include "runner/measure.hpp"

namespace crumble::bench {

/// Fills the network's part of `row`. `network` and `coefficients` belong to body.def.
void race_networks(const BenchBody& body, const SpringNetwork& network, const StepCoefficients& coefficients,
                   const SolverSettings& settings, Row& row);

}  // namespace crumble::bench
