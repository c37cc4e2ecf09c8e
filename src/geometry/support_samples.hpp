// A convex set as its support function tells it along many directions.
#pragma once

#include "crumble/base/memory.hpp"
#include "crumble/geometry/support_solid.hpp"

namespace crumble {

class SupportSamples {
 public:
  /// Throws what make_support_solid() throws.
  SupportSamples(const SupportFunction& function, const Vec3& inside);

  Vec3 support(const Vec3& unit_direction) const noexcept {
    Vec3 point;
    function_.support(function_.context, unit_direction.data(), point.data());
    return point;
  }
  /// Greatest distance of p above the planes of the samples: the set lies at least as far away.
  double greatest_above(const Vec3& p, std::uint32_t& sample) const noexcept;
  /// How far one can go from p along `direction` before a plane of the samples, moved out by `grown`, holds one back.
  double way_along(const Vec3& p, const Vec3& direction, double grown) const noexcept;

  double size() const noexcept { return norm(high_ - low_); }  // diagonal of the box, metres
  Vector<Vec3> box_corners() const;
  /// The support points, equal ones made one, and the triangles that keep three corners.
  TriangleMesh make_surface() const;

  Vector<Vec3> directions;                   // unit
  Vector<Vec3> points;                       // support along them
  Vector<double> heights;                    // points . directions
  Vector<Vector<std::uint32_t>> neighbours;  // of each direction
  Vector<double> squared_reach;              // squared distance of its farthest neighbour

 private:
  void find_box();
  void check(const Vec3& inside) const;

  SupportFunction function_;
  TriangleMesh sphere_;
  Vec3 low_ = Vec3::Zero(), high_ = Vec3::Zero();
};

}  // namespace crumble
