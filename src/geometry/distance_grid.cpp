#include "geometry/distance_grid.hpp"

#include <algorithm>
#include <cmath>

#include "crumble/base/memory.hpp"
#include "geometry/mesh_distance_fcl.hpp"
#include "geometry/winding_number.hpp"

namespace crumble {
namespace {

// At 10 to 20 us for each distance of a fine mesh; a coarse mesh has no use for a fine grid.
constexpr std::size_t kMaxCells = 12'000, kMinCells = 512, kCellsPerTriangle = 8;
constexpr std::size_t kMaxAlong = 64;
constexpr double kFclError = 1e-5;  // of the size; FCL's distances were within 1e-9 of it

}  // namespace

Vec3 DistanceGrid::center_of(const std::array<std::size_t, 3>& cell) const noexcept {
  return origin_ + cell_ * Vec3(static_cast<double>(cell[0]) + 0.5, static_cast<double>(cell[1]) + 0.5,
                                static_cast<double>(cell[2]) + 0.5);
}

// The sign of a cell whose cube the surface does not enter is that of its neighbour of the same kind, so one winding
// number for each region of such cells is enough.
DistanceGrid::DistanceGrid(const CheckedMesh& checked) {
  low_ = high_ = checked.mesh.vertices[0];
  for (const Vec3& v : checked.mesh.vertices) low_ = low_.cwiseMin(v), high_ = high_.cwiseMax(v);
  const double longest = (high_ - low_).maxCoeff();
  const std::size_t most = std::clamp(kCellsPerTriangle * checked.mesh.triangles.size(), kMinCells, kMaxCells);
  std::size_t total = 0;
  for (std::size_t along = kMaxAlong; total == 0 || total > most; --along) {
    cell_ = longest / static_cast<double>(along);
    total = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {  // one cell more on either side
      const double edge = high_[static_cast<int>(axis)] - low_[static_cast<int>(axis)];
      counts_[axis] = static_cast<std::size_t>(std::ceil(edge / cell_ - 1e-9)) + 2;
      total *= counts_[axis];
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    const double length = cell_ * static_cast<double>(counts_[static_cast<std::size_t>(axis)]);
    origin_[axis] = 0.5 * (low_[axis] + high_[axis]) - 0.5 * length;
  }
  Vector<Vec3> centers;
  for (std::size_t i = 0; i < total; ++i) {
    centers.push_back(center_of({i % counts_[0], i / counts_[0] % counts_[1], i / counts_[0] / counts_[1]}));
  }
  const Vector<double> distances = distances_from_mesh(checked.mesh, centers);
  const double margin = kFclError * checked.size;
  clearance_.assign(total, 0);
  Vector<std::uint8_t> seen(total, 0);
  Vector<std::size_t> region;
  for (std::size_t i = 0; i < total; ++i) {
    const auto is_clear = [&](std::size_t c) { return distances[c] - margin > 0.5 * std::sqrt(3.0) * cell_; };
    if (seen[i] || !is_clear(i)) continue;
    const bool outside = std::round(winding_number(checked.mesh, centers[i])) == 0;
    region = {i};
    seen[i] = 1;
    for (std::size_t k = 0; k < region.size(); ++k) {
      const std::size_t c = region[k];
      if (outside) clearance_[c] = static_cast<float>(distances[c] - margin);
      const std::size_t at[3] = {c % counts_[0], c / counts_[0] % counts_[1], c / counts_[0] / counts_[1]};
      const std::size_t stride[3] = {1, counts_[0], counts_[0] * counts_[1]};
      for (int axis = 0; axis < 3; ++axis) {
        for (const bool up : {false, true}) {
          if (up ? at[axis] + 1 == counts_[static_cast<std::size_t>(axis)] : at[axis] == 0) continue;
          const std::size_t next = up ? c + stride[axis] : c - stride[axis];
          if (seen[next] || !is_clear(next)) continue;
          seen[next] = 1;
          region.push_back(next);
        }
      }
    }
  }
}

double DistanceGrid::least_distance(const Vec3& p) const noexcept {
  double squared = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double d = std::max({low_[axis] - p[axis], p[axis] - high_[axis], 0.0});
    squared += d * d;
  }
  if (squared > 0) return std::sqrt(squared);
  if (!is_finite(p)) return std::numeric_limits<double>::quiet_NaN();
  std::array<std::size_t, 3> cell{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int k = static_cast<int>(axis);
    cell[axis] = std::min(static_cast<std::size_t>((p[k] - origin_[k]) / cell_), counts_[axis] - 1);
  }
  const double clearance = clearance_[(cell[2] * counts_[1] + cell[1]) * counts_[0] + cell[0]];
  return clearance > 0 ? clearance - norm(p - center_of(cell)) : 0;
}

}  // namespace crumble
