// The paper's own drawing of a cut tetrahedron (§2.5, Fig 6), in the form of the crack patterns.
//
// The paper ends a cut spring at half its rest length from either node and draws each tetrahedron by one of ten
// patterns, which it shows without a rule. This is our reading: a tetrahedron falls into one convex solid for every
// maximal clique of the graph of its intact springs, that is for every set of corners that are all still connected with
// each other while no further corner is connected with all of them. The solid is the hull of these corners and of the
// cut ends that start at them:
//
//   least mask  cut           solids                                        share of the volume
//        0      none          the tetrahedron                               1
//        1      01            two tetrahedra hinged at edge 23              1/2 1/2
//        3      01 02         a tetrahedron and a four-sided pyramid        1/4 3/4
//        7      01 02 03      a corner and a frustum                        1/8 7/8
//       11      01 02 12      three tetrahedra hinged at corner 3           1/4 1/4 1/4           loses 1/4
//       12      03 12         a ring of four tetrahedra                     1/4 1/4 1/4 1/4
//       13      01 03 12      pyramid, tetrahedron, pyramid in a chain      3/8 1/4 3/8
//       15      01 02 03 12   a corner and two hinged pyramids              1/8 3/8 3/8           loses 1/8
//       30      02 03 12 13   two prisms                                    1/2 1/2
//       31      all but 23    two corners and a prism                       1/8 1/8 1/2           loses 1/4
//       63      all           four corners; the octahedron inside is gone   1/8 1/8 1/8 1/8       loses 1/2
//
// Ten classes cut, as many as the paper's patterns. Material is lost wherever all three springs of a face are cut: the
// triangle between their middles belongs to nobody, nor does what lies behind it. So the drawing of a torn body is
// lighter than the body, and one looks through an outer face where that triangle was.
//
// A solid's facets inside the tetrahedron are `interior`; those in a face are its `skin`, drawn where the face is on
// the boundary. Elsewhere both tetrahedra of the face have the same and leave it out: a facet in a face belongs to a
// maximal clique of the face's own three springs. For let K be a solid's clique and k its corners in the face.
//
// 1. The solid meets the face in the hull of k and of the cut ends in the face that start at k: the tetrahedron lies on
// one side of the face, so of a hull only the points in the face reach it.
//
// 2. If some corner x of the face could join k, that hull has no area. For K, without x, then holds the fourth corner,
// and k is at most two corners, connected with x and with each other: two without a cut end, or one with at most one.
//
// 3. If k is maximal in the face, K is k, together with the fourth corner if that is connected with all of k, and
// nothing else. So each maximal k has its area from exactly one solid.
#pragma once

#include <array>

#include "surface_patterns.hpp"

namespace crumble::surface_patterns {

/// By cut mask, the bits in the order of the ascending corners. Unlike those of the cracks, interior triangles stand on
/// corners too, so every node may become a vertex. `owner` is the least corner of the clique.
extern const std::array<MaskPatterns, kCutMaskCount> kPaperPatterns;

}  // namespace crumble::surface_patterns
