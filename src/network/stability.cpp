#include "crumble/network/stability.hpp"

#include <algorithm>
#include <cmath>

#include "crumble/base/memory.hpp"
#include "crumble/base/random.hpp"
#include "crumble/base/transcendental.hpp"

namespace crumble {
namespace {

// 1 - tanh(h) / h
double tanh_defect(double h) {
  if (h < 0.02) return h * h / 3 * (1 - 0.4 * h * h);
  const double e = expm1_exact(std::min(2 * h, 700.0));
  return 1 - e / (e + 2) / h;
}

// 1 - g / (e^g - 1)
double bernoulli_defect(double g) {
  if (g < 0.02) return g / 2 * (1 - g / 6);
  return 1 - g / expm1_exact(std::min(g, 700.0));
}

}  // namespace

double stability_limit(double gamma) {
  return std::min(2 / tanh_defect(gamma / 2), gamma / bernoulli_defect(gamma));
}

double largest_eigenvalue(const SpringNetwork& network, std::span<const Vec3> rest_positions) {
  Random random(1);
  Vector<Vec3> v(network.node_count()), kv(network.node_count());
  for (Vec3& each : v) each = Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  double lambda = 0;
  for (int round = 0; round < 20000; ++round) {
    std::fill(kv.begin(), kv.end(), Vec3::Zero());
    for (std::size_t s = 0; s < network.spring_count(); ++s) {
      const auto [i, j] = network.springs[s];
      const Vec3 along = normalized(rest_positions[j] - rest_positions[i]);
      const Vec3 force = network.stiffnesses[s] * dot(along, v[j] - v[i]) * along;
      kv[i] -= force, kv[j] += force;
    }
    double length = 0;
    for (const Vec3& each : kv) length += squared_norm(each);
    length = std::sqrt(length);
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = kv[i] / length;
    if (round > 10 && std::abs(length - lambda) < 1e-9 * length) return length;
    lambda = length;
  }
  return lambda;
}

}  // namespace crumble
