// Shimada and Gossard's bubbles. Two bubbles at distance l with the rest distance l0 push each other by
//
//   f(w) = 1.25 w^3 - 2.375 w^2 + 1.125,   w = l / l0 < 1.5, else 0
//
// which repels below w = 1, attracts up to 1.5 (f(1) = f(1.5) = 0, f'(0) = 0, f'(1) = -1) and knows no farther
// neighbour. A velocity that keeps 0.7 of itself per iteration stands for mass and viscosity. All nodes move at once
// from the positions of the iteration before (Jacobi), so the result does not hang on the order of the nodes.
//
// The neighbour lists reach 0.3 l0 farther than the force does; they stay valid until some node has moved half of it.
#include "bubblemesh/relax.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>

#include "bubblemesh/neighbour_grid.hpp"
#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

constexpr double kReach = 1.5;        // of the force, in l0
constexpr double kSkin = 0.4;         // of the neighbour lists beyond it, in l0
constexpr double kMemory = 0.7;       // of the velocity
constexpr double kGain = 0.12;        // of the force, in l0
constexpr double kLongestStep = 0.1;  // in l0
constexpr double kStill = 2e-3;       // longest step at which all is at rest, in l0
// Bubbles inside rest a little closer than d, which leaves fewer flat tetrahedra; on the surface at d.
constexpr double kInsideRest = 0.97;
// Deeper nodes, in d, are out of reach of all that are moved; those move by less than d / 2.
constexpr double kFeltDepth = kRelaxedDepth + kReach + kSkin + 0.5;
// Surface nodes on the far side of a thin wall or beyond a crease do not count.
constexpr double kSameSide = 0.3;

/// Neighbours of the active nodes among the present ones.
class NeighbourLists {
 public:
  NeighbourLists(const Cloud& cloud, std::span<const std::uint32_t> present, std::span<const std::uint32_t> active,
                 double radius, const Vec3& lower, const Vec3& upper) {
    NeighbourGrid grid(lower, upper, radius / 2);
    for (const std::uint32_t i : present) grid.add(cloud.positions[i], i);
    starts_.reserve(active.size() + 1);
    starts_.push_back(0);
    for (const std::uint32_t i : active) {
      const bool on_surface = cloud.kinds[i] == NodeKind::surface;
      grid.for_each_within(cloud.positions[i], radius, [&](std::uint32_t j, double) {
        if (j == i) return;
        const bool hidden =
            on_surface && cloud.kinds[j] == NodeKind::surface && dot(cloud.normals[i], cloud.normals[j]) < kSameSide;
        if (!hidden) neighbours_.push_back(j);
      });
      starts_.push_back(neighbours_.size());
    }
  }
  std::span<const std::uint32_t> of(std::size_t k) const {
    return std::span(neighbours_).subspan(starts_[k], starts_[k + 1] - starts_[k]);
  }

 private:
  Vector<std::size_t> starts_;
  Vector<std::uint32_t> neighbours_;
};

Vec3 force_on(const Vec3& p, std::span<const std::uint32_t> neighbours, const Vector<Vec3>& positions, double rest) {
  Vec3 force = Vec3::Zero();
  const double reach2 = kReach * kReach * rest * rest;
  for (const std::uint32_t j : neighbours) {
    const Vec3 away = p - positions[j];
    const double squared = squared_norm(away);
    if (squared >= reach2 || squared == 0) continue;
    const double length = std::sqrt(squared), w = length / rest;
    force += ((1.25 * w - 2.375) * w * w + 1.125) / length * away;
  }
  return force;
}

/// constrain(i, position, step) puts the moved node where it may be and may shorten its velocity; flatten(i, force)
/// removes what the node may not follow.
template <class Flatten, class Constrain>
void relax(const Shape& shape, double rest, int iterations, std::span<const std::uint32_t> present,
           std::span<const std::uint32_t> active, Cloud& cloud, Flatten flatten, Constrain constrain) {
  const double radius = (kReach + kSkin) * rest, half_skin2 = 0.25 * kSkin * kSkin * rest * rest;
  const double longest = kLongestStep * rest;
  Vector<Vec3> velocities(active.size(), Vec3::Zero()), moved(active.size()), listed(active.size());
  std::optional<NeighbourLists> lists;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    if (!lists) {
      lists.emplace(cloud, present, active, radius, shape.lower(), shape.upper());
      for (std::size_t k = 0; k < active.size(); ++k) listed[k] = cloud.positions[active[k]];
    }
    double longest_step2 = 0, farthest2 = 0;
    for (std::size_t k = 0; k < active.size(); ++k) {
      const std::uint32_t i = active[k];
      const Vec3& p = cloud.positions[i];
      const Vec3 force = flatten(i, force_on(p, lists->of(k), cloud.positions, rest));
      Vec3& velocity = velocities[k];
      velocity = kMemory * velocity + kGain * rest * force;
      const double speed = norm(velocity);
      if (speed > longest) velocity *= longest / speed;
      moved[k] = constrain(i, p + velocity);
      longest_step2 = std::max(longest_step2, squared_norm(moved[k] - p));
      farthest2 = std::max(farthest2, squared_norm(moved[k] - listed[k]));
    }
    for (std::size_t k = 0; k < active.size(); ++k) cloud.positions[active[k]] = moved[k];
    if (longest_step2 < kStill * kStill * rest * rest) return;
    if (farthest2 > half_skin2) lists.reset();
  }
}

}  // namespace

void relax_surface(const Shape& shape, double spacing, int iterations, Cloud& cloud) {
  Vector<std::uint32_t> present(cloud.surface_count);
  std::iota(present.begin(), present.end(), 0u);
  const auto active = std::span(present).subspan(cloud.feature_count);
  const auto flatten = [&](std::uint32_t i, const Vec3& force) -> Vec3 {
    return force - dot(force, cloud.normals[i]) * cloud.normals[i];
  };
  const auto constrain = [&](std::uint32_t i, const Vec3& target) {
    const SurfacePoint on = shape.project(target);
    cloud.normals[i] = on.normal;
    return on.point;
  };
  relax(shape, spacing, iterations, present, active, cloud, flatten, constrain);
}

void relax_inside(const Shape& shape, double spacing, int iterations, Cloud& cloud) {
  const double least = kLeastDepth * spacing;
  Vector<std::uint32_t> present(cloud.surface_count), active;
  std::iota(present.begin(), present.end(), 0u);
  Vector<double> depth(cloud.size());  // a lower bound: the distance is asked again only when it could matter
  for (std::size_t i = cloud.surface_count; i < cloud.size(); ++i) {
    depth[i] = -shape.signed_distance(cloud.positions[i]);
    if (depth[i] < kFeltDepth * spacing) present.push_back(static_cast<std::uint32_t>(i));
    if (depth[i] < kRelaxedDepth * spacing) active.push_back(static_cast<std::uint32_t>(i));
  }
  const auto constrain = [&](std::uint32_t i, const Vec3& target) -> Vec3 {
    depth[i] -= norm(target - cloud.positions[i]);
    if (depth[i] >= least) return target;
    depth[i] = -shape.signed_distance(target);
    if (depth[i] >= least) return target;
    depth[i] = least;
    const SurfacePoint on = shape.project(target);
    return on.point - least * on.normal;
  };
  const auto follow = [](std::uint32_t, const Vec3& force) { return force; };
  relax(shape, kInsideRest * spacing, iterations, present, active, cloud, follow, constrain);
}

}  // namespace crumble
