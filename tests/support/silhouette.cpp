#include "silhouette.hpp"

#include <algorithm>
#include <cmath>

namespace crumble {
namespace {

constexpr std::int64_t kUnit = 256;  // per pixel

// Twice the area of the triangle that an edge makes with a point, from left of the edge on positive.
struct EdgeFunction {
  std::int64_t dx, dy, ax, ay;
  std::int64_t tie;  // 0: points on the edge belong to the triangle; 1: to the other side's

  std::int64_t at(std::int64_t x, std::int64_t y) const { return dx * (y - ay) - dy * (x - ax) - tie; }
};

// Of the two directions of an edge exactly one owns it: downwards (the left side of its triangle), or level to the left
// (the top).
EdgeFunction edge_function(std::int64_t ax, std::int64_t ay, std::int64_t bx, std::int64_t by) {
  const std::int64_t dx = bx - ax, dy = by - ay;
  const bool owns = dy < 0 || (dy == 0 && dx < 0);
  return {dx, dy, ax, ay, owns ? 0 : 1};
}

// Pixels whose middles lie in [low, high], cut to the picture.
struct PixelRange {
  int first, last;
};
PixelRange pixels_between(std::int64_t low, std::int64_t high, int size) {
  const auto first = std::max<std::int64_t>(0, (low - kUnit / 2) / kUnit);
  const auto last = std::min<std::int64_t>(size - 1, (high - kUnit / 2) / kUnit + 1);
  return {static_cast<int>(first), static_cast<int>(last)};
}

}  // namespace

ParallelCamera make_camera(const Vec3& towards, const Vec3& center, double radius, int size) {
  ParallelCamera camera;
  camera.towards = normalized(towards);
  camera.up = normalized(Vec3(Vec3(0, 1, 0) - camera.towards.y() * camera.towards));
  camera.center = center;
  camera.pixel = 2 * radius / size;
  camera.size = size;
  return camera;
}

Silhouette::Silhouette(const ParallelCamera& camera) : camera_(camera), right_(cross(camera.up, camera.towards)) {}

void Silhouette::draw(std::span<const Vec3> vertices, std::span<const Triangle> triangles) {
  pixels_.assign(static_cast<std::size_t>(camera_.size) * camera_.size, {});
  corners_.clear();
  const auto place = [&](double metres) {
    return static_cast<std::int64_t>(std::llround((metres / camera_.pixel + 0.5 * camera_.size) * kUnit));
  };
  for (const Vec3& v : vertices) {
    const Vec3 p = v - camera_.center;
    corners_.push_back({place(dot(right_, p)), place(dot(camera_.up, p)), dot(camera_.towards, p)});
  }
  for (const auto& [a, b, c] : triangles) draw(corners_[a], corners_[b], corners_[c]);
}

void Silhouette::draw(Corner a, Corner b, Corner c) {
  const std::int64_t area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  if (area == 0) return;
  const bool is_front = area > 0;
  if (!is_front) std::swap(b, c);
  const EdgeFunction ab = edge_function(a.x, a.y, b.x, b.y), bc = edge_function(b.x, b.y, c.x, c.y),
                     ca = edge_function(c.x, c.y, a.x, a.y);
  const PixelRange columns = pixels_between(std::min({a.x, b.x, c.x}), std::max({a.x, b.x, c.x}), camera_.size);
  const PixelRange rows = pixels_between(std::min({a.y, b.y, c.y}), std::max({a.y, b.y, c.y}), camera_.size);
  const double scale = 1 / std::abs(static_cast<double>(area));
  for (int row = rows.first; row <= rows.last; ++row) {
    for (int column = columns.first; column <= columns.last; ++column) {
      const std::int64_t x = column * kUnit + kUnit / 2, y = row * kUnit + kUnit / 2;
      const std::int64_t of_c = ab.at(x, y), of_a = bc.at(x, y), of_b = ca.at(x, y);
      if (of_a < 0 || of_b < 0 || of_c < 0) continue;
      const double depth = a.depth + scale * (static_cast<double>(of_b) * (b.depth - a.depth) +
                                              static_cast<double>(of_c) * (c.depth - a.depth));
      Pixel& pixel = pixels_[index(column, row)];
      const bool nearer = pixel.crossings == 0 || depth > pixel.nearest;
      // The two sides of a crack that has not opened are in one place.
      if (nearer || (depth == pixel.nearest && is_front)) pixel.nearest = depth, pixel.is_front = is_front;
      ++pixel.crossings;
      pixel.balance += is_front ? 1 : -1;
    }
  }
}

std::size_t Silhouette::covered_count() const {
  return static_cast<std::size_t>(std::ranges::count_if(pixels_, [](const Pixel& p) { return p.crossings != 0; }));
}

std::size_t Silhouette::hole_count() const {
  return static_cast<std::size_t>(std::ranges::count_if(pixels_, [](const Pixel& p) { return p.balance != 0; }));
}

std::size_t Silhouette::back_count() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(pixels_, [](const Pixel& p) { return p.crossings != 0 && !p.is_front; }));
}

}  // namespace crumble
