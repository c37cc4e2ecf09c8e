// The paper's experiment of section 3.2: 500 materials, each pressed at 1 mm/s, with its time step of 2.9 ms.
//
// A step that is too long for a material does not show as NaN: the body crumbles by itself. So each point is run at tau
// and at tau / 3, and has failed when the long step breaks far more springs than the short one.
#pragma once

#include <cstddef>
#include <cstdint>

#include "crumble/network/coefficients.hpp"
#include "crumble/network/spring_network.hpp"

namespace crumble::grid {

inline constexpr std::size_t kPoints = 500;

/// k = 10..100, alpha = 5..50, l_p = 1.1..1.5, in this order, the last fastest.
Material material_at(std::size_t point);
/// Its inverse, for points that are named by their material.
std::size_t point_at(int stiffness, int damping_ratio, double length_limit);

struct PointResult {
  std::uint64_t cuts = 0;        // at tau = 2.9 ms
  std::uint64_t cuts_third = 0;  // at tau / 3
  std::uint64_t guarded = 0;     // nodes, at tau
  bool diverged = false;         // in either run

  bool failed() const { return diverged || static_cast<double>(cuts) > 1.5 * static_cast<double>(cuts_third) + 100; }
};

/// Presses the stick of the scene tofu_cube to 26 mm, twice. About 2 s of CPU time.
PointResult run_point(std::size_t point, TimeStepPolicy policy);

}  // namespace crumble::grid
