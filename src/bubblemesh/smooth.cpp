#include "bubblemesh/smooth.hpp"

#include <array>
#include <limits>

#include "bubblemesh/measures.hpp"
#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

constexpr double kWidestSearch = 0.12;  // in units of d; small against any wall, so project() cannot jump through it
constexpr double kFinestSearch = 0.0075;
constexpr double kSameSurface = 0.82;  // cosine between the normals before and after a move

const std::array<Vec3, 14>& directions() {
  static const std::array<Vec3, 14> kDirections = [] {
    std::array<Vec3, 14> all;
    std::size_t count = 0;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double sign : {1.0, -1.0}) {
        all[count] = Vec3::Zero();
        all[count++][axis] = sign;
      }
    }
    const double s = std::sqrt(1.0 / 3);
    for (int bits = 0; bits < 8; ++bits) all[count++] = {bits & 1 ? s : -s, bits & 2 ? s : -s, bits & 4 ? s : -s};
    return all;
  }();
  return kDirections;
}

/// Puts `node` where it was wanted, for a surface node on the surface; false if that is another piece of the surface.
bool place(const Shape& shape, std::uint32_t node, const Vec3& wanted, Cloud& cloud) {
  if (cloud.kinds[node] == NodeKind::inside) {
    cloud.positions[node] = wanted;
    return true;
  }
  const SurfacePoint on = shape.project(wanted);
  if (dot(on.normal, cloud.normals[node]) < kSameSurface) return false;
  cloud.positions[node] = on.point;
  cloud.normals[node] = on.normal;
  return true;
}

/// Sum of 1 / q^2 over the star, infinite if one is not positive.
double badness(const Cloud& cloud, const TetComplex& tets, std::uint32_t node) {
  double sum = 0;
  for (const TetId t : tets.star(node)) {
    const double q = quality_of(cloud, volume_length, tets[t]);
    if (q <= 0) return std::numeric_limits<double>::infinity();
    sum += 1 / (q * q);
  }
  return sum;
}

/// Volume-weighted mean of the circumcentres at the node (Alliez, Cohen-Steiner, Yvinec and Desbrun 2005). The node
/// being a corner of each, V (c - x) has no division by the volume: flat tetrahedra do no harm.
Vec3 optimal_delaunay_place(const Cloud& cloud, const TetComplex& tets, std::uint32_t node) {
  const Vec3 x = cloud.positions[node];
  Vec3 sum = Vec3::Zero();
  double volume = 0;
  for (const TetId id : tets.star(node)) {
    const Tetrahedron& t = tets[id];
    const auto corner = static_cast<std::size_t>(std::ranges::find(t, node) - t.begin());
    const auto& f = kTetFaces[corner];  // seen from outside; from the node it turns the other way
    const Vec3 b = cloud.positions[t[f[0]]] - x, c = cloud.positions[t[f[1]]] - x, d = cloud.positions[t[f[2]]] - x;
    const Vec3 bc = cross(b, c);
    sum += (squared_norm(b) * cross(c, d) + squared_norm(c) * cross(d, b)) + squared_norm(d) * bc;
    volume += dot(bc, d);
  }
  return volume > 0 ? Vec3(x + 0.5 / volume * sum) : x;
}

/// Area-weighted mean of the centroids of the boundary faces at the node.
Vec3 face_centroid(const Cloud& cloud, const TetComplex& tets, std::uint32_t node) {
  Vec3 sum = Vec3::Zero();
  double total = 0;
  for (const TetId id : tets.star(node)) {
    const Tetrahedron& t = tets[id];
    for (int face = 0; face < 4; ++face) {
      if (t[face] == node || tets.across(id, face) != kNoTet) continue;
      const auto& f = kTetFaces[face];
      const Vec3 &a = cloud.positions[t[f[0]]], &b = cloud.positions[t[f[1]]], &c = cloud.positions[t[f[2]]];
      const double area = norm(cross(b - a, c - a));
      sum += area / 3 * ((a + b) + c);
      total += area;
    }
  }
  return total > 0 ? Vec3(sum / total) : cloud.positions[node];
}

/// Worst quality in the star; stops as soon as it is not above `floor`. `star` has the tetrahedron first that is worst
/// at the node's old place: most tries end there.
double worst_of(const Cloud& cloud, Measure measure, const TetComplex& tets, std::span<const TetId> star,
                double floor) {
  double worst = std::numeric_limits<double>::infinity();
  for (const TetId t : star) {
    worst = std::min(worst, quality_of(cloud, measure, tets[t]));
    if (worst <= floor) break;
  }
  return worst;
}

}  // namespace

bool search_place(const Shape& shape, double spacing, Measure measure, const TetComplex& tets, std::uint32_t node,
                  Cloud& cloud) {
  if (cloud.kinds[node] <= NodeKind::crease) return false;
  Vector<TetId> star(tets.star(node).begin(), tets.star(node).end());
  const auto worst = std::ranges::min_element(star, {}, [&](TetId t) { return quality_of(cloud, measure, tets[t]); });
  std::swap(star.front(), *worst);
  double best = quality_of(cloud, measure, tets[star.front()]);
  bool moved = false;
  for (double radius = kWidestSearch * spacing; radius > kFinestSearch * spacing;) {
    const Vec3 from = cloud.positions[node], from_normal = cloud.normals[node];
    Vec3 to = from, to_normal = from_normal;
    double reached = best;
    for (const Vec3& direction : directions()) {
      if (place(shape, node, from + radius * direction, cloud)) {
        const double value = worst_of(cloud, measure, tets, star, reached);
        if (value > reached) reached = value, to = cloud.positions[node], to_normal = cloud.normals[node];
      }
      cloud.positions[node] = from, cloud.normals[node] = from_normal;
    }
    if (reached <= best) {
      radius /= 2;
      continue;
    }
    best = reached, cloud.positions[node] = to, cloud.normals[node] = to_normal, moved = true;
  }
  return moved;
}

void even_out(const Shape& shape, const TetComplex& tets, const Vector<std::uint32_t>& nodes, Cloud& cloud) {
  for (const std::uint32_t node : nodes) {
    if (cloud.kinds[node] <= NodeKind::crease) continue;
    const Vec3 from = cloud.positions[node], from_normal = cloud.normals[node];
    const double before = badness(cloud, tets, node);
    const Vec3 wanted = cloud.kinds[node] == NodeKind::inside ? optimal_delaunay_place(cloud, tets, node)
                                                              : face_centroid(cloud, tets, node);
    if (!place(shape, node, wanted, cloud) || !(badness(cloud, tets, node) < before)) {
      cloud.positions[node] = from, cloud.normals[node] = from_normal;
    }
  }
}

}  // namespace crumble
