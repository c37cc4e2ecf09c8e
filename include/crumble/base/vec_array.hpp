// Many vectors, one array per component: the layout the solver works in, and how the sibling modules see it.
#pragma once

#include <cstddef>
#include <span>

#include "crumble/base/memory.hpp"
#include "crumble/base/vec.hpp"

namespace crumble {

/// Borrowed, read only; x, y and z have the same length.
struct VecView {
  std::span<const double> x, y, z;
  std::size_t size() const { return x.size(); }
  Vec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
};

/// Borrowed, writable.
struct VecSpan {
  std::span<double> x, y, z;
  std::size_t size() const { return x.size(); }
  Vec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
  void set(std::size_t i, const Vec3& v) const { x[i] = v.x(), y[i] = v.y(), z[i] = v.z(); }
  operator VecView() const { return {x, y, z}; }
};

/// Owning.
struct VecArray {
  Vector<double> x, y, z;

  VecArray() = default;
  explicit VecArray(std::size_t n) : x(n), y(n), z(n) {}
  explicit VecArray(std::span<const Vec3> points) : VecArray(points.size()) {
    for (std::size_t i = 0; i < points.size(); ++i) set(i, points[i]);
  }
  std::size_t size() const { return x.size(); }
  Vec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
  void set(std::size_t i, const Vec3& v) { x[i] = v.x(), y[i] = v.y(), z[i] = v.z(); }
  operator VecView() const { return {x, y, z}; }
  operator VecSpan() { return {x, y, z}; }
};

}  // namespace crumble
