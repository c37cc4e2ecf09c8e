#include "bubblemesh/lattice_body.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace crumble {
namespace {

constexpr double kCreaseReach = 0.5;  // in units of d; the nearest node is within 0.42 d, the next beyond 0.6 d
constexpr double kMargin = 1.5;       // of sites around the bounding box, in steps
constexpr double kFlat = 1e-9;        // relative to the extent

std::int32_t rounded_down(double x) {
  return static_cast<std::int32_t>(std::floor(x));
}

}  // namespace

LatticeBody::LatticeBody(const Shape& shape, double spacing, const Vec3& offset)
    : shape_(shape), spacing_(spacing), middle_(0.5 * (shape.lower() + shape.upper())), upright_(is_flat(1)) {
  const Vec3 lower = shape.lower(), size = shape.upper() - lower;
  lattice_.origin = middle_ + spacing * offset;
  lattice_.steps = {spacing, spacing / std::sqrt(2.0), spacing};
  std::array<std::int32_t, 3> first{}, last{};
  for (int axis = 0; axis < 3; ++axis) {
    double& step = lattice_.steps[axis];
    if (axis != 1 && is_flat(axis)) {
      step = 2 * size[axis] / std::max(3.0, std::floor(2 * size[axis] / spacing + 0.5));
      lattice_.origin[axis] = lower[axis] - 0.25 * step;
    }
    if (axis == 1 && upright_) {
      last[1] = std::max(2, rounded_down(size[1] / step + 0.5));
      step = size[1] / last[1];
      lattice_.origin[1] = lower[1];
      continue;
    }
    first[axis] = rounded_down((lower[axis] - lattice_.origin[axis]) / step - kMargin);
    last[axis] = rounded_down((lower[axis] + size[axis] - lattice_.origin[axis]) / step + kMargin);
  }
  first_ = {first[1], first[2], first[0]};
  last_ = {last[1], last[2], last[0]};
  for (const Crease& crease : shape.creases()) {
    if (upright_ && !crease.closed && crease.direction.x() == 0 && crease.direction.z() == 0)
      upright_creases_.push_back(crease.start);
  }
}

bool LatticeBody::is_flat(int axis) const {
  const Vec3 size = shape_.upper() - shape_.lower();
  for (const Vec3& face : {shape_.lower(), shape_.upper()}) {
    for (const auto& [u, v] : {std::pair(-0.25, -0.25), std::pair(0.25, 0.25), std::pair(0.25, -0.25)}) {
      Vec3 p = middle_;
      p[axis] = face[axis];
      p[(axis + 1) % 3] += u * size[(axis + 1) % 3];
      p[(axis + 2) % 3] += v * size[(axis + 2) % 3];
      if (!(std::abs(shape_.signed_distance(p)) <= kFlat * size[axis])) return false;
    }
  }
  return true;
}

Vec3 LatticeBody::point(const Site& site) const {
  Vec3 p = lattice_.point(site);
  if (upright_ && site.layer == last_.layer) p.y() = shape_.upper().y();
  return p;
}

const Vec3* LatticeBody::upright_crease_at(const Vec3& p) const {
  const double reach = kCreaseReach * spacing_;
  for (const Vec3& crease : upright_creases_) {
    const double x = p.x() - crease.x(), z = p.z() - crease.z();
    if (x * x + z * z < reach * reach) return &crease;
  }
  return nullptr;
}

SidePlace LatticeBody::side_place(const Vec3& p) const {
  SurfacePoint on = shape_.project(at_half_height(p));
  const Vec3* crease = upright_crease_at(p);
  if (crease) on.point = *crease;
  if (upright_) on.point.y() = p.y();
  return {on.point, on.normal, crease != nullptr};
}

}  // namespace crumble
