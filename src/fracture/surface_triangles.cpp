#include "surface_triangles.hpp"

#include <algorithm>

namespace crumble {

TriangleList::TriangleList(const SurfaceTopology& topology, std::size_t interior_bound, std::size_t skin_bound)
    : changed(interior_bound * topology.cells.size() + skin_bound * topology.outer_faces.size()),
      topology_(topology),
      tetrahedron_count_(static_cast<std::uint32_t>(topology.cells.size())),
      interior_bound_(interior_bound),
      skin_bound_(skin_bound),
      first_skin_key_(interior_bound * topology.cells.size()),
      home_counts_(topology.cells.size() + topology.outer_faces.size()),
      where_(first_skin_key_ + skin_bound * topology.outer_faces.size()),
      vertices_(where_.size()),
      links_(where_.size()),
      fragments_(where_.size()),
      tetrahedra_(where_.size()),
      outer_faces_(skin_bound * topology.outer_faces.size()),
      codes_(outer_faces_.size()) {}

void TriangleList::clear() noexcept {
  count_ = skin_count_ = 0;
  std::fill(home_counts_.begin(), home_counts_.end(), std::uint8_t{0});
}

void TriangleList::drop_last(std::uint32_t home) noexcept {
  std::size_t hole = where_[key(home, --home_counts_[home])];
  if (hole < skin_count_) {
    --skin_count_;
    outer_faces_[hole] = outer_faces_[skin_count_];
    codes_[hole] = codes_[skin_count_];
    move(skin_count_, hole);
    hole = skin_count_;
  }
  move(--count_, hole);
}

// The last step of every change of place; `to` is free.
void TriangleList::move(std::size_t from, std::size_t to) noexcept {
  if (from == to) return;
  links_[to] = links_[from];
  where_[links_[to].key] = static_cast<std::uint32_t>(to);
  vertices_[to] = vertices_[from];
  fragments_[to] = fragments_[from];
  tetrahedra_[to] = tetrahedra_[from];
  changed.insert(static_cast<std::uint32_t>(to));
}

void TriangleList::rename_vertex(std::uint32_t home, std::uint32_t from, std::uint32_t to) noexcept {
  for (std::size_t i = 0; i < home_counts_[home]; ++i) {
    const std::uint32_t t = where_[key(home, i)];
    if (links_[t].fourth == from) links_[t].fourth = to;
    for (std::uint32_t& vertex : vertices_[t]) {
      if (vertex != from) continue;
      vertex = to;
      changed.insert(t);
    }
  }
}

}  // namespace crumble
