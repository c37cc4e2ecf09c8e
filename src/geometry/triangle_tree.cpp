#include "geometry/triangle_tree.hpp"

#include <algorithm>
#include <cmath>

#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

// Relative to the coordinates: above what the rounding of a distance can be.
constexpr double kRounding = 4e-15;

double greatest_coordinate(const Vec3& p) noexcept {
  return std::max({std::abs(p.x()), std::abs(p.y()), std::abs(p.z())});
}

}  // namespace

TriangleTree::TriangleTree(const TriangleMesh& mesh) {
  Vector<Box> boxes;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 &va = mesh.vertices[a], &vb = mesh.vertices[b], &vc = mesh.vertices[c];
    boxes.push_back({va.cwiseMin(vb).cwiseMin(vc), va.cwiseMax(vb).cwiseMax(vc)});
    size_ = std::max({size_, greatest_coordinate(boxes.back().low), greatest_coordinate(boxes.back().high)});
    triangles_.push_back(static_cast<std::uint32_t>(triangles_.size()));
  }
  nodes_.resize(1);
  build(0, 0, static_cast<std::uint32_t>(triangles_.size()), boxes);
  for (const std::uint32_t t : triangles_) {
    const auto& [a, b, c] = mesh.triangles[t];
    corners_.push_back({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
  }
}

void TriangleTree::build(std::uint32_t node, std::uint32_t first, std::uint32_t end, const Vector<Box>& boxes) {
  Box box = boxes[triangles_[first]];
  for (std::uint32_t i = first + 1; i < end; ++i) {
    box = {box.low.cwiseMin(boxes[triangles_[i]].low), box.high.cwiseMax(boxes[triangles_[i]].high)};
  }
  const auto begin = triangles_.begin();
  if (end - first <= kLeafSize) {
    std::sort(begin + first, begin + end);
    nodes_[node] = {box, first, end - first};
    return;
  }
  const Vec3 edges = box.high - box.low;
  const int axis = edges.x() >= edges.y() && edges.x() >= edges.z() ? 0 : edges.y() >= edges.z() ? 1 : 2;
  const std::uint32_t middle = first + (end - first) / 2;
  // the number decides between equal centres, so that the halves are the same whoever sorts
  std::nth_element(begin + first, begin + middle, begin + end, [&](std::uint32_t s, std::uint32_t t) {
    const double of_s = boxes[s].low[axis] + boxes[s].high[axis], of_t = boxes[t].low[axis] + boxes[t].high[axis];
    return of_s < of_t || (of_s == of_t && s < t);
  });
  const auto child = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node] = {box, child, 0};
  nodes_.resize(nodes_.size() + 2);
  build(child, first, middle, boxes);
  build(child + 1, middle, end, boxes);
}

double TriangleTree::squared_distance(const Box& box, const Vec3& p) noexcept {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double d = std::max({box.low[axis] - p[axis], p[axis] - box.high[axis], 0.0});
    sum += d * d;
  }
  return sum;
}

void TriangleTree::consider(const Vec3& p, std::uint32_t slot, Nearest& best) const noexcept {
  const auto& [a, b, c] = corners_[slot];
  const TrianglePoint on = nearest_on_triangle(p, a, b, c);
  const double squared = squared_norm(p - on.point);
  if (squared < best.squared_distance || (squared == best.squared_distance && triangles_[slot] < best.triangle)) {
    best = {on.point, squared, triangles_[slot], slot, on.feature};
  }
}

TriangleTree::Nearest TriangleTree::nearest(const Vec3& p, double reach, std::uint32_t slot) const noexcept {
  struct Open {
    std::uint32_t node;
    double squared;
  };
  const double slack = kRounding * (size_ + greatest_coordinate(p));
  const auto bound_of = [&](double distance) { return (distance + slack) * (distance + slack); };
  Nearest best;
  if (slot < corners_.size()) consider(p, slot, best);
  double bound = bound_of(std::min(reach, std::sqrt(best.squared_distance)));
  Open open[kMaxOpen] = {{0, squared_distance(nodes_[0].box, p)}};
  std::size_t count = 1;
  while (count > 0) {
    const Open here = open[--count];
    if (here.squared > bound) continue;
    const Node& node = nodes_[here.node];
    if (node.count > 0) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) consider(p, i, best);
      bound = std::min(bound, bound_of(std::sqrt(best.squared_distance)));
      continue;
    }
    Open near{node.first, squared_distance(nodes_[node.first].box, p)};
    Open far{node.first + 1, squared_distance(nodes_[node.first + 1].box, p)};
    if (far.squared < near.squared) std::swap(near, far);
    open[count++] = far;
    open[count++] = near;
  }
  return best;
}

bool TriangleTree::meets(const Box& box, const Vec3& p, const Vec3& direction, double way) const noexcept {
  const double slack = kRounding * (size_ + greatest_coordinate(p));
  double from = 0, to = way + slack;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.low[axis] - slack - p[axis], high = box.high[axis] + slack - p[axis];
    if (direction[axis] == 0) {
      if (low > 0 || high < 0) return false;
      continue;
    }
    const double first = low / direction[axis], second = high / direction[axis];
    from = std::max(from, std::min(first, second));
    to = std::min(to, std::max(first, second));
  }
  return from <= to;
}

TriangleTree::Exit TriangleTree::first_exit(const Vec3& p, const Vec3& direction) const noexcept {
  // a ray through an edge meets both of its triangles: none may miss it by rounding
  constexpr double kEdge = -1e-12;
  Exit best;
  std::uint32_t open[kMaxOpen] = {0};
  std::size_t count = 1;
  while (count > 0) {
    const Node& node = nodes_[open[--count]];
    if (!meets(node.box, p, direction, best.way)) continue;
    if (node.count == 0) {
      open[count++] = node.first;
      open[count++] = node.first + 1;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const auto& [a, b, c] = corners_[i];
      const Vec3 normal = cross(b - a, c - a);
      const double approach = dot(normal, direction);
      if (!(approach > 0)) continue;
      const double way = dot(normal, a - p) / approach;
      if (!(way >= 0) || way > best.way || (way == best.way && triangles_[i] > best.triangle)) continue;
      const Vec3 q = p + way * direction;
      const double edge = kEdge * squared_norm(normal);
      if (dot(cross(b - a, q - a), normal) < edge || dot(cross(c - b, q - b), normal) < edge ||
          dot(cross(a - c, q - c), normal) < edge) {
        continue;
      }
      best = {way, triangles_[i]};
    }
  }
  return best;
}

void TriangleTree::find_later_neighbours(const Triangle& corners, std::uint32_t triangle, const TriangleMesh& mesh,
                                         Vector<std::uint32_t>& found) const {
  const Vec3 &a = mesh.vertices[corners[0]], &b = mesh.vertices[corners[1]], &c = mesh.vertices[corners[2]];
  const Box box{a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
  found.clear();
  std::uint32_t open[kMaxOpen] = {0};
  std::size_t count = 1;
  while (count > 0) {
    const Node& node = nodes_[open[--count]];
    if ((node.box.low.array() > box.high.array()).any() || (node.box.high.array() < box.low.array()).any()) continue;
    if (node.count == 0) {
      open[count++] = node.first;
      open[count++] = node.first + 1;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      if (triangles_[i] > triangle) found.push_back(triangles_[i]);
    }
  }
  std::sort(found.begin(), found.end());
}

}  // namespace crumble
