// Edge removal: the ring of vertices around the edge a-b is a polygon; every triangulation of it gives tetrahedra
// by joining each triangle to a and to b. The one whose worst tetrahedron is best is found by dynamic programming over
// the polygon's pieces (Klincsek 1980; Shewchuk, "Two discrete optimization algorithms for the topological improvement
// of tetrahedral meshes", 2002). Around a boundary edge the ring is open, and the side that closes it becomes a new
// boundary edge.
//
// The link check: an edge or face that a flip would make must not exist yet. Without it a flip can be geometrically
// sound and still glue the mesh to itself somewhere else.
#include "bubblemesh/flips.hpp"

#include <limits>

#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

constexpr double kSameSurface = 0.82;  // cosine: normals closer than 35 degrees belong to one smooth piece
constexpr double kImpossible = -std::numeric_limits<double>::infinity();

class EdgeRemoval {
 public:
  EdgeRemoval(const Cloud& cloud, Measure measure, std::uint32_t a, std::uint32_t b, TetComplex& tets, double enough)
      : cloud_(cloud), measure_(measure), a_(a), b_(b), tets_(tets), ring_(tets.ring(a, b)), worst_(enough) {}

  bool apply() {
    if (ring_.size == 0) return false;
    for (std::size_t k = 0; k < ring_.tet_count(); ++k) {
      worst_ = std::min(worst_, quality_of(cloud_, measure_, tets_[ring_.tets[k]]));
    }
    if (!ring_.closed && !surface_stays_smooth()) return false;
    if (ring_.size == 2) return peel();
    if (ring_.size == 3 && ring_.closed && tets_.has_face(ring_.vertices[0], ring_.vertices[1], ring_.vertices[2]))
      return false;
    if (best_triangulation() <= worst_) return false;
    collect(0, ring_.size - 1);
    tets_.replace(std::span(ring_.tets).first(ring_.tet_count()), made_);
    return true;
  }

 private:
  /// Takes off a tetrahedron that lies flat on the surface with two of its faces.
  bool peel() {
    if (!tets_.ring(ring_.vertices[0], ring_.vertices[1]).closed) return false;
    tets_.replace(std::span(ring_.tets).first(1), {});
    return true;
  }

  bool surface_stays_smooth() const {
    const std::uint32_t first = ring_.vertices[0], last = ring_.vertices[ring_.size - 1];
    const std::array<Vec3, 4> normals{normal(b_, a_, first), normal(a_, b_, last), normal(first, b_, last),
                                      normal(first, last, a_)};
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < i; ++j) {
        if (!(dot(normals[i], normals[j]) >= kSameSurface)) return false;
      }
    }
    return true;
  }
  Vec3 normal(std::uint32_t i, std::uint32_t j, std::uint32_t k) const {
    const auto& p = cloud_.positions;
    return normalized(cross(p[j] - p[i], p[k] - p[i]));
  }

  /// Fills best_[i][j], the worst quality over the piece of the polygon from vertex i to j, and where it is split.
  double best_triangulation() {
    const std::size_t n = ring_.size;
    for (std::size_t i = 0; i + 1 < n; ++i) best_[i][i + 1] = std::numeric_limits<double>::infinity();
    for (std::size_t length = 2; length < n; ++length) {
      for (std::size_t i = 0; i + length < n; ++i) best_piece(i, i + length);
    }
    return best_[0][n - 1];
  }
  void best_piece(std::size_t i, std::size_t j) {
    double& best = best_[i][j];
    best = kImpossible;
    const bool side = ring_.closed && i == 0 && j == ring_.size - 1;
    if (!side && tets_.has_edge(ring_.vertices[i], ring_.vertices[j])) return;
    for (std::size_t k = i + 1; k < j; ++k) {
      const double rest = std::min(best_[i][k], best_[k][j]);
      if (rest <= std::max(best, worst_)) continue;
      const double value = std::min(rest, triangle_quality(i, k, j));
      if (value > best) best = value, split_[i][j] = k;
    }
  }
  double triangle_quality(std::size_t i, std::size_t k, std::size_t j) const {
    const double upper = quality_of(cloud_, measure_, upper_tet(i, k, j));
    return upper <= worst_ ? kImpossible : std::min(upper, quality_of(cloud_, measure_, lower_tet(i, k, j)));
  }
  Tetrahedron upper_tet(std::size_t i, std::size_t k, std::size_t j) const {
    return {ring_.vertices[i], ring_.vertices[k], ring_.vertices[j], b_};
  }
  Tetrahedron lower_tet(std::size_t i, std::size_t k, std::size_t j) const {
    return {ring_.vertices[i], ring_.vertices[j], ring_.vertices[k], a_};
  }

  void collect(std::size_t i, std::size_t j) {
    if (j - i < 2) return;
    const std::size_t k = split_[i][j];
    made_.push_back(upper_tet(i, k, j));
    made_.push_back(lower_tet(i, k, j));
    collect(i, k);
    collect(k, j);
  }

  const Cloud& cloud_;
  Measure measure_;
  std::uint32_t a_, b_;
  TetComplex& tets_;
  Ring ring_;
  double worst_;  // what a new tetrahedron has to beat
  std::array<std::array<double, Ring::kMost>, Ring::kMost> best_;
  std::array<std::array<std::size_t, Ring::kMost>, Ring::kMost> split_;
  Vector<Tetrahedron> made_;
};

}  // namespace

bool remove_edge(const Cloud& cloud, Measure measure, std::uint32_t a, std::uint32_t b, TetComplex& tets,
                 double enough) {
  return EdgeRemoval(cloud, measure, a, b, tets, enough).apply();
}

bool flip_face(const Cloud& cloud, Measure measure, TetId tet, int face, TetComplex& tets, double enough) {
  const TetId other = tets.across(tet, face);
  if (other == kNoTet) return false;
  const Tetrahedron t = tets[tet], u = tets[other];
  const auto& f = kTetFaces[face];
  const std::uint32_t below = t[face], above = *std::ranges::find_if(u, [&](std::uint32_t v) { return !holds(t, v); });
  if (tets.has_edge(below, above)) return false;
  const double worst = std::min({quality_of(cloud, measure, t), quality_of(cloud, measure, u), enough});
  std::array<Tetrahedron, 3> made;
  for (std::size_t k = 0; k < 3; ++k) {
    made[k] = {below, above, t[f[k]], t[f[(k + 1) % 3]]};
    if (quality_of(cloud, measure, made[k]) <= worst) return false;
  }
  tets.replace(std::array{tet, other}, made);
  return true;
}

}  // namespace crumble
