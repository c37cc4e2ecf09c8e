// The surface of a body that breaks: closed, oriented and 2-manifold in every state of cutting.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "crumble/base/vec_array.hpp"
#include "crumble/geometry/triangle_mesh.hpp"
#include "crumble/tetmesh/tet_mesh.hpp"

namespace crumble {

class NodeRotations;
struct SurfaceTopology;
namespace surface_patterns {
struct PatternTriangle;
}

/// Turns cut flags into a triangle surface. Each node owns its barycentric dual cell; a cut spring opens the faces
/// between its two cells, so notches and cracks show before a piece is free (docs/fracture.md). Nothing is drawn inside
/// the body but the cracks, and the uncut body is its boundary triangles.
///
/// Made for the reader's thread, beside the step: every buffer is sized at construction and no call allocates.
class SurfaceExtractor {
 public:
  /// Starts as the uncut body at rest. `mesh` is borrowed and must outlive the extractor.
  explicit SurfaceExtractor(const TetMesh& mesh);
  ~SurfaceExtractor();

  /// Rebuilds the triangles. `intact` (spring_count; 1 or 0); `node_fragments` (node_count), as
  /// FragmentLabeler::labels. Positions and normals are stale until the next update().
  void extract(std::span<const std::uint8_t> intact, std::span<const std::uint32_t> node_fragments) noexcept;

  /// Moves the vertices and normals to where the nodes are (node_count, metres). A point of node i's cell keeps its
  /// place in the cell: x_i + R_i (X - X_i), with X at rest and R_i the rotation that fits node i's intact springs
  /// best; a point on the cells of several nodes is the mean. What the springs leave open (the twist about a last
  /// spring, the attitude of a node without any) stays as it was at the previous update.
  void update(VecView positions) noexcept;

  // Triangles, counter-clockwise from outside: first the skin (parts of the body's outer faces), then the interior that
  // cracks have laid open, in pairs of which each makes one four-sided facet.
  std::span<const Triangle> triangles() const noexcept { return {triangles_.data(), triangle_count_}; }
  std::size_t skin_triangle_count() const noexcept { return skin_triangle_count_; }
  /// Per triangle: the fragment it belongs to, and the tetrahedron it was cut from.
  std::span<const std::uint32_t> fragments() const noexcept { return {fragments_.data(), triangle_count_}; }
  std::span<const std::uint32_t> tetrahedra() const noexcept { return {tetrahedra_.data(), triangle_count_}; }

  /// Per vertex, metres: where it is now, and where it is in the body at rest (a solid texture coordinate).
  std::span<const Vec3> positions() const noexcept { return {positions_.data(), vertex_count_}; }
  std::span<const Vec3> rest_positions() const noexcept { return {rest_positions_.data(), vertex_count_}; }

  /// Per triangle corner, unit (zero on a facet without area): smooth over the skin but for creases of more than 40
  /// degrees at rest and for cracks, flat on each interior facet.
  std::span<const std::array<Eigen::Vector3f, 3>> corner_normals() const noexcept {
    return {corner_normals_.data(), triangle_count_};
  }

  /// What the buffers hold: 24 T + 6 F_b triangles and N_b + 2 E + 3 F + 4 T vertices (T tetrahedra, E springs, F
  /// faces, F_b and N_b faces and nodes of the boundary); a body with every spring cut has exactly as many.
  std::size_t max_triangle_count() const noexcept { return triangles_.size(); }
  std::size_t max_vertex_count() const noexcept { return positions_.size(); }

 private:
  // Nodes whose cells carry a vertex: its position is the mean of the places these give it.
  struct Carriers {
    std::array<std::uint32_t, 4> nodes;
    std::uint32_t count;
  };

  void allocate();
  void extract_skin(std::span<const std::uint32_t> node_fragments) noexcept;
  void extract_interior(std::span<const std::uint32_t> node_fragments) noexcept;
  std::array<std::uint8_t, 3> add_triangle(std::uint32_t tetrahedron, const surface_patterns::PatternTriangle& pattern,
                                           std::span<const std::uint32_t> node_fragments) noexcept;
  std::uint32_t add_vertex(std::uint32_t tetrahedron, std::uint8_t code) noexcept;
  Vec3 area_vector(std::size_t triangle) const noexcept;
  void update_skin_normals() noexcept;
  void update_interior_normals() noexcept;

  const TetMesh* mesh_;
  std::unique_ptr<const SurfaceTopology> topology_;
  std::unique_ptr<NodeRotations> rotations_;

  std::size_t triangle_count_ = 0, skin_triangle_count_ = 0, vertex_count_ = 0;
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> fragments_, tetrahedra_;
  std::vector<std::array<Eigen::Vector3f, 3>> corner_normals_;
  std::vector<Vec3> positions_, rest_positions_;
  std::vector<Carriers> carriers_;  // per vertex

  std::vector<std::uint8_t> masks_;                              // per tetrahedron
  std::vector<std::uint32_t> slot_vertices_;                     // vertex in each slot of Topology, or none
  std::vector<std::array<std::uint32_t, 3>> skin_normal_slots_;  // per skin triangle
  std::vector<Vec3> normal_sums_;                                // per normal slot
};

}  // namespace crumble
