// What the extractor works out once from the mesh: faces, the slots of all vertices that can ever exist, and how the
// skin is shaded.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "crumble/fracture/surface.hpp"
#include "surface_patterns.hpp"

namespace crumble {

struct SurfaceTopology {
  explicit SurfaceTopology(const TetMesh& mesh);

  /// A tetrahedron with its corners in ascending node order, as the patterns want it.
  struct Cell {
    Tetrahedron nodes;
    std::array<std::uint32_t, 6> springs;                                 // in kTetEdges order of these corners
    std::array<std::uint32_t, surface_patterns::kSiteCount> first_slots;  // of each site's copies
    bool flipped;                                                         // the sorting turned it inside out
  };
  struct OuterFace {
    std::uint32_t tetrahedron;
    std::uint8_t face;
    /// Normal slots of the face's own corners, springs and centre, by site like Cell::first_slots.
    std::array<std::uint32_t, surface_patterns::kSiteCount> first_normal_slots;
  };

  std::vector<Cell> cells;             // per tetrahedron
  std::vector<OuterFace> outer_faces;  // by tetrahedron
  std::size_t slot_count = 0;
  std::size_t normal_slot_count = 0;
  std::size_t face_count = 0;
  std::size_t outer_node_count = 0;

 private:
  void find_faces(const TetMesh& mesh);
  void share_normals(const TetMesh& mesh);
};

}  // namespace crumble
