#include "bubblemesh/features.hpp"

#include <algorithm>
#include <cmath>

namespace crumble {

std::vector<Edge> place_features(const Shape& shape, double spacing, Cloud& cloud) {
  for (const Vec3& corner : shape.corners()) cloud.add(corner, NodeKind::corner);
  std::vector<Edge> edges;
  const auto join = [&](std::size_t a, std::size_t b) {
    edges.push_back({static_cast<std::uint32_t>(std::min(a, b)), static_cast<std::uint32_t>(std::max(a, b))});
  };
  for (const Crease& crease : shape.creases()) {
    const int pieces = std::max(crease.closed ? 3 : 1, static_cast<int>(std::floor(crease.length / spacing + 0.5)));
    const std::size_t first = cloud.size();
    for (int i = crease.closed ? 0 : 1; i < pieces; ++i) {
      cloud.add(crease.at(crease.length * i / pieces), NodeKind::crease);
      if (cloud.size() - 1 > first) join(cloud.size() - 2, cloud.size() - 1);
    }
    if (crease.closed) {
      join(cloud.size() - 1, first);
    } else if (pieces == 1) {
      join(crease.first_corner, crease.last_corner);
    } else {
      join(crease.first_corner, first);
      join(cloud.size() - 1, crease.last_corner);
    }
  }
  return edges;
}

}  // namespace crumble
