// The rigid solids that tools are made of, and what contact asks of them, whatever their kind.
#pragma once

#include <cstdint>
#include <memory>

#include "crumble/base/bytes.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/vec_array.hpp"
#include "crumble/geometry/convex.hpp"
#include "crumble/geometry/pose.hpp"

namespace crumble {

/// A point of a solid's surface, in the solid's frame, metres.
struct SolidPoint {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::Zero();  // unit, outward
  double signed_distance = 0;  // from the point that was asked for: negative when that lies inside
};

/// One kind of solid. Immutable; the queries allocate nothing and may be asked by several threads at once.
class SolidModel {
 public:
  virtual ~SolidModel() = default;

  /// Whether p lies inside, not on the surface, and if so where the surface is nearest. `hint` is a number that the
  /// caller keeps for points that follow each other, any at first: it changes the time taken and no result.
  virtual bool find_inside(const Vec3& p, std::uint32_t& hint, SolidPoint& nearest) const noexcept = 0;
  /// Where the surface is nearest to p. A point farther outside than `far` may be answered with any distance greater
  /// than `far`, and then point and normal mean nothing.
  virtual SolidPoint nearest(const Vec3& p, double far) const noexcept = 0;
  /// The paper's way out (section 2.4): from p inside along the unit vector `direction` to where it leaves the solid.
  /// False when it does not.
  virtual bool leave_along(const Vec3& p, const Vec3& direction, SolidPoint& out) const noexcept = 0;

  /// The convex hull of corners(), grown by rounding(), holds the solid. Their number is a multiple of 4.
  VecView corners() const noexcept { return corners_; }
  double rounding() const noexcept { return rounding_; }  // metres
  /// Half the way that the solid may go in one move without passing over a point unseen, metres.
  double half_thickness() const noexcept { return half_thickness_; }
  /// Sine of half the angle of its sharpest point or edge: of each metre that this is sunk in, so much is the radius of
  /// the ball that fits in there. 1 of a solid that is smooth, or of which it is not known.
  double edge_sine() const noexcept { return edge_sine_; }
  /// A closed surface to draw; of curved solids an approximation, with its vertices on the surface.
  const TriangleMesh& surface() const noexcept { return surface_; }

  /// All that read_solid() needs to make the same solid, or as much as tells it from others.
  virtual void write(ByteWriter& out) const = 0;

 protected:
  /// `corners` of any number but 0.
  void set_corners(const Vector<Vec3>& corners);

  VecArray corners_;
  double rounding_ = 0;
  double half_thickness_ = 0;
  double edge_sine_ = 1;
  TriangleMesh surface_;
};

/// A solid of any kind; copies share it. Empty when made from nothing.
class Solid {
 public:
  Solid() = default;
  Solid(ConvexPolyhedron polyhedron);
  Solid(std::shared_ptr<const SolidModel> model) : model_(std::move(model)) {}

  explicit operator bool() const noexcept { return model_ != nullptr; }
  const SolidModel* operator->() const noexcept { return model_.get(); }
  const SolidModel& operator*() const noexcept { return *model_; }

 private:
  std::shared_ptr<const SolidModel> model_;
};

/// Least y of what holds the solid (see corners()) when it stands at `frame`, metres.
double lowest_point(const SolidModel& solid, const Frame& frame);

/// What write() wrote. Throws Error: corrupt, unsupported (a solid that only its maker can make), and what the solid's
/// own maker refuses.
Solid read_solid(ByteReader& in);

/// First number that write() puts down.
enum class SolidKind : std::uint8_t { polyhedron = 0, capsule = 1, cone = 2, mesh = 3, support = 4 };

}  // namespace crumble
