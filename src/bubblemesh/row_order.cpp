#include "bubblemesh/row_order.hpp"

#include <algorithm>
#include <tuple>

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

}  // namespace

void put_in_row_order(const LatticeFrame& frame, Cloud& cloud, std::vector<Tetrahedron>& tetrahedra) {
  struct Key {
    std::int64_t layer, row;
    double x;
    std::uint32_t node;
  };
  std::vector<Key> keys;
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    const Vec3& p = cloud.positions[i];
    const std::int64_t layer = frame.nearest_layer(p);
    keys.push_back({layer, frame.nearest_row(p, layer), p.x(), i});
  }
  std::ranges::sort(keys, {}, [](const Key& key) { return std::tuple(key.layer, key.row, key.x, key.node); });
  Cloud sorted;
  std::vector<std::uint32_t> new_index(cloud.size());
  for (const Key& key : keys) {
    new_index[key.node] = static_cast<std::uint32_t>(sorted.size());
    sorted.add(cloud.positions[key.node], cloud.kinds[key.node], cloud.normals[key.node]);
  }
  cloud = std::move(sorted);
  for (Tetrahedron& t : tetrahedra) {
    for (std::uint32_t& v : t) v = new_index[v];
    t = canonical(t);
  }
  std::ranges::sort(tetrahedra);
}

}  // namespace crumble
