// What the extractor holds, and how a picture follows the one before (surface_state.cpp).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "crumble/base/memory.hpp"
#include "crumble/fracture/surface.hpp"
#include "node_rotations.hpp"
#include "open_springs.hpp"
#include "surface_normals.hpp"
#include "surface_patterns.hpp"
#include "surface_topology.hpp"
#include "surface_triangles.hpp"
#include "surface_vertices.hpp"

namespace crumble {

class SurfaceExtractor::State : public Allocated {
 public:
  State(const TetMesh& mesh, const SurfaceSettings& settings);

  void update(const SurfaceInput& now) noexcept;
  void rebuild(const SurfaceInput& now) noexcept;
  void spread_over_skin(std::span<const CornerCoordinates> boundary, std::span<CornerCoordinates> skin) const noexcept;

  const TriangleList& triangles() const noexcept { return triangles_; }
  const VertexList& vertices() const noexcept { return vertices_; }
  const SurfaceNormals& normals() const noexcept { return normals_; }
  bool rebuilt() const noexcept { return rebuilt_; }

 private:
  using PatternTable = std::array<surface_patterns::MaskPatterns, kCutMaskCount>;
  using Vertices = std::array<std::uint32_t, 4 * surface_patterns::kSiteCount>;
  static constexpr Vertices kNotLookedUp = [] {
    Vertices none{};
    none.fill(VertexList::kNone);
    return none;
  }();
  // A tetrahedron that is being redone.
  struct Work {
    std::uint32_t tetrahedron;
    const SurfaceTopology::Cell& cell;
    const surface_patterns::MaskPatterns* before;  // its last picture; null: there is none
    const surface_patterns::MaskPatterns& now;
    Vertices vertices = kNotLookedUp;  // per code
  };
  Work begin(std::uint32_t tetrahedron, bool has_past) noexcept;
  void redo_interior(Work& work) noexcept;
  void redo_skin(Work& work, std::size_t face) noexcept;
  void redo_home(Work& work, std::uint32_t home, std::span<const surface_patterns::PatternTriangle> patterns) noexcept;
  std::uint32_t look_up_vertex(const Work& work, surface_patterns::VertexCode code) noexcept;
  static Carriers carriers_of(const Work& work, surface_patterns::VertexCode code) noexcept;
  std::uint32_t add_vertex(const Work& work, surface_patterns::VertexCode code) noexcept;
  std::uint32_t parent_of(const Work& work, surface_patterns::VertexCode code) const noexcept;
  void rename_vertex(std::uint32_t slot, std::uint32_t from, std::uint32_t to) noexcept;
  void finish() noexcept;

  const TetMesh& mesh_;
  const PatternTable& table_;
  SurfaceTopology topology_;
  OpenSprings springs_;
  NodeRotations rotations_;
  VertexList vertices_;
  TriangleList triangles_;
  SurfaceNormals normals_;
  Vector<std::uint8_t> masks_;  // per tetrahedron, as drawn
  VecView positions_;           // of the nodes, during a call
  double time_ = 0;
  bool rebuilt_ = false;
};

}  // namespace crumble
