// Bowyer and Watson's insertion. A new point destroys the tetrahedra whose circumsphere holds it strictly inside; they
// form a cavity around the point, and every face of the cavity makes a new tetrahedron with it.
//
// Because the tests are exact and a point ON a sphere does not conflict, no special case is left:
// - The cavity's faces never lie in one plane with the point. Such a plane would cut the spheres on both sides of the
//   face in the same circle, and the point would lie inside one and not inside the other. So no flat tetrahedron is
//   ever made, however many points are cospherical, as in a lattice nearly all are.
// - A point on a face or an edge lies strictly inside the spheres of all tetrahedra around it, so they all go.
// - The walk to the tetrahedron that holds a point ends, since the triangulation is Delaunay at all times.
//
// The first tetrahedra are six in a cube twice as large as the body; what touches its corners is dropped at the end.
// Points go in by rounds of growing size (random, which keeps the work near N log N for any input), each round in
// Morton order, which keeps the walks short: Amenta, Choi and Rote, "Incremental constructions con BRIO" (2003).
#include "bubblemesh/delaunay.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/random.hpp"

namespace crumble {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;
constexpr std::int32_t kCube = 1 << kCoordinateBits;

struct Cell {
  std::array<std::uint32_t, 4> vertex;
  std::array<std::uint32_t, 4> neighbour;  // across the face opposite to the vertex
};

/// Joins the new tetrahedra around a point: a face that holds the point is known by its other two vertices.
class FaceMatcher {
 public:
  void clear(std::size_t faces) {
    std::size_t size = slots_.size();
    while (size < 4 * faces) size = std::max<std::size_t>(256, 2 * size);
    if (size != slots_.size()) slots_.assign(size, {});
    ++round_;
  }
  struct Face {
    std::uint32_t cell = kNone;
    int index = 0;
  };
  /// The face put in before under the same two vertices; if there is none, remembers this one.
  Face match(std::uint32_t a, std::uint32_t b, Face face) {
    const std::uint64_t key = std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
    std::size_t at = (key * 0x9e3779b97f4a7c15u) >> (64 - std::countr_zero(slots_.size()));
    while (slots_[at].round == round_ && slots_[at].key != key) at = (at + 1) & (slots_.size() - 1);
    if (slots_[at].round == round_) return slots_[at].face;
    slots_[at] = {key, round_, face};
    return {};
  }

 private:
  struct Slot {
    std::uint64_t key = 0, round = 0;
    Face face;
  };
  Vector<Slot> slots_;
  std::uint64_t round_ = 0;
};

class Triangulation {
 public:
  explicit Triangulation(std::span<const GridPoint> points) : points_(points.begin(), points.end()) {
    points_.insert(points_.end(), {{0, 0, 0},
                                   {kCube, 0, 0},
                                   {0, kCube, 0},
                                   {kCube, kCube, 0},
                                   {0, 0, kCube},
                                   {kCube, 0, kCube},
                                   {0, kCube, kCube},
                                   {kCube, kCube, kCube}});
    make_cube(static_cast<std::uint32_t>(points.size()));
  }

  void insert(std::uint32_t p) {
    const std::uint32_t start = locate(p);
    for (const std::uint32_t v : cells_[start].vertex) {
      if (points_[v] == points_[p])
        throw Error(Code::duplicate_node, "delaunay: point " + std::to_string(p) + " stands twice");
    }
    find_cavity(start, p);
    fill_cavity(p);
  }

  Vector<Tetrahedron> tetrahedra(std::uint32_t point_count) const {
    Vector<Tetrahedron> result;
    for (const Cell& cell : cells_) {
      if (std::ranges::all_of(cell.vertex, [&](std::uint32_t v) { return v < point_count; }))
        result.push_back(cell.vertex);
    }
    return result;
  }

 private:
  struct Wall {  // a face of the cavity, counter-clockwise seen from outside
    std::array<std::uint32_t, 3> vertex;
    std::uint32_t outside;
    int outside_face;
  };

  /// Kuhn's six tetrahedra around the diagonal 0-7, one for each order of the axes.
  void make_cube(std::uint32_t base) {
    constexpr std::array<std::array<std::uint32_t, 2>, 6> kMiddle{{{1, 3}, {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}}};
    for (std::uint32_t k = 0; k < 6; ++k) {
      cells_.push_back(
          {{base, base + kMiddle[k][0], base + kMiddle[k][1], base + 7}, {kNone, (k + 1) % 6, (k + 5) % 6, kNone}});
    }
    seen_.assign(6, 0);
  }

  bool conflicts(std::uint32_t cell, std::uint32_t p) const {
    const auto& v = cells_[cell].vertex;
    return in_sphere(points_[v[0]], points_[v[1]], points_[v[2]], points_[v[3]], points_[p]);
  }

  /// Walks through faces that have p on their far side.
  std::uint32_t locate(std::uint32_t p) const {
    std::uint32_t at = last_;
    for (int face = 0; face < 4;) {
      const auto& v = cells_[at].vertex;
      const auto& f = kTetFaces[face];
      const bool beyond = orient_sign(points_[v[f[0]]], points_[v[f[1]]], points_[v[f[2]]], points_[p]) > 0;
      if (beyond) at = cells_[at].neighbour[face];
      face = beyond ? 0 : face + 1;
    }
    return at;
  }

  void find_cavity(std::uint32_t start, std::uint32_t p) {
    cavity_.assign(1, start);
    walls_.clear();
    stamp_ += 2;  // seen_ == stamp_: in the cavity; stamp_ + 1: tested, not in it
    seen_[start] = stamp_;
    for (std::size_t k = 0; k < cavity_.size(); ++k) {
      const std::uint32_t cell = cavity_[k];
      for (int face = 0; face < 4; ++face) {
        const std::uint32_t next = cells_[cell].neighbour[face];
        if (next != kNone && seen_[next] < stamp_) {
          const bool inside = conflicts(next, p);
          seen_[next] = inside ? stamp_ : stamp_ + 1;
          if (inside) cavity_.push_back(next);
        }
        if (next != kNone && seen_[next] == stamp_) continue;
        const auto& v = cells_[cell].vertex;
        const auto& f = kTetFaces[face];
        walls_.push_back({{v[f[0]], v[f[1]], v[f[2]]}, next, next == kNone ? 0 : face_towards(next, cell)});
      }
    }
  }
  int face_towards(std::uint32_t cell, std::uint32_t other) const {
    const auto& n = cells_[cell].neighbour;
    return static_cast<int>(std::ranges::find(n, other) - n.begin());
  }

  void fill_cavity(std::uint32_t p) {
    matcher_.clear(3 * walls_.size());
    for (const std::uint32_t cell : cavity_) {
      cells_[cell].vertex.fill(kNone);
      free_.push_back(cell);
    }
    for (const Wall& wall : walls_) {
      const std::uint32_t cell = free_cell();
      cells_[cell] = {{wall.vertex[0], wall.vertex[2], wall.vertex[1], p}, {kNone, kNone, kNone, wall.outside}};
      if (wall.outside != kNone) cells_[wall.outside].neighbour[wall.outside_face] = cell;
      for (int face = 0; face < 3; ++face) join_sideways(cell, face);
      last_ = cell;
    }
  }
  std::uint32_t free_cell() {
    if (free_.empty()) {
      free_.push_back(static_cast<std::uint32_t>(cells_.size()));
      cells_.emplace_back();
      seen_.push_back(0);
    }
    const std::uint32_t cell = free_.back();
    free_.pop_back();
    return cell;
  }
  void join_sideways(std::uint32_t cell, int face) {
    const auto& v = cells_[cell].vertex;
    const auto other = matcher_.match(v[(face + 1) % 3], v[(face + 2) % 3], {cell, face});
    if (other.cell == kNone) return;
    cells_[cell].neighbour[face] = other.cell;
    cells_[other.cell].neighbour[other.index] = cell;
  }

  Vector<GridPoint> points_;
  Vector<Cell> cells_;  // a free one has no vertices
  Vector<std::uint32_t> free_;
  Vector<std::uint64_t> seen_;
  std::uint64_t stamp_ = 0;
  std::uint32_t last_ = 0;
  Vector<std::uint32_t> cavity_;
  Vector<Wall> walls_;
  FaceMatcher matcher_;
};

/// Spreads the low 22 bits to every third place.
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 32) & 0x1f00000000ffffu;
  x = (x | x << 16) & 0x1f0000ff0000ffu;
  x = (x | x << 8) & 0x100f00f00f00f00fu;
  x = (x | x << 4) & 0x10c30c30c30c30c3u;
  return (x | x << 2) & 0x1249249249249249u;
}

/// Half of the points in the last round, half of the rest in the one before it, ...; Morton order in a round.
Vector<std::uint32_t> insertion_order(std::span<const GridPoint> points) {
  struct Key {
    int round;
    std::uint64_t morton;
    std::uint32_t index;
    auto operator<=>(const Key&) const = default;
  };
  Vector<Key> keys;
  Random random(1);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const auto code = [](std::int32_t x) { return spread(static_cast<std::uint64_t>(x) >> 1); };
    const GridPoint& p = points[i];
    keys.push_back({-std::countr_zero(random.next()), code(p.x) | code(p.y) << 1 | code(p.z) << 2, i});
  }
  std::ranges::sort(keys);
  Vector<std::uint32_t> order;
  for (const Key& key : keys) order.push_back(key.index);
  return order;
}

}  // namespace

Vector<GridPoint> quantize(std::span<const Vec3> points) {
  // The six corners of an octahedron of the perfect lattice are cospherical and each of its three diagonals gives
  // Delaunay tetrahedra. Looking at the points a little squeezed along the layers, across the rows, makes the diagonal
  // without an x component the shortest everywhere: all octahedra are cut alike, and rows keep constant neighbour
  // offsets. An affine map turns a triangulation into a triangulation, so nothing else is at stake.
  constexpr double kSqueeze = 0.999;
  if (points.empty()) return {};
  Vec3 lower = points.front(), upper = lower;
  for (const Vec3& p : points) lower = lower.cwiseMin(p), upper = upper.cwiseMax(p);
  const Vec3 size = upper - lower;
  const double scale = kCube / 2 / std::max({size.x(), size.y(), size.z()});
  Vector<GridPoint> grid;
  grid.reserve(points.size());
  for (const Vec3& p : points) {
    const Vec3 q = scale * (p - lower);
    const auto round = [](double x) { return static_cast<std::int32_t>(std::floor(x + 0.5)) + kCube / 4; };
    grid.push_back({round(q.x()), round(q.y()), round(kSqueeze * q.z())});
  }
  return grid;
}

Vector<Tetrahedron> delaunay(std::span<const GridPoint> points) {
  Triangulation triangulation(points);
  for (const std::uint32_t p : insertion_order(points)) triangulation.insert(p);
  return triangulation.tetrahedra(static_cast<std::uint32_t>(points.size()));
}

}  // namespace crumble
