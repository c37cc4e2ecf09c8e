#include <algorithm>
#include <cmath>

#include "crumble/base/memory.hpp"
#include "crumble/geometry/tool_solids.hpp"
#include "geometry/round_solids.hpp"

namespace crumble {
namespace {

class CapsuleModel final : public SolidModel {
 public:
  CapsuleModel(double radius, double length) : radius_(radius), half_length_(length / 2) {
    set_corners({{0, 0, -half_length_}, {0, 0, half_length_}});
    rounding_ = half_thickness_ = radius;
    surface_ = revolve(profile());
  }

  bool find_inside(const Vec3& p, std::uint32_t&, SolidPoint& nearest) const noexcept override {
    const Vec3 from_axis = p - axis_point(p);
    if (!(squared_norm(from_axis) < radius_ * radius_)) return false;  // nor what is not a number
    nearest = under(p, from_axis);
    return nearest.signed_distance < 0;
  }

  SolidPoint nearest(const Vec3& p, double) const noexcept override { return under(p, p - axis_point(p)); }

  // Through the side unless it gets there beyond the cylinder's ends; then through the half ball of that end.
  bool leave_along(const Vec3& p, const Vec3& direction, SolidPoint& out) const noexcept override {
    const Vec3 across(direction.x(), direction.y(), 0), from_axis(p.x(), p.y(), 0);
    double way = way_out(from_axis, across);
    const double z = p.z() + way * direction.z();
    if (!(std::abs(z) <= half_length_)) {
      const double end = z < 0 ? -half_length_ : half_length_;
      way = way_out(p - Vec3(0, 0, end), direction);
    }
    if (!std::isfinite(way)) return false;
    const Vec3 leaves = p + way * direction;
    out = {leaves, normalized(leaves - axis_point(leaves)), -way};
    return true;
  }

  void write(ByteWriter& out) const override {
    out.put(static_cast<std::uint8_t>(SolidKind::capsule));
    out.put(radius_), out.put(2 * half_length_);
  }

 private:
  Vec3 axis_point(const Vec3& p) const noexcept { return {0, 0, std::clamp(p.z(), -half_length_, half_length_)}; }

  // On the axis every direction across it is as near; it is +X.
  SolidPoint under(const Vec3& p, const Vec3& from_axis) const noexcept {
    const double distance = norm(from_axis);
    const Vec3 normal = distance > 0 ? Vec3(from_axis / distance) : Vec3::UnitX();
    return {(p - from_axis) + radius_ * normal, normal, distance - radius_};
  }

  // The greatest t with |from + t along| = radius: infinite for along = 0. The two forms of the root lose no digits.
  double way_out(const Vec3& from, const Vec3& along) const noexcept {
    const double a = squared_norm(along), b = dot(from, along), c = squared_norm(from) - radius_ * radius_;
    const double root = std::sqrt(std::max(b * b - a * c, 0.0));
    if (a == 0) return std::numeric_limits<double>::infinity();
    return b > 0 ? -c / (b + root) : (root - b) / a;
  }

  Vector<ProfilePoint> profile() const {
    constexpr int kRings = 8;  // in each half ball
    Vector<ProfilePoint> points{{0, -half_length_ - radius_}};
    for (int i = 1; i <= 2 * kRings; ++i) {
      const double angle = kPi / 2 * (i - kRings) / kRings;
      const double radius = radius_ * cos_exact(angle), z = radius_ * sin_exact(angle);
      if (i <= kRings) points.push_back({radius, z - half_length_});
      if (i >= kRings && i < 2 * kRings && (half_length_ > 0 || i > kRings))
        points.push_back({radius, z + half_length_});
    }
    points.push_back({0, half_length_ + radius_});
    return points;
  }

  double radius_, half_length_;
};

}  // namespace

Solid make_ball(double radius) {
  return make_capsule(radius, 0);
}

Solid make_capsule(double radius, double length) {
  require_size("radius", radius);
  require_finite("length", length);
  require_in_range("length", length, 0, 1000);
  return std::shared_ptr<const SolidModel>(share_new<CapsuleModel>(radius, length));
}

}  // namespace crumble
