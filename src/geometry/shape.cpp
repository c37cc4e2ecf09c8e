#include "crumble/geometry/shape.hpp"

#include <algorithm>
#include <cmath>

#include "crumble/base/error.hpp"
#include "crumble/base/transcendental.hpp"

namespace crumble {
namespace {

class Box final : public Shape {
 public:
  explicit Box(const Vec3& size) : half_(0.5 * size), center_(0, 0.5 * size.y(), 0) {
    // corner i has sign bits x, y, z; a crease joins the corners that differ in one bit
    for (std::uint32_t i = 0; i < 8; ++i) {
      corners_.push_back(center_ + Vec3(i & 1 ? half_.x() : -half_.x(), i & 2 ? half_.y() : -half_.y(),
                                        i & 4 ? half_.z() : -half_.z()));
    }
    for (std::uint32_t i = 0; i < 8; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        if (i & (1u << axis)) continue;
        Crease crease;
        crease.length = size[axis];
        crease.first_corner = i;
        crease.last_corner = i | (1u << axis);
        crease.start = corners_[i];
        crease.direction[axis] = 1;
        creases_.push_back(crease);
      }
    }
  }
  double signed_distance(const Vec3& p) const override {
    const Vec3 q = (p - center_).cwiseAbs() - half_;
    const double inside = std::min(std::max({q.x(), q.y(), q.z()}), 0.0);
    return norm(q.cwiseMax(0.0)) + inside;
  }
  SurfacePoint project(const Vec3& p) const override {
    const Vec3 local = p - center_;
    Vec3 on = local.cwiseMax(-half_).cwiseMin(half_);
    Vec3 normal = Vec3::Zero();
    const Vec3 excess = local.cwiseAbs() - half_;
    int axis = 0;  // the face that is nearest from inside, or most exceeded from outside
    for (int k = 1; k < 3; ++k) axis = excess[k] > excess[axis] ? k : axis;
    const double sign = local[axis] < 0 ? -1 : 1;
    on[axis] = sign * half_[axis];
    normal[axis] = sign;
    // exact bounds, so that "on the face" can be asked with ==
    Vec3 point = center_ + on;
    for (int k = 0; k < 3; ++k) {
      if (on[k] == half_[k]) point[k] = upper()[k];
      if (on[k] == -half_[k]) point[k] = lower()[k];
    }
    return {point, normal};
  }
  Vec3 lower() const override { return center_ - half_; }
  Vec3 upper() const override { return center_ + half_; }
  double volume() const override { return 8 * half_.x() * half_.y() * half_.z(); }
  double area() const override { return 8 * (half_.x() * half_.y() + half_.y() * half_.z() + half_.z() * half_.x()); }
  double least_thickness() const override { return 2 * std::min({half_.x(), half_.y(), half_.z()}); }

 private:
  Vec3 half_, center_;
};

class Sphere final : public Shape {
 public:
  explicit Sphere(double radius) : radius_(radius), center_(0, radius, 0) {}
  double signed_distance(const Vec3& p) const override { return norm(p - center_) - radius_; }
  SurfacePoint project(const Vec3& p) const override {
    const Vec3 from = p - center_;
    const double distance = norm(from);
    const Vec3 normal = distance > 0 ? Vec3(from / distance) : Vec3::UnitY();
    return {center_ + radius_ * normal, normal};
  }
  Vec3 lower() const override { return center_ - Vec3::Constant(radius_); }
  Vec3 upper() const override { return center_ + Vec3::Constant(radius_); }
  double volume() const override { return 4.0 / 3 * kPi * radius_ * radius_ * radius_; }
  double area() const override { return 4 * kPi * radius_ * radius_; }
  double least_thickness() const override { return 2 * radius_; }

 private:
  double radius_;
  Vec3 center_;
};

class Cylinder final : public Shape {
 public:
  Cylinder(double radius, double height) : radius_(radius), height_(height) {
    for (const double y : {0.0, height}) {
      Crease rim;
      rim.length = 2 * kPi * radius;
      rim.closed = true;
      rim.center = Vec3(0, y, 0);
      rim.radius = radius;
      creases_.push_back(rim);
    }
  }
  double signed_distance(const Vec3& p) const override {
    const double side = std::sqrt(p.x() * p.x() + p.z() * p.z()) - radius_;
    const double cap = std::abs(p.y() - height_ / 2) - height_ / 2;
    const double out_side = std::max(side, 0.0), out_cap = std::max(cap, 0.0);
    return std::sqrt(out_side * out_side + out_cap * out_cap) + std::min(std::max(side, cap), 0.0);
  }
  SurfacePoint project(const Vec3& p) const override {
    const double rho = std::sqrt(p.x() * p.x() + p.z() * p.z());
    const Vec3 outward = rho > 0 ? Vec3(p.x() / rho, 0, p.z() / rho) : Vec3::UnitX();
    const double side = rho - radius_, cap = std::abs(p.y() - height_ / 2) - height_ / 2;
    const bool top = p.y() > height_ / 2;
    if (cap > side) {  // nearer to a cap, from inside or outside
      const double r = std::min(rho, radius_);
      return {Vec3(r * outward.x(), top ? height_ : 0, r * outward.z()), Vec3(0, top ? 1 : -1, 0)};
    }
    return {Vec3(radius_ * outward.x(), std::clamp(p.y(), 0.0, height_), radius_ * outward.z()), outward};
  }
  Vec3 lower() const override { return {-radius_, 0, -radius_}; }
  Vec3 upper() const override { return {radius_, height_, radius_}; }
  double volume() const override { return kPi * radius_ * radius_ * height_; }
  double area() const override { return 2 * kPi * radius_ * (radius_ + height_); }
  double least_thickness() const override { return std::min(2 * radius_, height_); }

 private:
  double radius_, height_;
};

}  // namespace

Vec3 Crease::at(double s) const {
  if (!closed) return start + s * direction;
  const double angle = s / radius;
  return center + Vec3(radius * cos_exact(angle), 0, radius * sin_exact(angle));
}

std::unique_ptr<Shape> make_box(const Vec3& size) {
  require_positive("size.x", size.x());
  require_positive("size.y", size.y());
  require_positive("size.z", size.z());
  return std::make_unique<Box>(size);
}

std::unique_ptr<Shape> make_sphere(double radius) {
  require_positive("radius", radius);
  return std::make_unique<Sphere>(radius);
}

std::unique_ptr<Shape> make_cylinder(double radius, double height) {
  require_positive("radius", radius);
  require_positive("height", height);
  return std::make_unique<Cylinder>(radius, height);
}

}  // namespace crumble
