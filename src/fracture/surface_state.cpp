// How a picture follows the one before.
//
// What a tetrahedron shows follows from its own mask and its nodes' fragments (surface_patterns.hpp): copies in a face
// are decided by the face's own springs, and whoever holds one of these redoes both tetrahedra of the face. So after a
// cut only the tetrahedra round the cut spring are redone, in any order, and nothing spreads.
//
// update() goes in this order, so that nothing drawn jumps at a cut:
//   1. find what has changed                                          open_springs
//   2. fit rotations, as if nothing had been cut                      node_rotations
//   3. move the vertices of the last picture to where they are now    surface_vertices
//   4. redo tetrahedra. A new vertex starts where the copy that it comes out of has just been put, or, if its point has
//      not been drawn yet, where the point of the uncut body is: the mean of the corners it lies between
//   5. fit the rotations that the cuts have changed or that step 4 asks for; these and the new and the changed vertices
//      settle from here on
#include "surface_state.hpp"

#include <algorithm>
#include <limits>

#include "crumble/base/memory.hpp"
#include "crumble/fracture/fragments.hpp"
#include "paper_patterns.hpp"

namespace crumble {
namespace {

using surface_patterns::copy_of;
using surface_patterns::kSiteCorners;
using surface_patterns::MaskPatterns;
using surface_patterns::PatternTriangle;
using surface_patterns::site_of;
using surface_patterns::VertexCode;

// Of a set of corners.
constexpr std::array<std::uint8_t, 16> kBitCounts{0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4};

using PatternTable = std::array<MaskPatterns, kCutMaskCount>;

const PatternTable& table_of(SurfaceMode mode) {
  return mode == SurfaceMode::paper ? surface_patterns::kPaperPatterns : surface_patterns::kPatterns;
}

std::size_t interior_bound(const PatternTable& table) {
  std::size_t bound = 0;
  for (const MaskPatterns& patterns : table) bound = std::max<std::size_t>(bound, patterns.interior_count);
  return bound;
}

std::size_t skin_bound(const PatternTable& table) {
  std::size_t bound = 0;
  for (const MaskPatterns& patterns : table) {
    for (const std::size_t count : patterns.skin_count) bound = std::max(bound, count);
  }
  return bound;
}

// The paper draws nodes and spring ends only, but inside the body too.
std::size_t vertex_bound(const TetMesh& mesh, const SurfaceTopology& topology, SurfaceMode mode) {
  const std::size_t ends = 2 * mesh.springs.size();
  if (mode == SurfaceMode::paper) return mesh.node_count() + ends;
  return topology.outer_node_count + ends + 3 * topology.face_count + 4 * topology.cells.size();
}

}  // namespace

SurfaceExtractor::State::State(const TetMesh& mesh, const SurfaceSettings& settings)
    : mesh_(mesh),
      table_(table_of(settings.mode)),
      topology_(mesh, settings.crease),
      springs_(mesh, topology_, settings.mode),
      rotations_(mesh, settings.settle),
      vertices_(mesh, rotations_, topology_.slot_count, vertex_bound(mesh, topology_, settings.mode), settings.settle),
      triangles_(topology_, interior_bound(table_), skin_bound(table_)),
      normals_(topology_, triangles_.bound()),
      masks_(mesh.tetrahedra.size()) {
  const VecArray rest(mesh.positions);
  const Vector<std::uint8_t> intact(mesh.springs.size(), 1);
  const Vector<std::uint32_t> fragments(mesh.node_count(), 0);
  rebuild({rest, intact, fragments, std::numeric_limits<double>::quiet_NaN()});  // no time comes after it
}

void SurfaceExtractor::State::update(const SurfaceInput& now) noexcept {
  if (!(now.time >= time_) || !springs_.advance(now)) return rebuild(now);
  triangles_.changed.clear();
  vertices_.changed.clear();
  rebuilt_ = false;
  time_ = now.time;
  positions_ = now.positions;
  rotations_.fit(positions_, time_);
  vertices_.place(positions_, time_);
  for (const std::uint32_t spring : springs_.cuts()) rotations_.cut(spring);
  for (const std::uint32_t t : springs_.dirty()) {
    Work work = begin(t, true);
    redo_interior(work);
    for (std::size_t face = 0; face < 4; ++face) redo_skin(work, face);
  }
  rotations_.refit(positions_, time_);
  vertices_.settle(positions_, time_);
  finish();
}

// The skin first, so that no interior triangle has to make room for it.
void SurfaceExtractor::State::rebuild(const SurfaceInput& now) noexcept {
  triangles_.changed.insert_all();
  vertices_.changed.insert_all();
  rebuilt_ = true;
  time_ = now.time;
  positions_ = now.positions;
  springs_.reset(now);
  rotations_.reset(now.intact);
  vertices_.clear();
  triangles_.clear();
  for (const auto& [tetrahedron, face, corners, slots] : topology_.outer_faces) {
    Work work = begin(tetrahedron, false);
    redo_skin(work, face);
  }
  for (std::uint32_t t = 0; t < masks_.size(); ++t) {
    Work work = begin(t, false);
    redo_interior(work);
  }
  rotations_.refit(positions_, time_);
  vertices_.place(positions_, time_);
  finish();
}

void SurfaceExtractor::State::finish() noexcept {
  vertices_.remove_unused(
      [&](std::uint32_t slot, std::uint32_t from, std::uint32_t to) { rename_vertex(slot, from, to); });
  triangles_.changed.keep_below(triangles_.count());
  vertices_.changed.keep_below(vertices_.count());
  normals_.update(triangles_, vertices_.positions());
  positions_ = {};
}

SurfaceExtractor::State::Work SurfaceExtractor::State::begin(std::uint32_t tetrahedron, bool has_past) noexcept {
  const MaskPatterns* before = has_past ? &table_[masks_[tetrahedron]] : nullptr;
  masks_[tetrahedron] = springs_.mask(tetrahedron);
  return {tetrahedron, topology_.cells[tetrahedron], before, table_[masks_[tetrahedron]]};
}

void SurfaceExtractor::State::redo_interior(Work& work) noexcept {
  redo_home(work, work.tetrahedron, std::span(work.now.interior).first(work.now.interior_count));
}

void SurfaceExtractor::State::redo_skin(Work& work, std::size_t face) noexcept {
  const std::uint32_t outer_face = work.cell.outer_faces[face];
  if (outer_face == SurfaceTopology::kNone) return;
  redo_home(work, triangles_.skin_home(outer_face), std::span(work.now.skin[face]).first(work.now.skin_count[face]));
}

// The home's triangles become those of `patterns` that belong to a fragment.
void SurfaceExtractor::State::redo_home(Work& work, std::uint32_t home,
                                        std::span<const PatternTriangle> patterns) noexcept {
  std::size_t count = 0;
  const auto release = [&](const Triangle& triangle) {
    for (const std::uint32_t vertex : triangle) vertices_.release(vertex);
  };
  const auto vertex_at = [&](VertexCode code) {
    std::uint32_t& vertex = work.vertices[code];
    if (vertex == VertexList::kNone) vertex = look_up_vertex(work, code);
    return vertex;
  };
  for (const PatternTriangle& pattern : patterns) {
    const std::uint32_t fragment = springs_.fragment(work.cell.nodes[pattern.owner]);
    if (fragment == kNoFragment) continue;
    SurfaceTriangle triangle{{}, vertex_at(pattern.fourth), fragment, pattern.vertices};
    if (work.cell.flipped) std::swap(triangle.codes[0], triangle.codes[2]);
    for (std::size_t k = 0; k < 3; ++k) {
      triangle.vertices[k] = vertex_at(triangle.codes[k]);
      vertices_.retain(triangle.vertices[k]);
    }
    if (count < triangles_.home_count(home)) release(triangles_.at(home, count));
    triangles_.put(home, count++, triangle);
  }
  while (triangles_.home_count(home) > count) {
    release(triangles_.at(home, triangles_.home_count(home) - 1));
    triangles_.drop_last(home);
  }
}

// Without a branch, which would mostly be guessed wrong.
Carriers SurfaceExtractor::State::carriers_of(const Work& work, VertexCode code) noexcept {
  Carriers carriers{};
  for (std::size_t corner = 0; corner < 4; ++corner) {
    carriers.nodes[carriers.count] = work.cell.nodes[corner];
    carriers.count += work.now.carriers[code] >> corner & 1u;
  }
  return carriers;
}

// The vertex of a code, made or brought up to its present carriers.
std::uint32_t SurfaceExtractor::State::look_up_vertex(const Work& work, VertexCode code) noexcept {
  const std::uint32_t vertex = vertices_.find(work.cell.first_slots[site_of(code)] + copy_of(code));
  if (vertex == VertexList::kNone) return add_vertex(work, code);
  const bool has_lost_carriers = vertices_.carrier_count(vertex) != kBitCounts[work.now.carriers[code]];
  if (has_lost_carriers) vertices_.set_carriers(vertex, carriers_of(work, code));
  return vertex;
}

std::uint32_t SurfaceExtractor::State::add_vertex(const Work& work, VertexCode code) noexcept {
  const std::uint32_t slot = work.cell.first_slots[site_of(code)] + copy_of(code);
  const Carriers carriers = carriers_of(work, code);
  const std::uint32_t parent = parent_of(work, code);
  if (parent != VertexList::kNone) {
    if (vertices_.is_carried_by(parent, carriers)) return vertices_.add_twin(slot, parent);
    return vertices_.add_freed(slot, carriers, vertices_.rest_positions()[parent], vertices_.positions()[parent]);
  }
  const auto mean = [&](const auto& places) {
    const unsigned corners = kSiteCorners[site_of(code)];
    Vec3 sum = Vec3::Zero();
    for (std::size_t corner = 0; corner < 4; ++corner) {
      sum += static_cast<double>(corners >> corner & 1u) * places[work.cell.nodes[corner]];
    }
    return Vec3(1.0 / kBitCounts[corners] * sum);
  };
  const Vec3 rest = mean(mesh_.positions);
  if (work.before == nullptr) return vertices_.add(slot, carriers, rest);
  return vertices_.add_freed(slot, carriers, rest, mean(positions_));
}

// The copy of the last picture that the vertex comes out of, or kNone: its site was not drawn.
std::uint32_t SurfaceExtractor::State::parent_of(const Work& work, VertexCode code) const noexcept {
  if (work.before == nullptr) return VertexList::kNone;
  for (std::size_t copy = 0; copy < 4; ++copy) {
    const unsigned carriers = work.before->carriers[site_of(code) * 4 + copy];
    const std::uint32_t parent =
        vertices_.find(work.cell.first_slots[site_of(code)] + static_cast<std::uint32_t>(copy));
    const bool held = (carriers & work.now.carriers[code]) == work.now.carriers[code];
    if (held && parent != VertexList::kNone) return parent;
  }
  return VertexList::kNone;
}

void SurfaceExtractor::State::rename_vertex(std::uint32_t slot, std::uint32_t from, std::uint32_t to) noexcept {
  for (const std::uint32_t t : topology_.users(slot)) {
    triangles_.rename_vertex(t, from, to);
    for (const std::uint32_t outer_face : topology_.cells[t].outer_faces) {
      if (outer_face != SurfaceTopology::kNone) triangles_.rename_vertex(triangles_.skin_home(outer_face), from, to);
    }
  }
}

void SurfaceExtractor::State::spread_over_skin(std::span<const CornerCoordinates> boundary,
                                               std::span<CornerCoordinates> skin) const noexcept {
  for (std::size_t t = 0; t < triangles_.skin_count(); ++t) {
    const std::uint32_t source = triangles_.outer_faces()[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const unsigned corners = kSiteCorners[site_of(triangles_.codes()[t][k])];
      Eigen::Vector2f sum = Eigen::Vector2f::Zero();
      for (std::size_t corner = 0; corner < 4; ++corner) {
        if ((corners >> corner & 1u) == 0) continue;
        sum += boundary[source][topology_.outer_faces[source].boundary_corners[corner]];
      }
      skin[t][k] = sum / static_cast<float>(kBitCounts[corners]);
    }
  }
}

}  // namespace crumble
