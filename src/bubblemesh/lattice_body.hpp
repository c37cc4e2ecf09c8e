// How a shape and the square lattice fit each other.
#pragma once

#include "bubblemesh/square_lattice.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/geometry/shape.hpp"

namespace crumble {

/// Where a node on the side of the body belongs.
struct SidePlace {
  Vec3 point;
  Vec3 normal;             // unit, outward
  bool on_crease = false;  // an upright one
};

/// A body that is cut out of the square lattice: either smooth all over (a sphere), or upright with two level faces (a
/// box, a cylinder).
///
/// The lattice is stretched a little to fit flat faces. Level faces become layers. Upright faces that look along an
/// axis stand midway between two families of nodes, which are a half square apart: both are drawn onto the face, by a
/// quarter of a square each, and make nearly equilateral triangles on it. Along axes without flat faces nothing is
/// stretched.
///
/// The side is the surface without the level faces. Of an upright body it is looked at halfway up, where the nearest
/// point of the surface is on the side.
class LatticeBody {
 public:
  LatticeBody(const Shape& shape, double spacing, const Vec3& offset);

  const SquareLattice& lattice() const { return lattice_; }
  /// Least and greatest site that may have a node.
  const Site& first() const { return first_; }
  const Site& last() const { return last_; }
  bool is_upright() const { return upright_; }
  bool is_level_face(std::int32_t layer) const { return upright_ && (layer == first_.layer || layer == last_.layer); }
  bool has_upright_creases() const { return !upright_creases_.empty(); }

  Vec3 point(const Site& site) const;
  /// Negative inside; right near the side.
  double side_distance(const Vec3& p) const { return shape_.signed_distance(at_half_height(p)); }
  SidePlace side_place(const Vec3& p) const;
  /// Whether the node belongs on an upright crease; one of every layer does.
  bool is_at_crease(const Vec3& p) const { return upright_crease_at(p) != nullptr; }

 private:
  bool is_flat(int axis) const;
  Vec3 at_half_height(const Vec3& p) const { return upright_ ? Vec3(p.x(), middle_.y(), p.z()) : p; }
  const Vec3* upright_crease_at(const Vec3& p) const;

  const Shape& shape_;
  double spacing_;
  Vec3 middle_;
  bool upright_;
  Vector<Vec3> upright_creases_;  // a point on each
  SquareLattice lattice_;
  Site first_, last_;
};

}  // namespace crumble
