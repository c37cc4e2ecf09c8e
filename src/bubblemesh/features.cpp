#include "bubblemesh/features.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "crumble/base/memory.hpp"

namespace crumble {

Vector<CreaseEdge> place_features(const Shape& shape, double spacing, const Vector<int>& extra_pieces, Cloud& cloud) {
  for (const Vec3& corner : shape.corners()) cloud.add(corner, NodeKind::corner);
  Vector<CreaseEdge> edges;
  for (std::size_t c = 0; c < shape.creases().size(); ++c) {
    const Crease& crease = shape.creases()[c];
    const int natural = static_cast<int>(std::floor(crease.length / spacing + 0.5));
    const int pieces = std::max(crease.closed ? 3 : 1, natural) + extra_pieces[c];
    const auto first = static_cast<std::uint32_t>(cloud.size());
    for (int i = crease.closed ? 0 : 1; i < pieces; ++i)
      cloud.add(crease.at(crease.length * i / pieces), NodeKind::crease);
    Vector<std::uint32_t> chain(cloud.size() - first);
    std::iota(chain.begin(), chain.end(), first);
    chain.insert(chain.begin(), crease.closed ? chain.back() : crease.first_corner);
    if (!crease.closed) chain.push_back(crease.last_corner);
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
      edges.push_back({{std::min(chain[i], chain[i + 1]), std::max(chain[i], chain[i + 1])}, c});
    }
  }
  return edges;
}

}  // namespace crumble
