// Vertex slots: [nodes][two per spring][three per face][four per tetrahedron].
//
// Skin normals are summed in slots too. All triangles of the skin that meet in a point add to one slot unless a crease
// or a crack parts them there. Cracks come by themselves, since the sides of a cut have different vertex copies, each
// with its own slot; creases are found here, at rest: outer faces are joined over every edge that is not a crease, and
// face corners at the same node that are joined, directly or around the node, share a slot.
#include "surface_topology.hpp"

#include <algorithm>
#include <numeric>

#include "crumble/base/memory.hpp"
#include "crumble/base/transcendental.hpp"

namespace crumble {
namespace {

using surface_patterns::kCenter;
using surface_patterns::kCorners;
using surface_patterns::kFaceCenters;
using surface_patterns::kMiddles;
using surface_patterns::kSiteCount;

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
  cell.outer_faces.fill(SurfaceTopology::kNone);
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

Vector<FaceUse> sorted_face_uses(const Vector<SurfaceTopology::Cell>& cells) {
  Vector<FaceUse> uses;
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

Vector<FaceSide> sorted_sides(const SurfaceTopology& topology) {
  Vector<FaceSide> sides;
  for (std::uint32_t f = 0; f < topology.outer_faces.size(); ++f) {
    const std::uint32_t tetrahedron = topology.outer_faces[f].tetrahedron, face = topology.outer_faces[f].face;
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
  Vector<std::uint32_t> parents;
};

// Copies that a site of an outer face can have; none for the tetrahedron's other sites.
std::uint32_t copy_count(std::size_t site, std::size_t face) {
  if ((surface_patterns::kSiteCorners[site] >> face & 1u) != 0) return 0;
  if (site < kFaceCenters) return 2;
  return site < kCenter ? 3 : 1;
}

Vec3 outward_normal(const TetMesh& mesh, const SurfaceTopology::Cell& cell, std::size_t face) {
  const auto corner = [&](std::size_t k) -> const Vec3& { return mesh.positions[cell.nodes[kTetFaces[face][k]]]; };
  const Vec3 normal = normalized(cross(corner(1) - corner(0), corner(2) - corner(0)));
  return cell.flipped ? Vec3(-normal) : normal;
}

// The boundary's triangles with their corners ascending, sorted, each with its index.
Vector<std::pair<Triangle, std::uint32_t>> sorted_boundary(const TetMesh& mesh) {
  Vector<std::pair<Triangle, std::uint32_t>> sorted;
  for (std::uint32_t b = 0; b < mesh.boundary.size(); ++b) {
    Triangle nodes = mesh.boundary[b];
    std::sort(nodes.begin(), nodes.end());
    sorted.push_back({nodes, b});
  }
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

SurfaceTopology::OuterFace make_outer_face(const FaceUse& use, const Tetrahedron& nodes, const Triangle& boundary) {
  SurfaceTopology::OuterFace outer{};
  outer.tetrahedron = use.tetrahedron;
  outer.face = use.face;
  for (std::size_t c = 0; c < 4; ++c) {
    for (std::uint8_t k = 0; k < 3; ++k) {
      if (boundary[k] == nodes[c]) outer.boundary_corners[c] = k;
    }
  }
  return outer;
}

// `items_of(t)` are the items of tetrahedron t.
template <class ItemsOf>
TetrahedronLists list_tetrahedra(std::size_t item_count, std::size_t tetrahedron_count, ItemsOf&& items_of) {
  TetrahedronLists lists;
  lists.first.assign(item_count + 1, 0);
  for (std::uint32_t t = 0; t < tetrahedron_count; ++t) {
    for (const std::uint32_t item : items_of(t)) ++lists.first[item + 1];
  }
  std::partial_sum(lists.first.begin(), lists.first.end(), lists.first.begin());
  lists.tetrahedra.resize(lists.first.back());
  Vector<std::uint32_t> next(lists.first.begin(), lists.first.end() - 1);
  for (std::uint32_t t = 0; t < tetrahedron_count; ++t) {
    for (const std::uint32_t item : items_of(t)) lists.tetrahedra[next[item]++] = t;
  }
  return lists;
}

}  // namespace

SurfaceTopology::SurfaceTopology(const TetMesh& mesh, double crease) {
  cells.reserve(mesh.tetrahedra.size());
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) cells.push_back(sorted_cell(mesh, t));
  const auto nodes_of = [&](std::size_t t) -> const auto& {
    return cells[t].nodes;
  };
  const auto springs_of = [&](std::size_t t) -> const auto& {
    return cells[t].springs;
  };
  node_tetrahedra = list_tetrahedra(mesh.node_count(), cells.size(), nodes_of);
  spring_tetrahedra = list_tetrahedra(mesh.springs.size(), cells.size(), springs_of);
  find_faces(mesh);
  number_slots(mesh);
  share_normals(mesh, crease);
}

// Outer faces come in the order of the sorted boundary, so each finds its triangle there next.
void SurfaceTopology::find_faces(const TetMesh& mesh) {
  const Vector<FaceUse> uses = sorted_face_uses(cells);
  const auto boundary = sorted_boundary(mesh);
  auto outer = boundary.begin();
  outer_faces.resize(boundary.size());
  for (std::size_t i = 0; i < uses.size();) {
    const bool shared = i + 1 < uses.size() && uses[i].nodes == uses[i + 1].nodes;
    const FaceUse &use = uses[i], &other = uses[shared ? i + 1 : i];
    i += shared ? 2 : 1;
    for (const FaceUse* side : {&use, &other}) {  // the face's number for now; number_slots() makes it a slot
      cells[side->tetrahedron].first_slots[kFaceCenters + side->face] = static_cast<std::uint32_t>(face_count);
    }
    face_tetrahedra_.push_back({use.tetrahedron, other.tetrahedron});
    ++face_count;
    if (shared) continue;
    cells[use.tetrahedron].outer_faces[use.face] = outer->second;
    outer_faces[outer->second] = make_outer_face(use, cells[use.tetrahedron].nodes, mesh.boundary[outer->second]);
    ++outer;
  }
  Vector<std::uint8_t> is_outer(mesh.node_count());
  for (const Triangle& t : mesh.boundary) is_outer[t[0]] = is_outer[t[1]] = is_outer[t[2]] = 1;
  outer_node_count = static_cast<std::size_t>(std::count(is_outer.begin(), is_outer.end(), 1));
}

void SurfaceTopology::number_slots(const TetMesh& mesh) {
  first_middle_slot_ = static_cast<std::uint32_t>(mesh.node_count());
  first_face_slot_ = static_cast<std::uint32_t>(first_middle_slot_ + 2 * mesh.springs.size());
  first_center_slot_ = static_cast<std::uint32_t>(first_face_slot_ + 3 * face_count);
  slot_count = first_center_slot_ + 4 * cells.size();
  own_tetrahedron_.resize(cells.size());
  std::iota(own_tetrahedron_.begin(), own_tetrahedron_.end(), 0u);
  for (std::uint32_t t = 0; t < cells.size(); ++t) {
    Cell& cell = cells[t];
    for (std::size_t s = 0; s < 6; ++s) cell.first_slots[kMiddles + s] = first_middle_slot_ + 2 * cell.springs[s];
    for (std::size_t f = 0; f < 4; ++f) {
      std::uint32_t& slot = cell.first_slots[kFaceCenters + f];
      slot = first_face_slot_ + 3 * slot;
    }
    cell.first_slots[kCenter] = first_center_slot_ + 4 * t;
    for (std::size_t c = 0; c < 4; ++c) cell.first_slots[kCorners + c] = cell.nodes[c];
  }
}

std::span<const std::uint32_t> SurfaceTopology::users(std::uint32_t slot) const noexcept {
  if (slot < first_middle_slot_) return node_tetrahedra[slot];
  if (slot < first_face_slot_) return spring_tetrahedra[(slot - first_middle_slot_) / 2];
  if (slot < first_center_slot_) {
    const auto& sides = face_tetrahedra_[(slot - first_face_slot_) / 3];
    return std::span(sides).first(sides[0] == sides[1] ? 1 : 2);
  }
  return std::span(own_tetrahedron_).subspan((slot - first_center_slot_) / 4, 1);
}

// Joins the sides that share a spring, but for creases: their corners, and the two copies of their middle, end by end.
void SurfaceTopology::share_normals(const TetMesh& mesh, double crease) {
  const auto key = [](std::uint32_t outer_face, std::size_t site) {
    return static_cast<std::uint32_t>(outer_face * kSiteCount + site);
  };
  const double least_cosine = cos_exact(crease);
  DisjointSets shared(outer_faces.size() * kSiteCount);
  const Vector<FaceSide> sides = sorted_sides(*this);
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    const FaceSide &left = sides[i], &right = sides[i + 1];
    if (left.spring != right.spring) continue;
    const OuterFace &f = outer_faces[left.outer_face], &g = outer_faces[right.outer_face];
    const double cosine =
        dot(outward_normal(mesh, cells[f.tetrahedron], f.face), outward_normal(mesh, cells[g.tetrahedron], g.face));
    if (cosine < least_cosine) continue;
    shared.join(key(left.outer_face, kMiddles + left.site), key(right.outer_face, kMiddles + right.site));
    for (std::size_t end = 0; end < 2; ++end) {
      shared.join(key(left.outer_face, kCorners + kTetEdges[left.site][end]),
                  key(right.outer_face, kCorners + kTetEdges[right.site][end]));
    }
  }
  // A set is met first at its root, the least key.
  Vector<std::uint32_t> first_slot_of(outer_faces.size() * kSiteCount);
  for (std::uint32_t f = 0; f < outer_faces.size(); ++f) {
    for (std::size_t site = 0; site < kSiteCount; ++site) {
      const std::uint32_t root = shared.root(key(f, site));
      if (root == key(f, site)) {
        first_slot_of[root] = static_cast<std::uint32_t>(normal_slot_count);
        normal_slot_count += copy_count(site, outer_faces[f].face);
      }
      outer_faces[f].first_normal_slots[site] = first_slot_of[root];
    }
  }
}

}  // namespace crumble
