#include "bubblemesh/populate.hpp"

#include <algorithm>

#include "bubblemesh/exact_count.hpp"
#include "bubblemesh/neighbour_grid.hpp"
#include "bubblemesh/relax.hpp"
#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

constexpr double kSurfaceDepth = 1.7 / 4.4;  // all lengths here in units of d
constexpr double kTooClose = 0.62;           // of two bubbles this near, one goes
constexpr double kTooCloseInside = 0.45;     // the same for a bubble inside and one on the surface
constexpr double kSurfaceGap = 0.74;         // a place this far from all bubbles gets one
constexpr double kInsideGap = 0.82;
constexpr std::size_t kSmallBody = 5000;  // nodes; below, time is no matter

struct Effort {
  int rounds, iterations;
};
Effort effort(std::size_t nodes) {
  return nodes < kSmallBody ? Effort{6, 120} : Effort{3, 20};
}

NeighbourGrid make_grid(const Shape& shape, double spacing) {
  return {shape.lower(), shape.upper(), spacing};
}

/// Keeps every node of [first, size) that is far enough from all kept before it.
bool thin_out(const Shape& shape, double spacing, std::size_t first, Cloud& cloud) {
  const double near_surface = (first < cloud.surface_count ? kTooClose : kTooCloseInside) * spacing;
  NeighbourGrid fixed = make_grid(shape, spacing), kept = make_grid(shape, spacing);
  Vector<char> keep(cloud.size(), 1);
  bool changed = false;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3& p = cloud.positions[i];
    if (i >= first) keep[i] = fixed.is_free(p, near_surface) && kept.is_free(p, kTooClose * spacing);
    if (keep[i]) (i < first ? fixed : kept).add(p, 0);
    changed |= !keep[i];
  }
  if (changed) cloud.select(keep);
  return changed;
}

bool fill_gaps(const Shape& shape, double spacing, double gap, NodeKind kind, const Vector<SurfacePoint>& places,
               Cloud& cloud) {
  NeighbourGrid grid = make_grid(shape, spacing);
  for (const Vec3& p : cloud.positions) grid.add(p, 0);
  bool changed = false;
  for (const SurfacePoint& place : places) {
    if (!grid.is_free(place.point, gap * spacing)) continue;
    grid.add(place.point, 0);
    cloud.add(place.point, kind, place.normal);
    changed = true;
  }
  return changed;
}

/// Points of a lattice `fineness` times as fine, at depths [least, greatest] d.
template <class Visit>
void for_each_fine_point(const Shape& shape, double spacing, double fineness, double least, double greatest,
                         Visit visit) {
  const LatticeFrame fine(Lattice::fcc, 0.5 * (shape.lower() + shape.upper()), spacing / fineness);
  const Vec3 margin = Vec3::Constant(std::max(0.0, -least) * spacing);
  fine.for_each_in(shape.lower() - margin, shape.upper() + margin, [&](const Vec3& p) {
    const double depth = -shape.signed_distance(p) / spacing;
    if (depth >= least && depth <= greatest) visit(p);
  });
}

// Finer than inside: next to the small cap of a thin cylinder half a spacing was too coarse to hit the gap.
Vector<SurfacePoint> surface_places(const Shape& shape, double spacing) {
  Vector<SurfacePoint> places;
  for_each_fine_point(shape, spacing, 3, -0.3, 0.3, [&](const Vec3& p) { places.push_back(shape.project(p)); });
  return places;
}

Vector<SurfacePoint> inside_places(const Shape& shape, double spacing) {
  Vector<SurfacePoint> places;
  for_each_fine_point(shape, spacing, 2, kTooCloseInside, 2.5, [&](const Vec3& p) {
    places.push_back({p, Vec3::Zero()});
  });
  return places;
}

}  // namespace

Carving carve(const Shape& shape, const LatticeFrame& frame) {
  const double margin = kSurfaceDepth * frame.spacing();
  struct Near {
    double distance;
    Vec3 point;
  };
  Vector<Near> near;
  Carving carving;
  const Vec3 reach = Vec3::Constant(margin);
  frame.for_each_in(shape.lower() - reach, shape.upper() + reach, [&](const Vec3& p) {
    const double distance = shape.signed_distance(p);
    if (distance < -margin)
      carving.inside.push_back(p);
    else if (distance <= margin)
      near.push_back({std::abs(distance), p});
  });
  std::stable_sort(near.begin(), near.end(), [](const Near& a, const Near& b) { return a.distance < b.distance; });
  for (const Near& n : near) carving.near_surface.push_back(n.point);
  return carving;
}

void populate_surface(const Shape& shape, double spacing, const Carving& carving, std::optional<std::uint32_t> exact,
                      Cloud& cloud) {
  Vector<SurfacePoint> carved;
  for (const Vec3& p : carving.near_surface) carved.push_back(shape.project(p));
  fill_gaps(shape, spacing, kTooClose, NodeKind::surface, carved, cloud);
  const Vector<SurfacePoint> places = surface_places(shape, spacing);
  const auto relax = [&](int iterations, double stretch = 1) {
    relax_surface(shape, stretch * spacing, iterations, cloud);
  };
  const Effort work = effort(carving.near_surface.size() + carving.inside.size());
  for (int round = 0; round < work.rounds; ++round) {
    relax(work.iterations);
    const bool thinned = thin_out(shape, spacing, cloud.feature_count, cloud);
    if (!fill_gaps(shape, spacing, kSurfaceGap, NodeKind::surface, places, cloud) && !thinned) break;
  }
  relax(work.iterations);
  if (!exact) return;
  match_count("surface_nodes", shape, spacing, cloud.feature_count, *exact, places, cloud, relax);
}

void populate_inside(const Shape& shape, double spacing, const Carving& carving, std::optional<std::uint32_t> exact,
                     Cloud& cloud) {
  for (const Vec3& p : carving.inside) cloud.add(p, NodeKind::inside);
  thin_out(shape, spacing, cloud.surface_count, cloud);
  const Vector<SurfacePoint> places = inside_places(shape, spacing);
  const auto relax = [&](int iterations, double stretch = 1) {
    relax_inside(shape, stretch * spacing, iterations, cloud);
  };
  const Effort work = effort(cloud.size());
  for (int round = 0; round < work.rounds; ++round) {
    relax(work.iterations);
    const bool thinned = thin_out(shape, spacing, cloud.surface_count, cloud);
    if (!fill_gaps(shape, spacing, kInsideGap, NodeKind::inside, places, cloud) && !thinned) break;
  }
  relax(work.iterations);
  if (!exact) return;
  match_count("inside_nodes", shape, spacing, cloud.surface_count, *exact, places, cloud, relax);
}

}  // namespace crumble
