// Shading: a unit normal for each corner of each triangle.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "crumble/base/memory.hpp"
#include "surface_arrays.hpp"
#include "surface_triangles.hpp"

namespace crumble {

class SurfaceNormals {
 public:
  SurfaceNormals(const SurfaceTopology& topology, std::size_t triangle_bound)
      : topology_(topology), sums_(topology.normal_slot_count), corners_(triangle_bound) {}

  /// Of all triangles, from the vertices' positions.
  void update(const TriangleList& triangles, std::span<const Vec3> positions) noexcept;
  std::span<const std::array<Eigen::Vector3f, 3>> corners(std::size_t count) const noexcept {
    return corners_.first(count);
  }

 private:
  void shade_skin(const TriangleList& triangles, std::span<const Vec3> positions) noexcept;
  void shade_interior(const TriangleList& triangles, std::span<const Vec3> positions) noexcept;

  const SurfaceTopology& topology_;
  Vector<Vec3> sums_;  // per normal slot: area vectors of the skin round it
  UntouchedArray<std::array<Eigen::Vector3f, 3>> corners_;
};

}  // namespace crumble
