#include "crumble/tetmesh/tet_mesh.hpp"

#include <algorithm>
#include <numeric>
#include <string>

#include "crumble/base/error.hpp"

namespace crumble {
namespace {

std::string tet_name(std::size_t t) {
  return "tetrahedron " + std::to_string(t);
}

void check_positions(const std::vector<Vec3>& positions) {
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!is_finite(positions[i]))
      throw Error(Code::invalid_value, "position of node " + std::to_string(i) + " is not finite");
  }
  std::vector<std::uint32_t> order(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t i) { return std::array{positions[i].x(), positions[i].y(), positions[i].z()}; };
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (key(order[i - 1]) == key(order[i])) {
      throw Error(Code::duplicate_node, "nodes " + std::to_string(order[i - 1]) + " and " + std::to_string(order[i]) +
                                            " have the same position");
    }
  }
}

void check_tetrahedra(const TetMesh& mesh) {
  std::vector<std::uint8_t> used(mesh.node_count(), 0);
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

void derive_springs(TetMesh& mesh) {
  for (const Tetrahedron& t : mesh.tetrahedra) {
    for (const auto& [i, j] : kTetEdges) mesh.springs.push_back({std::min(t[i], t[j]), std::max(t[i], t[j])});
  }
  std::sort(mesh.springs.begin(), mesh.springs.end());
  mesh.springs.erase(std::unique(mesh.springs.begin(), mesh.springs.end()), mesh.springs.end());
  for (const Tetrahedron& t : mesh.tetrahedra) {
    std::array<std::uint32_t, 6> ids{};
    for (std::size_t e = 0; e < 6; ++e) {
      const std::uint32_t i = t[kTetEdges[e][0]], j = t[kTetEdges[e][1]];
      const Edge edge{std::min(i, j), std::max(i, j)};
      ids[e] = static_cast<std::uint32_t>(std::lower_bound(mesh.springs.begin(), mesh.springs.end(), edge) -
                                          mesh.springs.begin());
    }
    mesh.tet_springs.push_back(ids);
  }
}

void derive_boundary(TetMesh& mesh) {
  struct Face {
    Triangle sorted, outward;
    std::size_t tetrahedron;
  };
  std::vector<Face> faces;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    for (const auto& [a, b, c] : kTetFaces) {
      const Tetrahedron& tet = mesh.tetrahedra[t];
      Face face{{tet[a], tet[b], tet[c]}, {tet[a], tet[b], tet[c]}, t};
      std::sort(face.sorted.begin(), face.sorted.end());
      faces.push_back(face);
    }
  }
  std::stable_sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.sorted < b.sorted; });
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t end = i + 1;
    while (end < faces.size() && faces[end].sorted == faces[i].sorted) ++end;
    if (end - i > 2) {
      throw Error(Code::mesh,
                  "a face of " + tet_name(faces[i].tetrahedron) + " has " + std::to_string(end - i) + " tetrahedra");
    }
    if (end - i == 1) mesh.boundary.push_back(faces[i].outward);
    i = end;
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

TetMesh make_tet_mesh(std::vector<Vec3> positions, std::vector<Tetrahedron> tetrahedra, std::vector<NodeKind> kinds) {
  if (positions.empty()) throw Error(Code::empty, "mesh has no nodes");
  if (tetrahedra.empty()) throw Error(Code::empty, "mesh has no tetrahedra");
  if (positions.size() > 0x7fffffff || tetrahedra.size() > 0x7fffffff)
    throw Error(Code::too_large, "mesh has more than 2^31 nodes or tetrahedra");
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
