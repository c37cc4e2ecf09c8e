// Which springs the surface is open at, and what has changed since the last picture.
//
// Nobody keeps lists of cuts for the extractor: it compares the flags and labels with its own copies. That costs a
// read of both arrays per picture and cannot miss anything, however many steps lie between two pictures.
#pragma once

#include <cstdint>
#include <span>

#include "crumble/base/memory.hpp"
#include "crumble/fracture/surface.hpp"
#include "surface_arrays.hpp"
#include "surface_topology.hpp"

namespace crumble {

class OpenSprings {
 public:
  /// Starts with every spring intact and one fragment, 0. Both are borrowed.
  OpenSprings(const TetMesh& mesh, const SurfaceTopology& topology, SurfaceMode mode);

  /// Takes the state over as it is.
  void reset(const SurfaceInput& now) noexcept;
  /// Takes over what has changed; then cuts() and dirty() tell what. False, with nothing to be relied on but a reset(),
  /// if `now` cannot come after the last state: a spring is whole again, or a removed node is back.
  bool advance(const SurfaceInput& now) noexcept;

  /// Springs cut in the last advance().
  std::span<const std::uint32_t> cuts() const noexcept { return cuts_.items(); }
  /// Tetrahedra with a newly opened spring or a new label.
  std::span<const std::uint32_t> dirty() const noexcept { return dirty_.items(); }

  std::uint8_t mask(std::size_t tetrahedron) const noexcept;
  std::uint32_t fragment(std::size_t node) const noexcept { return labels_[node]; }

 private:
  bool find_cuts(std::span<const std::uint8_t> intact) noexcept;
  bool find_new_labels(std::span<const std::uint32_t> labels) noexcept;
  bool find_partings() noexcept;
  void open(std::uint32_t spring) noexcept;

  const TetMesh& mesh_;
  const SurfaceTopology& topology_;
  bool by_fragments_;
  Vector<std::uint8_t> intact_;   // per spring
  Vector<std::uint8_t> closed_;   // per spring; mode `fragments` only
  Vector<std::uint32_t> labels_;  // per node
  IndexSet cuts_, dirty_;
};

}  // namespace crumble
