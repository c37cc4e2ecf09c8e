#include "bubblemesh/exact_count.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bubblemesh/neighbour_grid.hpp"
#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

constexpr double kReach = 1.5;     // in units of d: how far a bubble sees
constexpr int kSettle = 25;        // iterations after each change
constexpr int kFinalSettle = 120;  // and after the last
constexpr std::size_t kShare = 8;  // each change does this part of what is left, at least one node

NeighbourGrid grid_of(const Shape& shape, double spacing, const Cloud& cloud) {
  NeighbourGrid grid(shape.lower(), shape.upper(), kReach * spacing);
  for (std::size_t i = 0; i < cloud.size(); ++i) grid.add(cloud.positions[i], static_cast<std::uint32_t>(i));
  return grid;
}

Vector<std::size_t> highest_first(const Vector<double>& scores) {
  Vector<std::size_t> order(scores.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return scores[a] > scores[b]; });
  return order;
}

/// Up to `number` points, the highest scores first, none within the other's reach.
Vector<std::size_t> choose(const Shape& shape, double spacing, const Vector<Vec3>& points, const Vector<double>& scores,
                           std::size_t number) {
  NeighbourGrid taken(shape.lower(), shape.upper(), kReach * spacing);
  Vector<std::size_t> chosen;
  for (const std::size_t i : highest_first(scores)) {
    if (chosen.size() == number) break;
    if (!taken.is_free(points[i], kReach * spacing)) continue;
    taken.add(points[i], 0);
    chosen.push_back(i);
  }
  return chosen;
}

void remove_crowded(const Shape& shape, double spacing, std::size_t first, std::size_t number, Cloud& cloud) {
  const NeighbourGrid grid = grid_of(shape, spacing, cloud);
  const Vector<Vec3> points(cloud.positions.begin() + static_cast<std::ptrdiff_t>(first), cloud.positions.end());
  Vector<double> crowding(points.size(), 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    grid.for_each_within(points[i], kReach * spacing, [&](std::uint32_t j, double squared) {
      const double room = kReach - std::sqrt(squared) / spacing;
      if (j != first + i) crowding[i] += room * room;
    });
  }
  Vector<char> keep(cloud.size(), 1);
  for (const std::size_t i : choose(shape, spacing, points, crowding, number)) keep[first + i] = 0;
  cloud.select(keep);
}

void insert_in_gaps(const Shape& shape, double spacing, NodeKind kind, std::size_t number,
                    const Vector<SurfacePoint>& places, Cloud& cloud) {
  const NeighbourGrid grid = grid_of(shape, spacing, cloud);
  Vector<Vec3> points;
  Vector<double> gaps;
  for (const SurfacePoint& place : places) {
    points.push_back(place.point);
    gaps.push_back(grid.nearest_squared(place.point, kReach * spacing));
  }
  for (const std::size_t i : choose(shape, spacing, points, gaps, number)) cloud.add(points[i], kind, places[i].normal);
}

/// Of a number near 1, by Newton's method: the library's own differs between systems in the last bit.
double cube_root(double x) {
  double root = 1;
  for (int i = 0; i < 8; ++i) root -= (root - x / (root * root)) / 3;
  return root;
}

}  // namespace

void match_count(std::string_view field, const Shape& shape, double spacing, std::size_t first, std::uint32_t wanted,
                 const Vector<SurfacePoint>& places, Cloud& cloud, const std::function<void(int, double)>& relax) {
  const NodeKind kind = first == cloud.surface_count ? NodeKind::inside : NodeKind::surface;
  const auto present = [&] {
    return kind == NodeKind::surface ? cloud.surface_count : cloud.size() - cloud.surface_count;
  };
  const std::size_t features = kind == NodeKind::surface ? cloud.feature_count : 0;
  const double natural = static_cast<double>(present());
  const double least = std::max(static_cast<double>(features), std::ceil(0.6 * natural));
  require_in_range(field, wanted, least, std::floor(1.5 * natural));
  if (present() == wanted) return;
  const double stretch = kind == NodeKind::surface ? std::sqrt(natural / wanted) : cube_root(natural / wanted);
  while (present() != wanted) {
    const std::size_t before = present();
    const std::size_t distance = before > wanted ? before - wanted : wanted - before;
    const std::size_t share = std::max<std::size_t>(1, distance / kShare);
    if (before > wanted)
      remove_crowded(shape, spacing, first, share, cloud);
    else
      insert_in_gaps(shape, spacing, kind, share, places, cloud);
    if (present() == before) throw Error(Code::mesh, std::string(field) + ": no room for another node");
    relax(kSettle, stretch);
  }
  relax(kFinalSettle, stretch);
}

}  // namespace crumble
