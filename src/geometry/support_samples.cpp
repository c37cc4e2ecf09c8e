#include "geometry/support_samples.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/text.hpp"
#include "crumble/geometry/mesh_solid.hpp"
#include "geometry/direction_sphere.hpp"

namespace crumble {
namespace {

constexpr int kLevels = 3;  // 642 directions, 5 degrees apart: the faces of a prism with 16 sides are told apart

std::string axis_name(int axis, double sign) {
  return std::string(sign < 0 ? "-" : "+") + "xyz"[axis];
}

}  // namespace

// First the box, which tells in which directions the set is thin, then all round.
SupportSamples::SupportSamples(const SupportFunction& function, const Vec3& inside)
    : function_(function), sphere_(make_direction_sphere(kLevels)) {
  find_box();
  neighbours = neighbours_of(sphere_);
  for (const Vec3& v : sphere_.vertices) {  // the normals of an ellipsoid with this box
    directions.push_back(normalized(v.cwiseQuotient(high_ - low_)));
    points.push_back(support(directions.back()));
    heights.push_back(dot(points.back(), directions.back()));
  }
  for (std::size_t i = 0; i < directions.size(); ++i) {
    squared_reach.push_back(0);
    for (const std::uint32_t k : neighbours[i]) {
      squared_reach[i] = std::max(squared_reach[i], squared_norm(directions[k] - directions[i]));
    }
  }
  check(inside);
}

double SupportSamples::greatest_above(const Vec3& p, std::uint32_t& sample) const noexcept {
  double greatest = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const double above = dot(p, directions[i]) - heights[i];
    if (above > greatest) greatest = above, sample = static_cast<std::uint32_t>(i);
  }
  return greatest;
}

double SupportSamples::way_along(const Vec3& p, const Vec3& direction, double grown) const noexcept {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const double along = dot(directions[i], direction);
    if (along > 0) least = std::min(least, (heights[i] + grown - dot(p, directions[i])) / along);
  }
  return least;
}

void SupportSamples::find_box() {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      const Vec3 point = support(sign * Vec3::Unit(axis));
      const std::string where = "tool.support along " + axis_name(axis, sign) + " gives ";
      if (!is_finite(point)) throw Error(Code::invalid_value, where + "a point that is not finite");
      if (std::abs(point[axis]) > kMaxSolidCoordinate) {
        throw Error(Code::out_of_range,
                    where + to_text(point[axis]) + " m, at most " + to_text(kMaxSolidCoordinate) + " is allowed");
      }
      (sign < 0 ? low_ : high_)[axis] = point[axis];
    }
    const double width = high_[axis] - low_[axis];
    if (width < 0) {
      throw Error(Code::invalid_value, "tool.support is of no convex set: its width along " + axis_name(axis, 1) +
                                           " is " + to_text(width) + " m");
    }
    if (width < 1e-6) {
      throw Error(Code::out_of_range, "tool.support gives a set " + to_text(width) + " m wide along " +
                                          axis_name(axis, 1) + ", at least 1e-6 is needed");
    }
  }
}

Vector<Vec3> SupportSamples::box_corners() const {
  Vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) {
    corners.push_back({i & 1 ? high_.x() : low_.x(), i & 2 ? high_.y() : low_.y(), i & 4 ? high_.z() : low_.z()});
  }
  return corners;
}

void SupportSamples::check(const Vec3& inside) const {
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const std::string where = " along (" + to_text(directions[i].x()) + ", " + to_text(directions[i].y()) + ", " +
                              to_text(directions[i].z()) + ")";
    if (!is_finite(points[i]))
      throw Error(Code::invalid_value, "tool.support" + where + " gives a point that is not finite");
    for (const Vec3& other : points) {
      const double above = dot(other, directions[i]) - heights[i];
      if (above <= 1e-9 * size()) continue;
      throw Error(Code::invalid_value, "tool.support is of no convex set:" + where + " another of its points lies " +
                                           to_text(above) + " m farther");
    }
    const double depth = heights[i] - dot(inside, directions[i]);
    if (depth > 1e-9 * size()) continue;
    throw Error(Code::out_of_range, "tool.inside lies " + to_text(-depth) + " m outside the set" + where);
  }
}

TriangleMesh SupportSamples::make_surface() const {
  TriangleMesh surface;
  Vector<std::uint32_t> number;
  for (const Vec3& point : points) {
    const auto known = std::find_if(surface.vertices.begin(), surface.vertices.end(),
                                    [&](const Vec3& v) { return norm(v - point) <= 1e-12 * size(); });
    number.push_back(static_cast<std::uint32_t>(known - surface.vertices.begin()));
    if (known == surface.vertices.end()) surface.vertices.push_back(point);
  }
  for (const auto& [a, b, c] : sphere_.triangles) {
    const Triangle t{number[a], number[b], number[c]};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) surface.triangles.push_back(t);
  }
  return surface;
}

}  // namespace crumble
