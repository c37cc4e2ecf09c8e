#include "bubblemesh/restrict.hpp"

#include <algorithm>

#include "bubblemesh/measures.hpp"
#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

// Four surface nodes may make a flat tetrahedron that only fills the sagitta between the surface and the triangles
// under it: to the mesh it is outside. Where the surface is curved it lies deeper than where sharp edges meet.
constexpr double kFlat = 0.25;                               // volume-length measure
constexpr double kSkinDepth = 0.03, kCurvedSkinDepth = 0.1;  // in units of d
constexpr double kSameSide = 0.3;  // cosine between the normals of one smooth piece of the surface

bool is_on_one_piece(const Shape& shape, const Cloud& cloud, const Tetrahedron& t, const Vec3& center) {
  const Vec3 normal = shape.project(center).normal;
  return std::ranges::all_of(t, [&](std::uint32_t v) {
    return cloud.kinds[v] != NodeKind::surface || dot(cloud.normals[v], normal) >= kSameSide;
  });
}

bool fills(const Shape& shape, double spacing, const Cloud& cloud, const Tetrahedron& t) {
  const auto on_surface = [&](std::uint32_t v) { return cloud.kinds[v] != NodeKind::inside; };
  const auto count = std::ranges::count_if(t, on_surface);
  if (count < 3) return true;
  const Vec3 &a = cloud.positions[t[0]], &b = cloud.positions[t[1]], &c = cloud.positions[t[2]],
             &d = cloud.positions[t[3]];
  const Vec3 center = 0.25 * ((a + b) + (c + d));
  const double distance = shape.signed_distance(center);
  if (count == 3) return distance <= 0;
  const double quality = volume_length(a, b, c, d);
  if (distance >= 0 || quality <= 0) return false;
  if (quality >= kFlat) return true;
  return distance <= -(is_on_one_piece(shape, cloud, t, center) ? kCurvedSkinDepth : kSkinDepth) * spacing;
}

}  // namespace

void restrict_to_shape(const Shape& shape, double spacing, const Cloud& cloud, Vector<Tetrahedron>& tetrahedra) {
  std::erase_if(tetrahedra, [&](const Tetrahedron& t) { return !fills(shape, spacing, cloud, t); });
}

}  // namespace crumble
