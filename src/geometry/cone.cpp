// A cone in the half plane of distance r from the axis and z: a triangle of the point (0, -height/2), the rim
// (radius, height/2) and the middle of the flat end. Its angles at point and rim are acute, so under each of the two
// faces the nearest point of an inside point lies on the face, and depth is the lesser of two plane distances.
#include <algorithm>
#include <cmath>

#include "crumble/base/memory.hpp"
#include "crumble/geometry/tool_solids.hpp"
#include "geometry/round_solids.hpp"

namespace crumble {
namespace {

// Nearer than this to point or rim, the direction from there is rounding.
constexpr double kNoDirection = 1e-12;  // m

class ConeModel final : public SolidModel {
 public:
  ConeModel(double radius, double height)
      : radius_(radius), height_(height), slant_(std::sqrt(radius * radius + height * height)) {
    surface_ = revolve({{0, -height / 2}, {radius, height / 2}, {0, height / 2}});
    set_corners(round_box());
    half_thickness_ = radius * height / (radius + slant_);  // of the ball that touches both faces
    edge_sine_ = std::min(radius / slant_, std::sqrt(0.5 - 0.5 * radius / slant_));  // of the point, of the rim
  }

  bool find_inside(const Vec3& p, std::uint32_t&, SolidPoint& nearest) const noexcept override {
    if (!(p.z() < height_ / 2)) return false;
    const double r = from_axis(p);
    const double side = above_side(r, p.z()), end = above_end(p.z());
    if (!(std::max(side, end) < 0)) return false;  // nor what is not a number
    nearest = under_face(p, r, side, end);
    return true;
  }

  SolidPoint nearest(const Vec3& p, double) const noexcept override {
    const double r = from_axis(p);
    const double side = above_side(r, p.z()), end = above_end(p.z());
    if (side < 0 && end < 0) return under_face(p, r, side, end);
    const ProfilePoint on_side = nearest_of_side(r, p.z()), on_end{std::min(r, radius_), height_ / 2};
    const double to_side = distance(on_side, r, p.z()), to_end = distance(on_end, r, p.z());
    const bool is_end = to_end < to_side || (to_end == to_side && end > side);
    const ProfilePoint at = is_end ? on_end : on_side;
    const double away = is_end ? to_end : to_side;
    const Vec3 outward = away_from_axis(p, r);
    const Vec3 point = at.radius * outward + Vec3(0, 0, at.z);
    const bool at_corner = at.z == -height_ / 2 || at.radius == radius_;
    if (at_corner && away > kNoDirection) return {point, normalized(p - point), away};
    return {point, end > side ? Vec3::UnitZ() : side_normal(outward), away};
  }

  bool leave_along(const Vec3& p, const Vec3& direction, SolidPoint& out) const noexcept override {
    const double to_end = direction.z() > 0 ? (height_ / 2 - p.z()) / direction.z() : kNever;
    const double to_side = way_through_side(p, direction);
    const double way = std::min(to_end, to_side);
    if (!std::isfinite(way)) return false;
    const Vec3 leaves = p + way * direction;
    const Vec3 normal = to_end < to_side ? Vec3::UnitZ() : side_normal(away_from_axis(leaves, from_axis(leaves)));
    out = {leaves, normal, -way};
    return true;
  }

  void write(ByteWriter& out) const override {
    out.put(static_cast<std::uint8_t>(SolidKind::cone));
    out.put(radius_), out.put(height_);
  }

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  static double from_axis(const Vec3& p) noexcept { return std::sqrt(p.x() * p.x() + p.y() * p.y()); }
  static double distance(const ProfilePoint& at, double r, double z) noexcept {
    return std::sqrt((r - at.radius) * (r - at.radius) + (z - at.z) * (z - at.z));
  }
  double above_side(double r, double z) const noexcept { return (r * height_ - (z + height_ / 2) * radius_) / slant_; }
  double above_end(double z) const noexcept { return z - height_ / 2; }
  Vec3 side_normal(const Vec3& outward) const noexcept {
    return (height_ / slant_) * outward - Vec3(0, 0, radius_ / slant_);
  }

  SolidPoint under_face(const Vec3& p, double r, double side, double end) const noexcept {
    const Vec3 normal = end > side ? Vec3::UnitZ() : side_normal(away_from_axis(p, r));
    const double depth = std::max(side, end);
    return {p - depth * normal, normal, depth};
  }

  ProfilePoint nearest_of_side(double r, double z) const noexcept {
    const double along = (r * radius_ + (z + height_ / 2) * height_) / (slant_ * slant_);
    if (along <= 0) return {0, -height_ / 2};
    if (along >= 1) return {radius_, height_ / 2};
    return {along * radius_, along * height_ - height_ / 2};
  }

  // With f(t) = height^2 r^2 - radius^2 (z + height/2)^2 along the way: f < 0 at the start, 0 on the side and on the
  // cone's mirror image below the point, which no way from inside meets first. Discriminant and roots stand in forms
  // that lose no digits, also through the point, where both roots are one.
  double way_through_side(const Vec3& p, const Vec3& d) const noexcept {
    const double up = p.z() + height_ / 2, hh = height_ * height_, rr = radius_ * radius_;
    const double a = hh * (d.x() * d.x() + d.y() * d.y()) - rr * (d.z() * d.z());
    const double b = hh * (p.x() * d.x() + p.y() * d.y()) - rr * (up * d.z());
    const double c = hh * (p.x() * p.x() + p.y() * p.y()) - rr * (up * up);
    const double x = up * d.x() - p.x() * d.z(), y = up * d.y() - p.y() * d.z(), turn = p.x() * d.y() - p.y() * d.x();
    const double root = std::sqrt(std::max(hh * (rr * (x * x + y * y) - hh * (turn * turn)), 0.0));  // of b^2 - a c
    if (b > 0) return -c / (b + root);
    return a > 0 ? (root - b) / a : kNever;  // steeper than the side, and upward
  }

  // The point and a square around the rim.
  Vector<Vec3> round_box() const {
    const double r = radius_, top = height_ / 2;
    return {{0, 0, -top}, {-r, -r, top}, {r, -r, top}, {r, r, top}, {-r, r, top}};
  }

  double radius_, height_, slant_;
};

}  // namespace

Solid make_cone(double radius, double height) {
  require_size("radius", radius);
  require_size("height", height);
  return std::shared_ptr<const SolidModel>(share_new<ConeModel>(radius, height));
}

}  // namespace crumble
