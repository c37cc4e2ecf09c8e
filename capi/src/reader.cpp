#include "reader.hpp"

#include <algorithm>

namespace crumble::capi {

constinit HandleTable Reader::table{3};

Reader::Reader(std::shared_ptr<const TetMesh> body, const Simulation& simulation, const SurfaceSettings& settings)
    : mesh(std::move(body)),
      link(share_new<ReaderLink>(simulation)),
      state(&link->publisher.latest()),
      surface(*mesh, settings),
      masses_(simulation.network().masses),
      fragments_(mesh->node_count()),
      lists_(*mesh),
      triangles_(surface.max_triangle_count()),
      first_triangles_(mesh->node_count() + 1) {
  surface.rebuild({state->positions, state->intact, state->fragments, state->time});
}

void Reader::update() noexcept {
  state = &link->publisher.latest();
  surface.update({state->positions, state->intact, state->fragments, state->time});
  measured_ = listed_ = triangles_listed_ = false;
}

const Fragment& Reader::measure(std::uint32_t fragment) noexcept {
  if (!measured_) {
    measure_fragments(*mesh, state->fragments, masses_, state->positions,
                      std::span(fragments_).first(state->fragment_count));
  }
  measured_ = true;
  return fragments_[fragment];
}

std::span<const std::uint32_t> Reader::list(std::uint32_t fragment, std::uint32_t which) noexcept {
  if (which == CRUMBLE_LIST_TRIANGLES) {
    if (!triangles_listed_) list_triangles();
    triangles_listed_ = true;
    const std::uint32_t first = first_triangles_[fragment];
    return std::span(triangles_).subspan(first, first_triangles_[fragment + 1] - first);
  }
  if (!listed_) lists_.update(state->fragments, state->fragment_count);
  listed_ = true;
  return which == CRUMBLE_LIST_NODES ? lists_.nodes(fragment) : lists_.tetrahedra(fragment);
}

// Counting sort. A triangle is never a removed fragment's.
void Reader::list_triangles() noexcept {
  const std::span<const std::uint32_t> fragments = surface.fragments();
  std::fill(first_triangles_.begin(), first_triangles_.end(), 0u);
  for (const std::uint32_t f : fragments) ++first_triangles_[f];
  std::uint32_t end = 0;
  for (std::uint32_t& place : first_triangles_) place = end += place;
  for (auto t = static_cast<std::uint32_t>(fragments.size()); t-- > 0;)
    triangles_[--first_triangles_[fragments[t]]] = t;
}

}  // namespace crumble::capi
