// The compact list of triangles, skin first, and who has put which where.
//
// Each triangle has a home: the tetrahedron whose interior or the outer face whose skin it is a part of. A home's
// triangles are numbered 0, 1, ... and found wherever they are in the list. The list has no holes: what is added goes
// to the end of its part, for which the first interior triangle makes room if it is skin, and the last of a part fills
// the place of what is removed.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "crumble/base/memory.hpp"
#include "crumble/geometry/triangle_mesh.hpp"
#include "surface_arrays.hpp"
#include "surface_patterns.hpp"
#include "surface_topology.hpp"

namespace crumble {

struct SurfaceTriangle {
  Triangle vertices;
  std::uint32_t fourth;  // see PatternTriangle
  std::uint32_t fragment;
  std::array<surface_patterns::VertexCode, 3> codes;  // of the vertices
};

class TriangleList {
 public:
  /// At most `interior_bound` triangles per tetrahedron and `skin_bound` per outer face.
  TriangleList(const SurfaceTopology& topology, std::size_t interior_bound, std::size_t skin_bound);

  /// Homes: tetrahedra first, then outer faces.
  std::uint32_t skin_home(std::uint32_t outer_face) const noexcept { return tetrahedron_count_ + outer_face; }

  void clear() noexcept;
  std::size_t home_count(std::uint32_t home) const noexcept { return home_counts_[home]; }
  const Triangle& at(std::uint32_t home, std::size_t i) const noexcept { return vertices_[where_[key(home, i)]]; }
  /// Overwrites the home's triangle i, or adds it if i is home_count(home).
  void put(std::uint32_t home, std::size_t i, const SurfaceTriangle& triangle) noexcept;
  void drop_last(std::uint32_t home) noexcept;
  /// Vertex `from` is called `to` from now on.
  void rename_vertex(std::uint32_t home, std::uint32_t from, std::uint32_t to) noexcept;

  std::size_t count() const noexcept { return count_; }
  std::size_t skin_count() const noexcept { return skin_count_; }
  std::size_t bound() const noexcept { return vertices_.size(); }
  std::span<const Triangle> vertices() const noexcept { return vertices_.first(count_); }
  std::uint32_t fourth(std::size_t triangle) const noexcept { return links_[triangle].fourth; }
  std::span<const std::uint32_t> fragments() const noexcept { return fragments_.first(count_); }
  std::span<const std::uint32_t> tetrahedra() const noexcept { return tetrahedra_.first(count_); }
  /// Of the skin: outer face, and the vertices' codes in its tetrahedron.
  std::span<const std::uint32_t> outer_faces() const noexcept { return outer_faces_.first(skin_count_); }
  std::span<const std::array<surface_patterns::VertexCode, 3>> codes() const noexcept {
    return codes_.first(skin_count_);
  }

  /// What has changed since it was last cleared.
  IndexSet changed;

 private:
  struct Link {
    std::uint32_t key;
    std::uint32_t fourth;
  };
  std::size_t key(std::uint32_t home, std::size_t i) const noexcept {
    return home < tetrahedron_count_ ? home * interior_bound_ + i
                                     : first_skin_key_ + (home - tetrahedron_count_) * skin_bound_ + i;
  }
  std::uint32_t add(std::uint32_t home) noexcept;
  void move(std::size_t from, std::size_t to) noexcept;

  const SurfaceTopology& topology_;
  std::uint32_t tetrahedron_count_;
  std::size_t interior_bound_, skin_bound_, first_skin_key_;
  std::size_t count_ = 0, skin_count_ = 0;
  Vector<std::uint8_t> home_counts_;
  UntouchedArray<std::uint32_t> where_;  // per key: the triangle
  UntouchedArray<Triangle> vertices_;
  UntouchedArray<Link> links_;
  UntouchedArray<std::uint32_t> fragments_, tetrahedra_;
  UntouchedArray<std::uint32_t> outer_faces_;                          // per skin triangle
  UntouchedArray<std::array<surface_patterns::VertexCode, 3>> codes_;  // per skin triangle
};

inline void TriangleList::put(std::uint32_t home, std::size_t i, const SurfaceTriangle& triangle) noexcept {
  const bool is_new = i == home_counts_[home];
  const std::uint32_t t = is_new ? add(home) : where_[key(home, i)];
  const auto& [a, b, c] = vertices_[t];
  const auto& [d, e, f] = triangle.vertices;
  if (is_new || a != d || b != e || c != f || fragments_[t] != triangle.fragment) changed.insert(t);
  vertices_[t] = triangle.vertices;
  links_[t].fourth = triangle.fourth;
  fragments_[t] = triangle.fragment;
  if (t < skin_count_) codes_[t] = triangle.codes;
}

// The place of a new triangle; what follows from its home is written.
inline std::uint32_t TriangleList::add(std::uint32_t home) noexcept {
  const bool is_skin = home >= tetrahedron_count_;
  std::size_t t = count_;
  if (is_skin) {
    t = skin_count_++;
    if (t < count_) move(t, count_);
    outer_faces_[t] = home - tetrahedron_count_;
    tetrahedra_[t] = topology_.outer_faces[outer_faces_[t]].tetrahedron;
  } else {
    tetrahedra_[t] = home;
  }
  ++count_;
  const std::size_t k = key(home, home_counts_[home]++);
  links_[t].key = static_cast<std::uint32_t>(k);
  where_[k] = static_cast<std::uint32_t>(t);
  return static_cast<std::uint32_t>(t);
}

}  // namespace crumble
