// What one tetrahedron contributes to the surface, for each of the 64 masks.
//
// A vertex of the surface is a copy of one of 15 sites of the tetrahedron: the middles of its six springs, the centres
// of its four faces, its own centre, its four corners. Which copies exist depends on the mask alone:
//   middle of a spring   copy 0 on the first corner's side, 1 on the second's
//   face centre          one copy per component of the face's own three springs
//   own centre           one copy per piece; for crossed cracks one per crack
//   corner               one
// Copies are named after the least corner of their component. The corners have to be in ascending node order, so that
// both tetrahedra of a face find the same name without asking each other; that is the whole trick of the extractor.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "crumble/fracture/masks.hpp"

namespace crumble::surface_patterns {

inline constexpr std::size_t kSiteCount = 15;
inline constexpr std::size_t kMiddles = 0, kFaceCenters = 6, kCenter = 10, kCorners = 11;  // first site of each kind

/// A vertex of a pattern: site * 4 + copy.
using VertexCode = std::uint8_t;
constexpr std::size_t site_of(VertexCode code) {
  return code >> 2u;
}
constexpr std::uint32_t copy_of(VertexCode code) {
  return code & 3u;
}

struct PatternTriangle {
  std::array<VertexCode, 3> vertices;  // counter-clockwise from outside if the ascending corners have positive volume
  std::uint8_t owner;                  // corner whose dual cell it bounds
  /// With vertices a, b, c the facet's normal is that of (c - a) x (fourth - b): of a four-sided facet, its fourth
  /// corner; of a facet that is one triangle, a.
  VertexCode fourth = 0;
};

struct MaskPatterns {
  std::uint8_t interior_count = 0;
  std::array<PatternTriangle, 24> interior{};  // facets as pairs
  std::array<std::uint8_t, 4> skin_count{};    // per face, for the faces that are on the boundary
  std::array<std::array<PatternTriangle, 6>, 4> skin{};
  std::array<std::uint8_t, kSiteCount * 4>
      carriers{};  // per vertex code: the corners (bits) whose cells share the copy
};

/// Corners (bits) of which a site is the mean.
extern const std::array<std::uint8_t, kSiteCount> kSiteCorners;
/// By cut mask, the bits in the order of the ascending corners.
extern const std::array<MaskPatterns, kCutMaskCount> kPatterns;

}  // namespace crumble::surface_patterns
