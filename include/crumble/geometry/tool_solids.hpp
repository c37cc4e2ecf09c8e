// Tools beside the sticks: ball, capsule, cone and blade. A plate is a flat bar (make_bar in convex.hpp).
//
// Ball, capsule and cone are curved and exact: nearest points, depths and ways out are closed forms of + - * / and
// sqrt, the same bits in every build. Their surface(), for drawing only, has 32 sides.
//
// A tool is moved in steps of its half thickness, here the radius of a ball inside it, or of the part of its point or
// edge that is as deep as nodes are apart (SolidModel::edge_sine), if that is thinner. What meets the middle of that
// ball's path is always found; a point, an edge or a rim may step over a node that it would have grazed.
#pragma once

#include "crumble/geometry/solid.hpp"

namespace crumble {

/// About the origin. Throws Error naming the field and value, as all below: invalid_value, out_of_range. Lengths are
/// metres, above 0 and up to 1000.
Solid make_ball(double radius);

/// Everything within `radius` of the segment of `length` along Z about the origin: a cylinder with half balls for ends,
/// length + 2 radius long in all. Length 0 is a ball.
Solid make_capsule(double radius, double length);

/// Axis Z; the point at z = -height / 2, the flat end of `radius` at z = +height / 2.
Solid make_cone(double radius, double height);

/// A knife about the origin with its edge looking down: `size` is thickness (X), height (Y) and length (Z); both sides
/// run straight from the full thickness to the edge at y = -size.y / 2 over the lowest `bevel` metres, (0, size.y]. A
/// bevel of the whole height is a plain wedge.
ConvexPolyhedron make_blade(const Vec3& size, double bevel);

}  // namespace crumble
