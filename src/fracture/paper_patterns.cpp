#include "paper_patterns.hpp"

#include <bit>
#include <optional>

#include "crumble/base/memory.hpp"

namespace crumble::surface_patterns {
namespace {

// A corner or a cut end, in a reference tetrahedron whose corners and middles have integer coordinates: all products
// below are exact.
struct Point {
  VertexCode code;
  unsigned corners;  // bits: of which it is the mean
  Vec3 position;
};
using Facet = Vector<Point>;  // counter-clockwise from outside; three or four

Point make_point(std::size_t site, std::size_t copy, unsigned corners) {
  const double weight = 2.0 / std::popcount(corners);
  Vec3 position = Vec3::Zero();
  for (unsigned axis = 0; axis < 3; ++axis) position[axis] = (corners >> (axis + 1) & 1u) != 0 ? weight : 0;
  return {static_cast<VertexCode>(site * 4 + copy), corners, position};
}

bool is_clique(unsigned mask, unsigned corners) {
  for (std::size_t s = 0; s < 6; ++s) {
    const auto [a, b] = kTetEdges[s];
    if ((mask >> s & 1u) != 0 && (corners >> a & 1u) != 0 && (corners >> b & 1u) != 0) return false;
  }
  return true;
}

bool is_maximal_clique(unsigned mask, unsigned corners) {
  if (!is_clique(mask, corners)) return false;
  for (unsigned c = 0; c < 4; ++c) {
    if ((corners >> c & 1u) == 0 && is_clique(mask, corners | 1u << c)) return false;
  }
  return true;
}

Vector<Point> solid_points(unsigned mask, unsigned clique) {
  Vector<Point> points;
  for (unsigned c = 0; c < 4; ++c) {
    if ((clique >> c & 1u) != 0) points.push_back(make_point(kCorners + c, 0, 1u << c));
  }
  for (std::size_t s = 0; s < 6; ++s) {
    for (std::size_t end = 0; end < 2; ++end) {
      const auto [a, b] = kTetEdges[s];
      const bool starts_here = (clique >> kTetEdges[s][end] & 1u) != 0;
      if ((mask >> s & 1u) != 0 && starts_here) points.push_back(make_point(kMiddles + s, end, 1u << a | 1u << b));
    }
  }
  return points;
}

// Is point c, seen from outside, on the left of the way from a to b? `outward` is normal to the facet they lie on.
bool is_left(const Vec3& outward, const Point& a, const Point& b, const Point& c) {
  return dot(outward, cross(b.position - a.position, c.position - a.position)) > 0;
}

// Round the facet, from its first point. No three points are in one line.
Facet in_order(const Vector<Point>& points, const Vec3& outward) {
  Facet facet{points.front()};
  while (facet.size() < points.size()) {
    for (const Point& next : points) {
      bool is_next = next.code != facet.back().code;
      for (const Point& other : points) {
        if (other.code == next.code || other.code == facet.back().code) continue;
        is_next = is_next && is_left(outward, facet.back(), next, other);
      }
      if (is_next) {
        facet.push_back(next);
        break;
      }
    }
  }
  return facet;
}

// The facet of the hull through three of its points, if they are on one and are the first three there.
std::optional<Facet> facet_through(const Vector<Point>& points, std::size_t i, std::size_t j, std::size_t k) {
  const Vec3& origin = points[i].position;
  Vec3 outward = cross(points[j].position - origin, points[k].position - origin);
  Vector<Point> on_plane;
  bool before = false, behind = false;
  for (std::size_t p = 0; p < points.size(); ++p) {
    const double height = dot(outward, points[p].position - origin);
    if (height > 0) before = true;
    if (height < 0) behind = true;
    if (height != 0) continue;
    if (p < k && p != i && p != j) return std::nullopt;
    on_plane.push_back(points[p]);
  }
  if (before && behind) return std::nullopt;
  if (before) outward = -outward;
  return in_order(on_plane, outward);
}

Vector<Facet> hull_facets(const Vector<Point>& points) {
  Vector<Facet> facets;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      for (std::size_t k = j + 1; k < points.size(); ++k) {
        if (auto facet = facet_through(points, i, j, k)) facets.push_back(*std::move(facet));
      }
    }
  }
  return facets;
}

void add_facet(const Facet& facet, std::uint8_t owner, MaskPatterns& patterns) {
  unsigned corners = 0;
  for (const Point& point : facet) corners |= point.corners;
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t fourth) {
    const PatternTriangle triangle{{facet[a].code, facet[b].code, facet[c].code}, owner, facet[fourth].code};
    if (corners == 15) {
      patterns.interior[patterns.interior_count++] = triangle;
    } else {
      const auto face = static_cast<std::size_t>(std::countr_one(corners));  // opposite the corner that is not there
      patterns.skin[face][patterns.skin_count[face]++] = triangle;
    }
  };
  if (facet.size() == 3) return add(0, 1, 2, 0);
  add(0, 1, 2, 3);
  add(2, 3, 0, 1);
}

std::array<MaskPatterns, kCutMaskCount> make_paper_patterns() {
  std::array<MaskPatterns, kCutMaskCount> table{};
  for (unsigned mask = 0; mask < kCutMaskCount; ++mask) {
    for (unsigned clique = 1; clique < 16; ++clique) {
      if (!is_maximal_clique(mask, clique)) continue;
      const auto owner = static_cast<std::uint8_t>(std::countr_zero(clique));
      const Vector<Point> points = solid_points(mask, clique);
      for (const Facet& facet : hull_facets(points)) add_facet(facet, owner, table[mask]);
    }
    // Corners and cut ends alike are carried by the one corner they start at.
    for (std::uint8_t c = 0; c < 4; ++c) table[mask].carriers[(kCorners + c) * 4] = static_cast<std::uint8_t>(1u << c);
    for (std::size_t s = 0; s < 6; ++s) {
      for (std::size_t end = 0; end < 2; ++end) {
        table[mask].carriers[(kMiddles + s) * 4 + end] = static_cast<std::uint8_t>(1u << kTetEdges[s][end]);
      }
    }
  }
  return table;
}

}  // namespace

const std::array<MaskPatterns, kCutMaskCount> kPaperPatterns = make_paper_patterns();

}  // namespace crumble::surface_patterns
