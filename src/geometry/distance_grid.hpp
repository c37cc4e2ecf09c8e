// A grid that tells, without a search, what is surely outside a mesh.
#pragma once

#include "crumble/base/memory.hpp"
#include "geometry/mesh_checks.hpp"

namespace crumble {

/// One number for each cube of a grid round the mesh: how far its centre lies outside, by FCL, less a margin for what
/// FCL may be wrong by; 0 for centres inside. It only culls, so no answer of the solid depends on FCL's last bits.
class DistanceGrid {
 public:
  DistanceGrid() = default;
  explicit DistanceGrid(const CheckedMesh& checked);

  /// A distance that p surely lies outside by, metres; 0 or less when that is not known. NaN for a p that is not
  /// finite.
  double least_distance(const Vec3& p) const noexcept;
  std::size_t cell_count() const noexcept { return clearance_.size(); }

 private:
  Vec3 center_of(const std::array<std::size_t, 3>& cell) const noexcept;

  Vec3 low_ = Vec3::Zero(), high_ = Vec3::Zero();  // of the mesh, without margin
  Vec3 origin_ = Vec3::Zero();                     // of the grid
  double cell_ = 1;                                // edge, metres
  std::array<std::size_t, 3> counts_{};
  Vector<float> clearance_;  // metres
};

}  // namespace crumble
