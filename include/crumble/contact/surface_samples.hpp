// The surface of a body between its nodes: the faces of its tetrahedra that a thin tool can meet from outside, and how
// finely points are spread over them.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "crumble/base/bytes.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/tetmesh/tet_mesh.hpp"

namespace crumble {

/// Which faces lie open: those of the boundary, and those between a broken tetrahedron (one with a cut spring) and one
/// that is whole; in both cases only while their own three springs are intact. Copies share what does not change.
class SurfaceSamples {
 public:
  SurfaceSamples() = default;  // no faces
  explicit SurfaceSamples(const TetMesh& mesh);

  /// Mean rest length of the springs, metres; 0 without faces. A tool is thin when it is thinner.
  double node_spacing() const noexcept { return node_spacing_; }
  /// A box grown by this holds a node of each face that reaches into it, also of one stretched by half, metres.
  double reach() const noexcept { return longest_spring_; }

  void note_cut(std::span<const std::uint32_t> springs) noexcept;
  /// Nothing is cut.
  void clear() noexcept;

  bool is_open(std::uint32_t face) const noexcept { return open_[face] != 0; }
  /// Of an open face, counter-clockwise seen from outside the body.
  Triangle nodes_of(std::uint32_t face) const noexcept;
  /// Open faces with a corner among `nodes`, each once, in the order of `nodes`. Valid until the next search.
  std::span<const std::uint32_t> faces_of(std::span<const std::uint32_t> nodes) noexcept;

  void save(ByteWriter& out) const;
  /// Throws Error(corrupt).
  void load(ByteReader& in);

  /// Parts that an edge of a face is divided into so that points no farther apart than `spacing` cover it, at most
  /// kMostParts: (n + 1) (n + 2) / 2 points on a face.
  static std::uint32_t parts(double longest_edge, double spacing) noexcept;
  static constexpr std::uint32_t kMostParts = 15;

  std::size_t face_count() const noexcept { return open_.size(); }

 private:
  struct Faces;
  void open_or_close(std::uint32_t face) noexcept;

  std::shared_ptr<const Faces> faces_;
  double node_spacing_ = 0, longest_spring_ = 0;
  Vector<std::uint8_t> cut_;            // of each spring
  Vector<std::uint8_t> broken_;         // of each tetrahedron
  Vector<std::uint8_t> open_;           // of each face
  Vector<std::uint32_t> open_of_node_;  // how many
  Vector<std::uint32_t> seen_;          // of each face, the search that last met it
  Vector<std::uint32_t> found_;         // as many as there are faces
  std::uint32_t search_ = 0;
};

}  // namespace crumble
