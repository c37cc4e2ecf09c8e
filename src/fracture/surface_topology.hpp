// What the extractor works out once from the mesh: faces, the slots of all vertices that can ever exist, who uses what,
// and how the skin is shaded.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "crumble/base/memory.hpp"
#include "crumble/tetmesh/tet_mesh.hpp"
#include "surface_patterns.hpp"

namespace crumble {

/// For each item of one kind (node, spring), its tetrahedra, ascending.
struct TetrahedronLists {
  std::span<const std::uint32_t> operator[](std::size_t item) const noexcept {
    return std::span(tetrahedra).subspan(first[item], first[item + 1] - first[item]);
  }
  Vector<std::uint32_t> first;  // item count + 1
  Vector<std::uint32_t> tetrahedra;
};

struct SurfaceTopology {
  static constexpr std::uint32_t kNone = 0xffffffffu;

  /// Skin edges sharper than `crease` radians at rest are shaded sharp.
  SurfaceTopology(const TetMesh& mesh, double crease);

  /// A tetrahedron with its corners in ascending node order, as the patterns want it.
  struct Cell {
    Tetrahedron nodes;
    std::array<std::uint32_t, 6> springs;                                 // in kTetEdges order of these corners
    std::array<std::uint32_t, surface_patterns::kSiteCount> first_slots;  // of each site's copies
    std::array<std::uint32_t, 4> outer_faces;                             // opposite each corner, or kNone
    bool flipped;                                                         // the sorting turned it inside out
  };
  struct OuterFace {
    std::uint32_t tetrahedron;
    std::uint8_t face;
    /// Of each corner of the cell: its place in the triangle of TetMesh::boundary.
    std::array<std::uint8_t, 4> boundary_corners;
    /// Normal slots of the face's own corners, springs and centre, by site like Cell::first_slots.
    std::array<std::uint32_t, surface_patterns::kSiteCount> first_normal_slots;
  };

  /// Tetrahedra whose triangles may use the vertex in `slot`.
  std::span<const std::uint32_t> users(std::uint32_t slot) const noexcept;

  Vector<Cell> cells;             // per tetrahedron
  Vector<OuterFace> outer_faces;  // per triangle of TetMesh::boundary
  TetrahedronLists node_tetrahedra, spring_tetrahedra;
  std::size_t slot_count = 0;
  std::size_t normal_slot_count = 0;
  std::size_t face_count = 0;
  std::size_t outer_node_count = 0;

 private:
  void find_faces(const TetMesh& mesh);
  void number_slots(const TetMesh& mesh);
  void share_normals(const TetMesh& mesh, double crease);

  Vector<std::array<std::uint32_t, 2>> face_tetrahedra_;  // the same twice for an outer face
  Vector<std::uint32_t> own_tetrahedron_;                 // 0, 1, 2, ...
  std::uint32_t first_middle_slot_ = 0, first_face_slot_ = 0, first_center_slot_ = 0;
};

}  // namespace crumble
