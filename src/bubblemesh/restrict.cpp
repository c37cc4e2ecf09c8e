#include "bubblemesh/restrict.hpp"

#include <algorithm>

#include "bubblemesh/measures.hpp"

namespace crumble {
namespace {

// Four surface nodes that make a flat tetrahedron just under the surface belong to the surface.
constexpr double kSkinDepth = 0.1;  // in units of d
constexpr double kFlat = 0.25;       // volume-length measure

bool fills(const Shape& shape, double spacing, const Cloud& cloud, const Tetrahedron& t) {
  const auto on_surface = [&](std::uint32_t v) { return cloud.kinds[v] != NodeKind::inside; };
  const auto count = std::ranges::count_if(t, on_surface);
  if (count < 3) return true;
  const Vec3 &a = cloud.positions[t[0]], &b = cloud.positions[t[1]], &c = cloud.positions[t[2]],
             &d = cloud.positions[t[3]];
  const double distance = shape.signed_distance(0.25 * ((a + b) + (c + d)));
  if (count == 3) return distance <= 0;
  const double quality = volume_length(a, b, c, d);
  return distance < 0 && quality > 0 && (distance <= -kSkinDepth * spacing || quality >= kFlat);
}

}  // namespace

void restrict_to_shape(const Shape& shape, double spacing, const Cloud& cloud, std::vector<Tetrahedron>& tetrahedra) {
  std::erase_if(tetrahedra, [&](const Tetrahedron& t) { return !fills(shape, spacing, cloud, t); });
}

}  // namespace crumble
