// Shapes of bodies: a signed distance, and the corners and creases that a mesh has to keep.
#pragma once

#include <cstdint>
#include <memory>

#include "crumble/base/memory.hpp"
#include "crumble/base/vec.hpp"

namespace crumble {

struct SurfacePoint {
  Vec3 point;
  Vec3 normal;  // unit, outward
};

/// A sharp curve of the surface, by arc length.
struct Crease {
  double length = 0;               // metres
  bool closed = false;             // a closed crease has no end corners
  std::uint32_t first_corner = 0;  // indices into Shape::corners(); unused when closed
  std::uint32_t last_corner = 0;
  Vec3 start = Vec3::Zero();      // straight: start + s * direction
  Vec3 direction = Vec3::Zero();  // unit; zero for a circle
  Vec3 center = Vec3::Zero();     // circle about +Y: center + radius (cos(s/radius), 0, sin(s/radius))
  double radius = 0;
  /// The point at arc length s.
  Vec3 at(double s) const;
};

/// A solid body shape. Immutable; all lengths in metres.
class Shape : public Allocated {
 public:
  virtual ~Shape() = default;
  /// < 0 inside, exact distance.
  virtual double signed_distance(const Vec3& p) const = 0;
  /// Nearest point of the surface.
  virtual SurfacePoint project(const Vec3& p) const = 0;
  virtual Vec3 lower() const = 0;  // bounding box
  virtual Vec3 upper() const = 0;
  virtual double volume() const = 0;
  virtual double area() const = 0;
  virtual double least_thickness() const = 0;
  const Vector<Vec3>& corners() const { return corners_; }
  const Vector<Crease>& creases() const { return creases_; }

 protected:
  Vector<Vec3> corners_;
  Vector<Crease> creases_;
};

/// Box with the given edge lengths, resting on y = 0, centred in x and z. Throws Error on a size that is not positive.
std::unique_ptr<Shape> make_box(const Vec3& size);
/// Sphere resting on y = 0, centred in x and z.
std::unique_ptr<Shape> make_sphere(double radius);
/// Upright cylinder (axis +Y) resting on y = 0, centred in x and z.
std::unique_ptr<Shape> make_cylinder(double radius, double height);

}  // namespace crumble
