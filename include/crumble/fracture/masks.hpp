// The 64 ways to cut the six springs of a tetrahedron.
//
// A cut mask has one bit per spring in the order of kTetEdges (01 02 03 12 13 23); 1 means cut. What is left is a graph
// on four corners: its connected components are the pieces. Face f is the one opposite corner f.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "crumble/tetmesh/tet_mesh.hpp"

namespace crumble {

inline constexpr std::size_t kCutMaskCount = 64;
/// Masks that a relabelling of the corners turns into each other form a class; each is named by its least mask.
inline constexpr std::array<std::uint8_t, 11> kCutClasses{0, 1, 3, 7, 11, 12, 13, 15, 30, 31, 63};

struct CutMask {
  std::array<std::uint8_t, 4> piece{};  // per corner: the least corner of its piece
  std::uint8_t piece_count = 0;         // 1 to 4
  std::uint8_t least_mask = 0;          // the class: least mask under all 24 relabellings, one of kCutClasses
  /// Per face and corner: the least corner of the component that the corner belongs to when only the face's own three
  /// springs count, so both tetrahedra of a face see the same. The corner opposite the face names itself.
  std::array<std::array<std::uint8_t, 4>, 4> face_component{};
  /// Exactly two opposite springs are cut: the two cracks meet in the tetrahedron's centre without sharing an edge, so
  /// a 2-manifold surface needs two copies of the centre though the tetrahedron is one piece.
  bool crossed_cracks = false;
};

/// By cut mask; initialised at compile time.
extern const std::array<CutMask, kCutMaskCount> kCutMasks;

/// Mask of one tetrahedron from its spring ids (TetMesh::tet_springs) and the intact flags (spring_count; 1 or 0).
inline std::uint8_t cut_mask(const std::array<std::uint32_t, 6>& springs,
                             std::span<const std::uint8_t> intact) noexcept {
  unsigned mask = 0;
  for (std::size_t s = 0; s < springs.size(); ++s) mask |= (intact[springs[s]] == 0 ? 1u : 0u) << s;
  return static_cast<std::uint8_t>(mask);
}

}  // namespace crumble
