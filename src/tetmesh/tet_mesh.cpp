#include "crumble/tetmesh/tet_mesh.hpp"

#include <algorithm>
#include <bit>
#include <numeric>
#include <string>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

std::string tet_name(std::size_t t) {
  return "tetrahedron " + std::to_string(t);
}

/// Finds the node that stands at a place already, by open addressing; a node's slot is never asked for in order.
class PlaceTable {
 public:
  explicit PlaceTable(const Vector<Vec3>& positions)
      : positions_(positions), slots_(std::bit_ceil(2 * positions.size()), kFree) {}

  /// The node at the place of node i; i itself, which is put in, when there is none.
  std::uint32_t insert(std::uint32_t i) {
    std::size_t at = hash(positions_[i]) & (slots_.size() - 1);
    while (slots_[at] != kFree && positions_[slots_[at]] != positions_[i]) at = (at + 1) & (slots_.size() - 1);
    if (slots_[at] == kFree) slots_[at] = i;
    return slots_[at];
  }

 private:
  static constexpr std::uint32_t kFree = 0xffffffffu;
  static std::uint64_t hash(const Vec3& p) {
    std::uint64_t h = 0;
    for (int axis = 0; axis < 3; ++axis) {
      h ^= std::bit_cast<std::uint64_t>(p[axis] + 0.0);  // -0 and 0 are one place
      h = (h ^ h >> 32) * 0x9e3779b97f4a7c15u;
    }
    return h ^ h >> 32;
  }

  const Vector<Vec3>& positions_;
  Vector<std::uint32_t> slots_;
};

void check_positions(const Vector<Vec3>& positions) {
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!is_finite(positions[i]))
      throw Error(Code::invalid_value, "position of node " + std::to_string(i) + " is not finite");
  }
  PlaceTable places(positions);
  for (std::uint32_t i = 0; i < positions.size(); ++i) {
    const std::uint32_t other = places.insert(i);
    if (other == i) continue;
    throw Error(Code::duplicate_node,
                "nodes " + std::to_string(other) + " and " + std::to_string(i) + " have the same position");
  }
}

void check_tetrahedra(const TetMesh& mesh) {
  Vector<std::uint8_t> used(mesh.node_count(), 0);
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    for (const std::uint32_t node : mesh.tetrahedra[t]) {
      if (node >= mesh.node_count()) {
        throw Error(Code::mesh,
                    tet_name(t) + " names node " + std::to_string(node) + " of " + std::to_string(mesh.node_count()));
      }
      used[node] = 1;
    }
    const auto& [a, b, c, d] = mesh.tetrahedra[t];
    if (!(orient(mesh.positions[a], mesh.positions[b], mesh.positions[c], mesh.positions[d]) > 0)) {
      throw Error(Code::mesh, tet_name(t) + " is flat or inverted");
    }
  }
  const auto lonely = std::find(used.begin(), used.end(), 0);
  if (lonely != used.end()) {
    throw Error(Code::isolated_node, "node " + std::to_string(lonely - used.begin()) + " belongs to no tetrahedron");
  }
}

/// Numbers in buckets, one after the other: bucket b is values[starts[b] .. starts[b + 1]).
struct Buckets {
  Vector<std::size_t> starts;
  Vector<std::uint32_t> values;
  std::span<std::uint32_t> operator[](std::size_t b) {
    return std::span(values).subspan(starts[b], starts[b + 1] - starts[b]);
  }
};

/// Counting sort. visit_all(visit) has to call visit(bucket, value) for everything, twice alike.
template <class VisitAll>
Buckets sort_into_buckets(std::size_t count, VisitAll visit_all) {
  Buckets buckets;
  buckets.starts.assign(count + 2, 0);  // shifted by one, so that filling moves each to its place
  visit_all([&](std::uint32_t bucket, std::uint32_t) { ++buckets.starts[bucket + 2]; });
  std::partial_sum(buckets.starts.begin(), buckets.starts.end(), buckets.starts.begin());
  buckets.values.resize(buckets.starts.back());
  visit_all([&](std::uint32_t bucket, std::uint32_t value) { buckets.values[buckets.starts[bucket + 1]++] = value; });
  buckets.starts.pop_back();
  return buckets;
}

void derive_springs(TetMesh& mesh) {
  Buckets ends = sort_into_buckets(mesh.node_count(), [&](auto visit) {
    for (const Tetrahedron& t : mesh.tetrahedra) {
      for (const auto& [i, j] : kTetEdges) visit(std::min(t[i], t[j]), std::max(t[i], t[j]));
    }
  });
  Vector<std::uint32_t> first(mesh.node_count() + 1, 0);  // spring of each node
  for (std::uint32_t node = 0; node < mesh.node_count(); ++node) {
    const auto all = ends[node];
    std::ranges::sort(all);
    const auto last = std::unique(all.begin(), all.end());
    for (auto end = all.begin(); end != last; ++end) mesh.springs.push_back({node, *end});
    first[node + 1] = static_cast<std::uint32_t>(mesh.springs.size());
  }
  const auto spring_of = [&](std::uint32_t i, std::uint32_t j) {
    const auto begin = mesh.springs.begin() + first[i], end = mesh.springs.begin() + first[i + 1];
    const auto far = std::ranges::lower_bound(begin, end, j, {}, [](const Edge& edge) { return edge[1]; });
    return static_cast<std::uint32_t>(far - mesh.springs.begin());
  };
  mesh.tet_springs.resize(mesh.tetrahedra.size());
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    for (std::size_t e = 0; e < 6; ++e) {
      const std::uint32_t i = mesh.tetrahedra[t][kTetEdges[e][0]], j = mesh.tetrahedra[t][kTetEdges[e][1]];
      mesh.tet_springs[t][e] = spring_of(std::min(i, j), std::max(i, j));
    }
  }
}

/// Faces are numbered 4 tetrahedron + local face, and sorted by their nodes: bucketed by the least, the rest in place.
void derive_boundary(TetMesh& mesh) {
  const auto corners = [&](std::uint32_t face) -> Triangle {
    const Tetrahedron& tet = mesh.tetrahedra[face / 4];
    const auto& [a, b, c] = kTetFaces[face % 4];
    return {tet[a], tet[b], tet[c]};
  };
  Buckets by_least = sort_into_buckets(mesh.node_count(), [&](auto visit) {
    for (std::uint32_t face = 0; face < 4 * mesh.tetrahedra.size(); ++face)
      visit(std::ranges::min(corners(face)), face);
  });
  struct Face {
    std::uint64_t others;  // the two greater nodes
    std::uint32_t id;
    auto operator<=>(const Face&) const = default;
  };
  Vector<Face> faces;
  for (std::uint32_t node = 0; node < mesh.node_count(); ++node) {
    faces.clear();
    for (const std::uint32_t id : by_least[node]) {
      Triangle sorted = corners(id);
      std::ranges::sort(sorted);
      faces.push_back({std::uint64_t{sorted[1]} << 32 | sorted[2], id});
    }
    std::ranges::sort(faces);
    for (std::size_t i = 0; i < faces.size();) {
      std::size_t end = i + 1;
      while (end < faces.size() && faces[end].others == faces[i].others) ++end;
      if (end - i > 2) {
        throw Error(Code::mesh,
                    "a face of " + tet_name(faces[i].id / 4) + " has " + std::to_string(end - i) + " tetrahedra");
      }
      if (end - i == 1) mesh.boundary.push_back(corners(faces[i].id));
      i = end;
    }
  }
}

void derive_kinds(TetMesh& mesh) {
  if (!mesh.kinds.empty()) return;
  mesh.kinds.assign(mesh.node_count(), NodeKind::inside);
  for (const Triangle& face : mesh.boundary) {
    for (const std::uint32_t node : face) mesh.kinds[node] = NodeKind::surface;
  }
}

void derive_volumes(TetMesh& mesh) {
  mesh.node_volumes.assign(mesh.node_count(), 0);
  for (const auto& [a, b, c, d] : mesh.tetrahedra) {
    const double share = orient(mesh.positions[a], mesh.positions[b], mesh.positions[c], mesh.positions[d]) / 24;
    for (const std::uint32_t node : {a, b, c, d}) mesh.node_volumes[node] += share;
  }
}

}  // namespace

std::size_t TetMesh::surface_node_count() const {
  return node_count() - static_cast<std::size_t>(std::count(kinds.begin(), kinds.end(), NodeKind::inside));
}

TetMesh make_tet_mesh(Vector<Vec3> positions, Vector<Tetrahedron> tetrahedra, Vector<NodeKind> kinds) {
  if (positions.empty()) throw Error(Code::empty, "mesh has no nodes");
  if (tetrahedra.empty()) throw Error(Code::empty, "mesh has no tetrahedra");
  if (positions.size() > 0x7fffffff || tetrahedra.size() > 0x3fffffff)
    throw Error(Code::too_large, "mesh has more than 2^31 nodes or 2^30 tetrahedra");
  if (!kinds.empty() && kinds.size() != positions.size()) {
    throw Error(Code::out_of_range, "kinds has " + std::to_string(kinds.size()) + " entries for " +
                                        std::to_string(positions.size()) + " nodes");
  }
  TetMesh mesh;
  mesh.positions = std::move(positions);
  mesh.tetrahedra = std::move(tetrahedra);
  mesh.kinds = std::move(kinds);
  check_positions(mesh.positions);
  check_tetrahedra(mesh);
  derive_springs(mesh);
  derive_boundary(mesh);
  derive_kinds(mesh);
  derive_volumes(mesh);
  return mesh;
}

double volume(const TetMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c, d] : mesh.tetrahedra) {
    sum += orient(mesh.positions[a], mesh.positions[b], mesh.positions[c], mesh.positions[d]);
  }
  return sum / 6;
}

}  // namespace crumble
