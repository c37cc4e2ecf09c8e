// Changes of connectivity that raise the worst quality among the tetrahedra they touch.
#pragma once

#include <limits>

#include "bubblemesh/cloud.hpp"
#include "bubblemesh/tet_complex.hpp"

namespace crumble {

/// Quality of a tetrahedron, see measures.hpp.
using Measure = double (*)(const Vec3&, const Vec3&, const Vec3&, const Vec3&);

inline double quality_of(const Cloud& cloud, Measure measure, const Tetrahedron& t) {
  return measure(cloud.positions[t[0]], cloud.positions[t[1]], cloud.positions[t[2]], cloud.positions[t[3]]);
}

/// A flip is made when the worst quality afterwards is above the worst before, or above `enough` if that is less.
inline constexpr double kOnlyBetter = std::numeric_limits<double>::infinity();

/// Replaces the tetrahedra around the edge a-b by the best ones without it. At the boundary this turns an edge of a
/// smooth piece of the surface, or takes off a flat tetrahedron lying on it; creases stay. False when it is not made.
bool remove_edge(const Cloud& cloud, Measure measure, std::uint32_t a, std::uint32_t b, TetComplex& tets,
                 double enough = kOnlyBetter);

/// Replaces the two tetrahedra at a face by three around a new edge. False when it is not made.
bool flip_face(const Cloud& cloud, Measure measure, TetId tet, int face, TetComplex& tets, double enough = kOnlyBetter);

}  // namespace crumble
