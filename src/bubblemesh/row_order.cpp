#include "bubblemesh/row_order.hpp"

#include <algorithm>
#include <tuple>

#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

/// The even permutation of t that begins with its two least nodes.
Tetrahedron canonical(Tetrahedron t) {
  bool odd = false;
  const auto exchange = [&](int i, int j) {
    std::swap(t[i], t[j]);
    odd = !odd;
  };
  for (int i = 0; i < 3; ++i) {
    for (int j = i + 1; j < 4; ++j) {
      if (t[j] < t[i]) exchange(i, j);
    }
  }
  if (odd) std::swap(t[2], t[3]);
  return t;
}

void add_node(std::int32_t layer, std::int32_t row, std::int32_t place, BubbleMesh& body) {
  const auto node = static_cast<std::uint32_t>(body.places.size());
  const bool same = node > 0 && body.rows.back().layer == layer && body.rows.back().row == row;
  if (!same) body.rows.push_back({layer, row, node, 0});
  ++body.rows.back().count;
  body.places.push_back(place);
}

}  // namespace

void put_in_row_order(const LatticeFrame& frame, Cloud& cloud, Vector<Tetrahedron>& tetrahedra) {
  struct Key {
    std::int64_t layer, row;
    double x;
    std::uint32_t node;
  };
  Vector<Key> keys;
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    const Vec3& p = cloud.positions[i];
    const std::int64_t layer = frame.nearest_layer(p);
    keys.push_back({layer, frame.nearest_row(p, layer), p.x(), i});
  }
  std::ranges::sort(keys, {}, [](const Key& key) { return std::tuple(key.layer, key.row, key.x, key.node); });
  Cloud sorted;
  Vector<std::uint32_t> new_index(cloud.size());
  for (const Key& key : keys) {
    new_index[key.node] = static_cast<std::uint32_t>(sorted.size());
    sorted.add(cloud.positions[key.node], cloud.kinds[key.node], cloud.normals[key.node]);
  }
  cloud = std::move(sorted);
  for (Tetrahedron& t : tetrahedra) {
    for (std::uint32_t& v : t) v = new_index[v];
  }
  sort_tetrahedra(tetrahedra);
}

void sort_tetrahedra(Vector<Tetrahedron>& tetrahedra) {
  for (Tetrahedron& t : tetrahedra) t = canonical(t);
  std::ranges::sort(tetrahedra);
}

void describe_rows(const LatticeFrame& frame, BubbleMesh& body) {
  Vector<char> on_lattice;
  for (const Vec3& p : body.mesh.positions) {
    const std::int64_t layer = frame.nearest_layer(p), row = frame.nearest_row(p, layer);
    const std::int64_t place = frame.nearest_place(p, row, layer);
    add_node(static_cast<std::int32_t>(layer), static_cast<std::int32_t>(row), static_cast<std::int32_t>(place), body);
    on_lattice.push_back(frame.point(place, row, layer) == p);
  }
  for (const auto& [i, j] : body.mesh.springs) {
    const Vec3 step = body.mesh.positions[j] - body.mesh.positions[i];
    body.lattice_neighbours.push_back(on_lattice[i] && on_lattice[j] && frame.is_neighbour_step(step));
  }
}

void describe_rows(const Vector<Site>& sites, BubbleMesh& body) {
  for (const Site& site : sites) add_node(site.layer, site.row, site.place, body);
  for (const auto& [i, j] : body.mesh.springs)
    body.lattice_neighbours.push_back(are_lattice_neighbours(sites[i], sites[j]));
}

double share_in_runs(const TetMesh& mesh, std::size_t least) {
  struct Step {
    std::uint32_t offset, first;
    auto operator<=>(const Step&) const = default;
  };
  Vector<Step> steps;
  for (const auto& [i, j] : mesh.springs) steps.push_back({j - i, i});
  std::ranges::sort(steps);
  std::size_t in_runs = 0;
  for (std::size_t begin = 0; begin < steps.size();) {
    std::size_t end = begin + 1;
    while (end < steps.size() && steps[end] == Step{steps[begin].offset, steps[end - 1].first + 1}) ++end;
    if (end - begin >= least) in_runs += end - begin;
    begin = end;
  }
  return static_cast<double>(in_runs) / static_cast<double>(steps.size());
}

}  // namespace crumble
