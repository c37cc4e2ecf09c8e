#include "crumble/fracture/surface.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "node_rotations.hpp"
#include "surface_patterns.hpp"
#include "surface_topology.hpp"

namespace crumble {
namespace {

using surface_patterns::copy_of;
using surface_patterns::kPatterns;
using surface_patterns::PatternTriangle;
using surface_patterns::site_of;
using surface_patterns::VertexCode;

constexpr std::uint32_t kNoVertex = 0xffffffffu;

Eigen::Vector3f unit(const Vec3& area_vector) noexcept {
  const double length = norm(area_vector);
  return (area_vector / std::max(length, std::numeric_limits<double>::min())).cast<float>();
}

}  // namespace

SurfaceExtractor::SurfaceExtractor(const TetMesh& mesh)
    : mesh_(&mesh),
      topology_(std::make_unique<const SurfaceTopology>(mesh)),
      rotations_(std::make_unique<NodeRotations>(mesh)) {
  allocate();
  extract(std::vector<std::uint8_t>(mesh.springs.size(), 1), std::vector<std::uint32_t>(mesh.node_count()));
  update(VecArray(mesh.positions));
}

SurfaceExtractor::~SurfaceExtractor() = default;

void SurfaceExtractor::allocate() {
  const std::size_t tetrahedron_count = mesh_->tetrahedra.size();
  const std::size_t outer_face_count = topology_->outer_faces.size();
  const std::size_t triangle_bound = 24 * tetrahedron_count + 6 * outer_face_count;
  triangles_.resize(triangle_bound);
  fragments_.resize(triangle_bound);
  tetrahedra_.resize(triangle_bound);
  corner_normals_.resize(triangle_bound);
  const std::size_t vertex_bound =
      topology_->outer_node_count + 2 * mesh_->springs.size() + 3 * topology_->face_count + 4 * tetrahedron_count;
  positions_.resize(vertex_bound);
  rest_positions_.resize(vertex_bound);
  carriers_.resize(vertex_bound);
  masks_.resize(tetrahedron_count);
  slot_vertices_.resize(topology_->slot_count);
  skin_normal_slots_.resize(6 * outer_face_count);
  normal_sums_.resize(topology_->normal_slot_count);
}

void SurfaceExtractor::extract(std::span<const std::uint8_t> intact,
                               std::span<const std::uint32_t> node_fragments) noexcept {
  triangle_count_ = vertex_count_ = 0;
  std::fill(slot_vertices_.begin(), slot_vertices_.end(), kNoVertex);
  rotations_->start(intact);
  for (std::size_t t = 0; t < masks_.size(); ++t) masks_[t] = cut_mask(topology_->cells[t].springs, intact);
  extract_skin(node_fragments);
  extract_interior(node_fragments);
  rotations_->forget_unused();
}

void SurfaceExtractor::extract_skin(std::span<const std::uint32_t> node_fragments) noexcept {
  for (const auto& [tetrahedron, face, first_normal_slots] : topology_->outer_faces) {
    const auto& patterns = kPatterns[masks_[tetrahedron]];
    for (std::size_t i = 0; i < patterns.skin_count[face]; ++i) {
      auto& normal_slots = skin_normal_slots_[triangle_count_];
      const auto codes = add_triangle(tetrahedron, patterns.skin[face][i], node_fragments);
      for (std::size_t k = 0; k < 3; ++k) normal_slots[k] = first_normal_slots[site_of(codes[k])] + copy_of(codes[k]);
    }
  }
  skin_triangle_count_ = triangle_count_;
}

void SurfaceExtractor::extract_interior(std::span<const std::uint32_t> node_fragments) noexcept {
  for (std::uint32_t t = 0; t < masks_.size(); ++t) {
    const auto& patterns = kPatterns[masks_[t]];
    for (std::size_t i = 0; i < patterns.interior_count; ++i) add_triangle(t, patterns.interior[i], node_fragments);
  }
}

// Returns the triangle's vertex codes in the order in which it was added.
std::array<VertexCode, 3> SurfaceExtractor::add_triangle(std::uint32_t tetrahedron, const PatternTriangle& pattern,
                                                         std::span<const std::uint32_t> node_fragments) noexcept {
  const SurfaceTopology::Cell& cell = topology_->cells[tetrahedron];
  auto codes = pattern.vertices;
  if (cell.flipped) std::swap(codes[1], codes[2]);
  Triangle& triangle = triangles_[triangle_count_];
  for (std::size_t k = 0; k < 3; ++k) {
    std::uint32_t& vertex = slot_vertices_[cell.first_slots[site_of(codes[k])] + copy_of(codes[k])];
    if (vertex == kNoVertex) vertex = add_vertex(tetrahedron, codes[k]);
    triangle[k] = vertex;
  }
  fragments_[triangle_count_] = node_fragments[cell.nodes[pattern.owner]];
  tetrahedra_[triangle_count_] = tetrahedron;
  ++triangle_count_;
  return codes;
}

std::uint32_t SurfaceExtractor::add_vertex(std::uint32_t tetrahedron, VertexCode code) noexcept {
  const Tetrahedron& nodes = topology_->cells[tetrahedron].nodes;
  const unsigned site_corners = surface_patterns::kSiteCorners[site_of(code)];
  const unsigned carrying_corners = kPatterns[masks_[tetrahedron]].carriers[code];
  Carriers& carriers = carriers_[vertex_count_];
  carriers.count = 0;
  Vec3 sum = Vec3::Zero();
  for (std::size_t corner = 0; corner < 4; ++corner) {
    if ((site_corners >> corner & 1u) != 0) sum += mesh_->positions[nodes[corner]];
    if ((carrying_corners >> corner & 1u) != 0) {
      carriers.nodes[carriers.count++] = nodes[corner];
      if (site_of(code) < surface_patterns::kCorners) rotations_->use(nodes[corner]);
    }
  }
  rest_positions_[vertex_count_] = sum / std::popcount(site_corners);
  return static_cast<std::uint32_t>(vertex_count_++);
}

void SurfaceExtractor::update(VecView positions) noexcept {
  rotations_->fit(positions);
  for (std::size_t v = 0; v < vertex_count_; ++v) {
    const auto& [nodes, count] = carriers_[v];
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = 0; k < count; ++k) {
      const Vec3 offset = rest_positions_[v] - mesh_->positions[nodes[k]];
      sum += positions[nodes[k]] + (*rotations_)[nodes[k]] * offset;
    }
    positions_[v] = sum / count;
  }
  update_skin_normals();
  update_interior_normals();
}

Vec3 SurfaceExtractor::area_vector(std::size_t triangle) const noexcept {
  const auto [a, b, c] = triangles_[triangle];
  return cross(positions_[b] - positions_[a], positions_[c] - positions_[a]);
}

void SurfaceExtractor::update_skin_normals() noexcept {
  std::fill(normal_sums_.begin(), normal_sums_.end(), Vec3::Zero());
  for (std::size_t t = 0; t < skin_triangle_count_; ++t) {
    const Vec3 area = area_vector(t);
    for (const std::uint32_t slot : skin_normal_slots_[t]) normal_sums_[slot] += area;
  }
  for (std::size_t t = 0; t < skin_triangle_count_; ++t) {
    for (std::size_t k = 0; k < 3; ++k) corner_normals_[t][k] = unit(normal_sums_[skin_normal_slots_[t][k]]);
  }
}

void SurfaceExtractor::update_interior_normals() noexcept {
  for (std::size_t t = skin_triangle_count_; t < triangle_count_; t += 2) {
    const Eigen::Vector3f normal = unit(area_vector(t) + area_vector(t + 1));
    corner_normals_[t].fill(normal);
    corner_normals_[t + 1].fill(normal);
  }
}

}  // namespace crumble
