#include "crumble/network/coefficients.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "crumble/base/error.hpp"
#include "crumble/base/text.hpp"
#include "crumble/base/transcendental.hpp"

namespace crumble {

double phi1(double gamma) {
  return gamma == 0 ? 1 : -expm1_exact(-gamma) / gamma;
}

double phi2(double gamma) {
  if (gamma >= 0.5) return (1 - phi1(gamma)) / gamma;
  double sum = 0;  // sum over n of (-gamma)^n / (n + 2)!, by Horner
  for (int n = 18; n >= 1; --n) sum = (1 + sum) * -gamma / (n + 2);
  return (1 + sum) / 2;
}

namespace {

double certified_time_step(const SpringNetwork& network) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < network.node_count(); ++i) {
    if (!network.fixed[i] && network.stiffness_sums[i] > 0) {
      least = std::min(least, network.drags[i] / network.stiffness_sums[i]);
    }
  }
  return least;
}

void check_time_step(double tau) {
  require_positive("step.tau", tau);
  if (tau > kMaxTimeStep) {
    throw Error(Code::dt_too_large, "step.tau must not exceed " + to_text(kMaxTimeStep) + " s, is " + to_text(tau));
  }
}

std::uint32_t substeps_needed(double tau, double certified) {
  const double needed = std::ceil(tau / certified);
  if (!(needed <= kMaxSubsteps)) {
    throw Error(Code::dt_too_large, "step.tau " + to_text(tau) + " s needs more than " + std::to_string(kMaxSubsteps) +
                                        " substeps (certified time step " + to_text(certified) +
                                        " s); use the guard policy");
  }
  return static_cast<std::uint32_t>(std::max(needed, 1.0));
}

void refuse_unstable(double tau, double certified) {
  if (tau > certified) {
    throw Error(Code::dt_too_large, "step.tau " + to_text(tau) + " s is longer than the certified time step " +
                                        to_text(certified) + " s, and the policy is to refuse that");
  }
}

void refuse_undamped(const SpringNetwork& network) {
  for (std::size_t i = 0; i < network.node_count(); ++i) {
    if (network.drags[i] <= 0) {
      throw Error(Code::out_of_range, "material.damping_ratio 0 is unstable under this time-step policy; use guard");
    }
  }
}

void set_node(StepCoefficients& c, double tau, double mass, double drag, bool fixed) {
  const double gamma = drag * tau / mass;
  const double keep = fixed ? 0 : 1;
  c.decay.push_back(keep * exp_exact(-gamma));
  c.velocity_gain.push_back(keep * (tau / mass * phi1(gamma)));
  c.drift.push_back(keep * (tau * phi1(gamma)));
  c.force_gain.push_back(keep * (tau * (tau / mass) * phi2(gamma)));
  c.drags.push_back(drag);
}

}  // namespace

StepCoefficients make_coefficients(const SpringNetwork& network, double tau, TimeStepPolicy policy) {
  check_time_step(tau);
  StepCoefficients c;
  c.certified_time_step = certified_time_step(network);
  if (policy == TimeStepPolicy::substep) c.substeps = substeps_needed(tau, c.certified_time_step);
  if (policy == TimeStepPolicy::error) refuse_unstable(tau, c.certified_time_step);
  if (policy == TimeStepPolicy::unchecked) refuse_undamped(network);
  c.substep = tau / c.substeps;
  for (std::size_t i = 0; i < network.node_count(); ++i) {
    double drag = network.drags[i];
    const double needed = c.substep * network.stiffness_sums[i];
    if (policy == TimeStepPolicy::guard && drag < needed && !network.fixed[i]) {
      drag = needed;
      ++c.guarded_nodes;
    }
    set_node(c, c.substep, network.masses[i], drag, network.fixed[i]);
  }
  return c;
}

}  // namespace crumble
