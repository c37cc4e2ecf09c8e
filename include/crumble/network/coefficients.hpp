// Eqs (3) and (4) of the paper, written without loss of digits, and the four answers to "is this time step small
// enough".
//
// With gamma = c tau / m, phi1 = (1 - e^-gamma) / gamma and phi2 = (1 - phi1) / gamma the paper's update is exactly
//     v+ = e^-gamma v + (tau / m) phi1 f        x+ = x + tau phi1 v + (tau^2 / m) phi2 f        (f frozen over the
//     step)
// All four factors depend on mass, drag and tau only, so they are worked out here, once; no step calls exp.
#pragma once

#include <cstddef>
#include <cstdint>

#include "crumble/base/memory.hpp"
#include "crumble/network/spring_network.hpp"

namespace crumble {

double phi1(double gamma);
double phi2(double gamma);

/// What to do when the time step is longer than the certified one (docs/numerics.md, the energy theorem).
enum class TimeStepPolicy : std::uint8_t {
  guard = 0,      // raise the drag of the nodes concerned to tau D_i: stable everywhere, bit-identical where not needed
  substep = 1,    // divide the step: the exact model
  error = 2,      // refuse
  unchecked = 3,  // the paper's way: nothing
};

struct StepCoefficients {
  double substep = 0;              // length of one substep, seconds
  std::uint32_t substeps = 1;      // per step
  double certified_time_step = 0;  // min c_i / D_i over nodes that move: energy cannot grow up to here, seconds
  std::size_t guarded_nodes = 0;   // whose drag the guard raised
  // per node; all zero at a fixed node
  Vector<double> decay;          // e^-gamma
  Vector<double> velocity_gain;  // (tau / m) phi1, s/kg
  Vector<double> drift;          // tau phi1, s
  Vector<double> force_gain;     // (tau^2 / m) phi2, s^2/kg
  Vector<double> drags;          // c_i in force, N s/m
};

/// Throws Error: out_of_range (tau), dt_too_large (tau above kMaxTimeStep; tau above the certified one under
/// `error`; more than kMaxSubsteps needed under `substep`), out_of_range (alpha = 0 under error or unchecked).
StepCoefficients make_coefficients(const SpringNetwork& network, double tau, TimeStepPolicy policy);

inline constexpr double kMaxTimeStep = 0.01;       // seconds
inline constexpr std::uint32_t kMaxSubsteps = 64;  // per step

}  // namespace crumble
