// Tetrahedra that may be exchanged for others: for every node the list of those that hold it, nothing else.
//
// With about 24 tetrahedra at a node, a search through one list answers every question of topology (the ring of an
// edge, who shares a face, whether an edge exists) in tens of nanoseconds, and there are no neighbour links to keep
// right.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>

#include "crumble/base/memory.hpp"
#include "crumble/tetmesh/tet_mesh.hpp"

namespace crumble {

using TetId = std::uint32_t;
inline constexpr TetId kNoTet = 0xffffffffu;

inline bool holds(const Tetrahedron& t, std::uint32_t v) {
  return t[0] == v || t[1] == v || t[2] == v || t[3] == v;
}

/// Tetrahedra around an edge a-b in order: the k-th is (a, b, vertices[k], vertices[k + 1]), positive. `closed`: the
/// last one ends at vertices[0]; otherwise the edge lies on the boundary and there is one vertex more than tetrahedra.
struct Ring {
  static constexpr std::size_t kMost = 9;
  std::size_t size = 0;  // vertices; 0 when the ring has more than kMost or is broken
  bool closed = false;
  std::array<std::uint32_t, kMost> vertices;
  std::array<TetId, kMost> tets;
  std::size_t tet_count() const { return closed ? size : size - 1; }
};

class TetComplex {
 public:
  TetComplex(std::size_t node_count, Vector<Tetrahedron> tetrahedra);

  std::size_t slot_count() const { return tets_.size(); }
  bool alive(TetId t) const { return tets_[t][0] != tets_[t][1]; }
  const Tetrahedron& operator[](TetId t) const { return tets_[t]; }
  std::span<const TetId> star(std::uint32_t node) const { return stars_[node]; }
  Vector<Tetrahedron> tetrahedra() const;

  bool has_edge(std::uint32_t a, std::uint32_t b) const;
  bool has_face(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;
  /// The other tetrahedron at the face, kNoTet at the boundary.
  TetId across(TetId t, int face) const;
  Ring ring(std::uint32_t a, std::uint32_t b) const;

  void replace(std::span<const TetId> out, std::span<const Tetrahedron> in);

  /// From here on replacements are noted and can be taken back.
  void begin_trial();
  /// The tetrahedra that are there now and were not when the trial began.
  Vector<TetId> new_in_trial() const;
  void keep_trial() { trial_.reset(); }
  void undo_trial();

 private:
  struct Change {
    TetId slot;
    Tetrahedron before;
  };
  struct Trial {
    Vector<Change> changes;
    Vector<TetId> free;
    std::size_t slots;
  };
  void write(TetId slot, const Tetrahedron& t);

  Vector<Tetrahedron> tets_;  // a free slot holds the same node twice
  Vector<TetId> free_;
  Vector<Vector<TetId>> stars_;
  std::optional<Trial> trial_;
};

}  // namespace crumble
