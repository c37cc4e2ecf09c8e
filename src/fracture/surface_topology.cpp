// Vertex slots: [nodes][two per spring][three per face][four per tetrahedron].
//
// Skin normals are summed in slots too. All triangles of the skin that meet in a point add to one slot unless a crease
// or a crack parts them there. Cracks come by themselves, since the sides of a cut have different vertex copies, each
// with its own slot; creases are found here, at rest: outer faces are joined over every edge that is not a crease, and
// face corners at the same node that are joined, directly or around the node, share a slot.
#include "surface_topology.hpp"

#include <algorithm>
#include <numeric>

namespace crumble {
namespace {

using surface_patterns::kCenter;
using surface_patterns::kCorners;
using surface_patterns::kFaceCenters;
using surface_patterns::kMiddles;
using surface_patterns::kSiteCount;

constexpr double kCosCrease = 0.76604444311897804;  // of 40 degrees

SurfaceTopology::Cell sorted_cell(const TetMesh& mesh, std::size_t t) {
  const Tetrahedron& given = mesh.tetrahedra[t];
  std::array<std::size_t, 4> order{0, 1, 2, 3};
  bool flipped = false;
  for (std::size_t pass = 0; pass < 3; ++pass) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (given[order[k]] < given[order[k + 1]]) continue;
      std::swap(order[k], order[k + 1]);
      flipped = !flipped;
    }
  }
  SurfaceTopology::Cell cell{};
  cell.flipped = flipped;
  for (std::size_t k = 0; k < 4; ++k) cell.nodes[k] = given[order[k]];
  for (std::size_t s = 0; s < 6; ++s) {
    const std::size_t a = order[kTetEdges[s][0]], b = order[kTetEdges[s][1]];
    for (std::size_t from = 0; from < 6; ++from) {
      if (kTetEdges[from][0] == std::min(a, b) && kTetEdges[from][1] == std::max(a, b)) {
        cell.springs[s] = mesh.tet_springs[t][from];
      }
    }
  }
  return cell;
}

struct FaceUse {
  Triangle nodes;  // ascending
  std::uint32_t tetrahedron;
  std::uint8_t face;
  auto operator<=>(const FaceUse&) const = default;
};

std::vector<FaceUse> sorted_face_uses(const std::vector<SurfaceTopology::Cell>& cells) {
  std::vector<FaceUse> uses;
  uses.reserve(4 * cells.size());
  for (std::uint32_t t = 0; t < cells.size(); ++t) {
    const Tetrahedron& n = cells[t].nodes;
    uses.push_back({{n[1], n[2], n[3]}, t, 0});
    uses.push_back({{n[0], n[2], n[3]}, t, 1});
    uses.push_back({{n[0], n[1], n[3]}, t, 2});
    uses.push_back({{n[0], n[1], n[2]}, t, 3});
  }
  std::sort(uses.begin(), uses.end());
  return uses;
}

// A side of an outer face; `site` is the spring's number in the face's tetrahedron.
struct FaceSide {
  std::uint32_t spring;
  std::uint32_t outer_face;
  std::uint8_t site;
  auto operator<=>(const FaceSide&) const = default;
};

std::vector<FaceSide> sorted_sides(const SurfaceTopology& topology) {
  std::vector<FaceSide> sides;
  for (std::uint32_t f = 0; f < topology.outer_faces.size(); ++f) {
    const auto& [tetrahedron, face, slots] = topology.outer_faces[f];
    for (std::uint8_t s = 0; s < 6; ++s) {
      const auto [a, b] = kTetEdges[s];
      if (a != face && b != face) sides.push_back({topology.cells[tetrahedron].springs[s], f, s});
    }
  }
  std::sort(sides.begin(), sides.end());
  return sides;
}

// The root of a set is its least item.
struct DisjointSets {
  explicit DisjointSets(std::size_t size) : parents(size) { std::iota(parents.begin(), parents.end(), 0u); }
  std::uint32_t root(std::uint32_t item) {
    while (parents[item] != item) item = parents[item] = parents[parents[item]];
    return item;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a), b = root(b);
    parents[std::max(a, b)] = std::min(a, b);
  }
  std::vector<std::uint32_t> parents;
};

std::uint32_t copy_count(std::size_t site) {
  if (site < kFaceCenters) return 2;
  return site < kCenter ? 3 : 1;
}

Vec3 outward_normal(const TetMesh& mesh, const SurfaceTopology::Cell& cell, std::size_t face) {
  const auto corner = [&](std::size_t k) -> const Vec3& { return mesh.positions[cell.nodes[kTetFaces[face][k]]]; };
  const Vec3 normal = normalized(cross(corner(1) - corner(0), corner(2) - corner(0)));
  return cell.flipped ? Vec3(-normal) : normal;
}

}  // namespace

SurfaceTopology::SurfaceTopology(const TetMesh& mesh) {
  cells.reserve(mesh.tetrahedra.size());
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) cells.push_back(sorted_cell(mesh, t));
  find_faces(mesh);
  share_normals(mesh);
}

void SurfaceTopology::find_faces(const TetMesh& mesh) {
  const auto first_middle = static_cast<std::uint32_t>(mesh.node_count());
  const auto first_face = static_cast<std::uint32_t>(first_middle + 2 * mesh.springs.size());
  const std::vector<FaceUse> uses = sorted_face_uses(cells);
  for (std::size_t i = 0; i < uses.size(); ++face_count) {
    const bool shared = i + 1 < uses.size() && uses[i].nodes == uses[i + 1].nodes;
    for (const std::size_t end = i + (shared ? 2 : 1); i < end; ++i) {
      const std::uint32_t slot = static_cast<std::uint32_t>(first_face + 3 * face_count);
      cells[uses[i].tetrahedron].first_slots[kFaceCenters + uses[i].face] = slot;
      if (!shared) outer_faces.push_back({uses[i].tetrahedron, uses[i].face, {}});
    }
  }
  std::sort(outer_faces.begin(), outer_faces.end(), [](const OuterFace& a, const OuterFace& b) {
    return a.tetrahedron != b.tetrahedron ? a.tetrahedron < b.tetrahedron : a.face < b.face;
  });
  const auto first_center = static_cast<std::uint32_t>(first_face + 3 * face_count);
  for (std::uint32_t t = 0; t < cells.size(); ++t) {
    Cell& cell = cells[t];
    for (std::size_t s = 0; s < 6; ++s) cell.first_slots[kMiddles + s] = first_middle + 2 * cell.springs[s];
    cell.first_slots[kCenter] = first_center + 4 * t;
    for (std::size_t c = 0; c < 4; ++c) cell.first_slots[kCorners + c] = cell.nodes[c];
  }
  slot_count = first_center + 4 * cells.size();
  std::vector<std::uint8_t> is_outer(mesh.node_count());
  for (const Triangle& t : mesh.boundary) is_outer[t[0]] = is_outer[t[1]] = is_outer[t[2]] = 1;
  outer_node_count = static_cast<std::size_t>(std::count(is_outer.begin(), is_outer.end(), 1));
}

// Joins the sides that share a spring, but for creases: their corners, and the two copies of their middle, end by end.
void SurfaceTopology::share_normals(const TetMesh& mesh) {
  const auto key = [](std::uint32_t outer_face, std::size_t site) {
    return static_cast<std::uint32_t>(outer_face * kSiteCount + site);
  };
  DisjointSets shared(outer_faces.size() * kSiteCount);
  const std::vector<FaceSide> sides = sorted_sides(*this);
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    const FaceSide &left = sides[i], &right = sides[i + 1];
    if (left.spring != right.spring) continue;
    const OuterFace &f = outer_faces[left.outer_face], &g = outer_faces[right.outer_face];
    const double cosine =
        dot(outward_normal(mesh, cells[f.tetrahedron], f.face), outward_normal(mesh, cells[g.tetrahedron], g.face));
    if (cosine < kCosCrease) continue;
    shared.join(key(left.outer_face, kMiddles + left.site), key(right.outer_face, kMiddles + right.site));
    for (std::size_t end = 0; end < 2; ++end) {
      shared.join(key(left.outer_face, kCorners + kTetEdges[left.site][end]),
                  key(right.outer_face, kCorners + kTetEdges[right.site][end]));
    }
  }
  // A set is met first at its root, the least key.
  std::vector<std::uint32_t> first_slot_of(outer_faces.size() * kSiteCount);
  for (std::uint32_t f = 0; f < outer_faces.size(); ++f) {
    for (std::size_t site = 0; site < kSiteCount; ++site) {
      const std::uint32_t root = shared.root(key(f, site));
      if (root == key(f, site)) {
        first_slot_of[root] = static_cast<std::uint32_t>(normal_slot_count);
        normal_slot_count += copy_count(site);
      }
      outer_faces[f].first_normal_slots[site] = first_slot_of[root];
    }
  }
}

}  // namespace crumble
