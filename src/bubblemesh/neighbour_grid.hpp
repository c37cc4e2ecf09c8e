// Who is near: points in cells, one at a time.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "crumble/base/memory.hpp"
#include "crumble/base/vec.hpp"

namespace crumble {

/// Points may be added at any time. A cell's points are visited newest first, cells in x, y, z order, so that sums
/// over neighbours have one fixed order.
class NeighbourGrid {
 public:
  /// Points outside [lower, upper] are held by the cells at the border: correct, only slower.
  NeighbourGrid(const Vec3& lower, const Vec3& upper, double cell) : lower_(lower), cell_(cell) {
    std::size_t total = 1;
    for (int k = 0; k < 3; ++k) {
      count_[k] = std::max(1, static_cast<int>((upper[k] - lower[k]) / cell) + 1);
      total *= static_cast<std::size_t>(count_[k]);
    }
    heads_.assign(total, kNone);
  }

  void add(const Vec3& point, std::uint32_t id) {
    std::uint32_t& head = heads_[index(cell_of(point.x(), 0), cell_of(point.y(), 1), cell_of(point.z(), 2))];
    entries_.push_back({point, id, head});
    head = static_cast<std::uint32_t>(entries_.size() - 1);
  }

  /// visit(id, squared distance) for every point within `radius` of p.
  template <class Visit>
  void for_each_within(const Vec3& p, double radius, Visit visit) const {
    const double limit = radius * radius;
    std::array<int, 3> first, last;
    for (int k = 0; k < 3; ++k) {
      first[k] = cell_of(p[k] - radius, k);
      last[k] = cell_of(p[k] + radius, k);
    }
    for (int z = first[2]; z <= last[2]; ++z) {
      for (int y = first[1]; y <= last[1]; ++y) {
        for (int x = first[0]; x <= last[0]; ++x) {
          for (std::uint32_t e = heads_[index(x, y, z)]; e != kNone; e = entries_[e].next) {
            const double squared = squared_norm(entries_[e].point - p);
            if (squared < limit) visit(entries_[e].id, squared);
          }
        }
      }
    }
  }

  /// Squared distance of the nearest point within `radius`; radius^2 when there is none.
  double nearest_squared(const Vec3& p, double radius) const {
    double least = radius * radius;
    for_each_within(p, radius, [&](std::uint32_t, double squared) { least = std::min(least, squared); });
    return least;
  }
  bool is_free(const Vec3& p, double radius) const { return nearest_squared(p, radius) >= radius * radius; }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  struct Entry {
    Vec3 point;
    std::uint32_t id, next;
  };

  int cell_of(double value, int axis) const {
    const double cell = std::floor((value - lower_[axis]) / cell_);
    return static_cast<int>(std::clamp(cell, 0.0, static_cast<double>(count_[axis] - 1)));
  }
  std::size_t index(int x, int y, int z) const {
    return static_cast<std::size_t>(x) +
           static_cast<std::size_t>(count_[0]) *
               (static_cast<std::size_t>(y) + static_cast<std::size_t>(count_[1]) * static_cast<std::size_t>(z));
  }

  Vec3 lower_;
  double cell_;
  std::array<int, 3> count_{};
  Vector<std::uint32_t> heads_;
  Vector<Entry> entries_;
};

}  // namespace crumble
