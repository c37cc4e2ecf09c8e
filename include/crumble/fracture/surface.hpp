// The surface of a body that breaks: closed, oriented and 2-manifold in every state of cutting.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "crumble/base/memory.hpp"
#include "crumble/base/transcendental.hpp"
#include "crumble/base/vec_array.hpp"
#include "crumble/geometry/triangle_mesh.hpp"
#include "crumble/tetmesh/tet_mesh.hpp"

namespace crumble {

/// What a cut spring opens (docs/fracture.md).
enum class SurfaceMode : std::uint8_t {
  cracks = 0,     // the faces between its two ends' cells, at once: notches and cracks show before anything is free
  fragments = 1,  // the same, but only once its ends are in different fragments: no crack shows before that
  paper = 2,      // the paper's drawing (Fig 6): flat patterns with the cut ends at half the rest length
};

struct SurfaceSettings {
  SurfaceMode mode = SurfaceMode::cracks;
  double settle = 0.05;            // s, >= 0: how long what a cut has freed takes to its new place; 0: it jumps
  double crease = 40 * kPi / 180;  // rad, 0 to pi: skin edges that are sharper than this at rest are shaded sharp
};

/// The body as it is now. Borrowed for one call.
struct SurfaceInput {
  VecView positions;                         // metres (node_count)
  std::span<const std::uint8_t> intact;      // 1 or 0 (spring_count)
  std::span<const std::uint32_t> fragments;  // of each node; kNoFragment: removed by the host, and not drawn
  double time = 0;                           // s; any clock that the cuts are to be smoothed by
};

/// Turns cut flags into a triangle surface. Each node owns its barycentric dual cell; a cut spring opens the faces
/// between its two cells. Nothing is drawn inside the body but the cracks, and the uncut body is its boundary
/// triangles. In the modes `cracks` and `fragments` the surface is closed, oriented and 2-manifold in every state of
/// cutting, and so are the triangles of each fragment alone; in the mode `paper` it is closed too, but parts of it
/// touch in edges and corners.
///
/// Made for the reader's thread, beside the step: every buffer is sized at construction and no call below allocates.
/// Memory that nothing has been drawn in yet is not touched, so it costs addresses only. One thread at a time.
class SurfaceExtractor {
 public:
  /// Starts as the uncut body at rest. `mesh` is borrowed and must outlive the extractor. Throws Error (invalid_value,
  /// out_of_range) for `settings`.
  explicit SurfaceExtractor(const TetMesh& mesh, const SurfaceSettings& settings = {});
  ~SurfaceExtractor();

  /// Brings everything up to `now`. Only tetrahedra with a newly opened spring or a new fragment id are redone. A point
  /// of node i's cell keeps its place in the cell: x_i + R_i (X - X_i), with X at rest and R_i the rotation that fits
  /// node i's intact springs best; a point on the cells of several nodes is the mean. A cut moves nothing at first:
  /// what is drawn goes from where it was to its new place within `settle` seconds. What the springs leave open (the
  /// twist about a last spring, the attitude of a node without any) stays as it was at the previous update. This is
  /// a rebuild() the first time, and when a spring is whole again, a removed node is back or time has run backwards.
  void update(const SurfaceInput& now) noexcept;

  /// The same without a past: everything is drawn where it settles.
  void rebuild(const SurfaceInput& now) noexcept;

  // Triangles, counter-clockwise from outside: first the skin (parts of the body's outer faces), then the interior that
  // cracks have laid open. Indices stay until changed_triangles() names them.
  std::span<const Triangle> triangles() const noexcept;
  std::size_t skin_triangle_count() const noexcept;
  /// Per triangle: the fragment it belongs to, and the tetrahedron it was cut from.
  std::span<const std::uint32_t> fragments() const noexcept;
  std::span<const std::uint32_t> tetrahedra() const noexcept;

  /// Per vertex, metres: where it is now, and where it is in the body at rest (a solid texture coordinate).
  std::span<const Vec3> positions() const noexcept;
  std::span<const Vec3> rest_positions() const noexcept;

  /// Per triangle corner, unit (zero on a facet without area): smooth over the skin but for creases and cracks, flat on
  /// each interior facet.
  std::span<const std::array<Eigen::Vector3f, 3>> corner_normals() const noexcept;

  /// What the last call changed, for those who keep a copy: triangles whose vertices, place (skin or interior) or
  /// fragment are new, and vertices whose place at rest is. Each index once, in no order, below the counts as they are
  /// now; counts may have shrunk as well. After a rebuild: all. Positions and normals change with every call.
  std::span<const std::uint32_t> changed_triangles() const noexcept;
  std::span<const std::uint32_t> changed_vertices() const noexcept;
  bool rebuilt() const noexcept;

  /// Per skin triangle: the triangle of TetMesh::boundary that it is a part of.
  std::span<const std::uint32_t> skin_sources() const noexcept;
  /// Spreads what is given at the corners of the boundary's triangles, texture coordinates say (boundary.size()), over
  /// the skin's: writes the corners of each skin triangle (skin_triangle_count() places), interpolated as at rest.
  using CornerCoordinates = std::array<Eigen::Vector2f, 3>;
  void spread_over_skin(std::span<const CornerCoordinates> boundary, std::span<CornerCoordinates> skin) const noexcept;

  /// What the buffers hold; never exceeded. In the modes `cracks` and `fragments` 24 T + 6 F_b triangles and
  /// N_b + 2 E + 3 F + 4 T vertices (T tetrahedra, E springs, F faces, F_b and N_b faces and nodes of the boundary),
  /// which a body with every spring cut has.
  std::size_t max_triangle_count() const noexcept;
  std::size_t max_vertex_count() const noexcept;

 private:
  class State;
  std::unique_ptr<State> state_;
};

/// One fragment's own surface.
struct FragmentSurface {
  TriangleMesh mesh;                // now; closed
  Vector<std::uint32_t> vertices;   // per vertex: its index in the whole surface
  Vector<std::uint32_t> triangles;  // per triangle: its index in the whole surface
};
FragmentSurface fragment_surface(const SurfaceExtractor& surface, std::uint32_t fragment);

}  // namespace crumble
