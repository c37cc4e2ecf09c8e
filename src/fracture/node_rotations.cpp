// The rotation that fits node i's springs in the least-squares sense is the polar part of
//   A = sum over intact j of (x_j - x_i) (X_j - X_i)^T
// (Kabsch 1976; as in shape matching, Mueller et al. 2005). Springs in one line, or none, leave it undetermined, and
// broken matter has many such nodes; so a little of the previous rotation is added to A. It decides what the springs
// leave open and moves what they decide by less than a thousandth of the turn since the last fit.
//
// A node fitted for the first time, when the first spring near it has just been cut, takes all its springs, cut ones
// too, for the previous rotation: mostly they still stand where they stood.
//
// A cut makes the fit jump, and what is drawn must not. So the difference is kept, as a matrix, added to the fit and
// taken back linearly within the settling time: points move from where they were to where they belong on straight
// lines. (Letting the weight of the cut spring fade does the same less evenly, and its far end, which flies away, would
// turn the node meanwhile.)
#include "node_rotations.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

constexpr double kMemory = 1e-3;

Mat3 nearest_rotation_by_svd(const Mat3& a) noexcept {
  const Eigen::JacobiSVD<Mat3> svd(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0) u.col(2) = -u.col(2);
  return u * svd.matrixV().transpose();
}

// `previous` when nothing finite is to be fitted. Scaled Newton iteration for the polar part (Higham 1986): with the
// SVD in its place update() took twice as long. The SVD is left with what is turned inside out or nearly flat.
Mat3 nearest_rotation(const Mat3& a, const Mat3& previous) noexcept {
  if (!a.allFinite()) return previous;
  const double size = a.norm();
  if (!(a.determinant() > 1e-9 * size * size * size)) return nearest_rotation_by_svd(a);
  Mat3 q = a;
  for (int iteration = 0; iteration < 12; ++iteration) {
    const Mat3 inverse_transpose = q.inverse().transpose();
    const double gain = std::sqrt(inverse_transpose.norm() / q.norm());
    const Mat3 next = 0.5 * (gain * q + inverse_transpose / gain);
    const double change = (next - q).squaredNorm();
    q = next;
    if (change < 1e-18) break;  // converges quadratically: this was the last digit's step
  }
  return q;
}

}  // namespace

NodeRotations::NodeRotations(const TetMesh& mesh, double settle)
    : springs_(mesh.springs),
      settle_(settle),
      first_neighbor_(mesh.node_count() + 1),
      neighbors_(2 * mesh.springs.size()),
      intact_(mesh.springs.size(), 1),
      uses_(mesh.node_count()),
      started_(mesh.node_count()),
      turns_(mesh.node_count()),
      drawn_(mesh.node_count()),
      new_nodes_(mesh.node_count()),
      freed_nodes_(mesh.node_count()) {
  for (const auto& [a, b] : mesh.springs) ++first_neighbor_[a + 1], ++first_neighbor_[b + 1];
  for (std::size_t i = 0; i < mesh.node_count(); ++i) first_neighbor_[i + 1] += first_neighbor_[i];
  Vector<std::uint32_t> next(first_neighbor_.begin(), first_neighbor_.end() - 1);
  for (std::uint32_t s = 0; s < mesh.springs.size(); ++s) {
    const auto [a, b] = mesh.springs[s];
    const Vec3 offset = mesh.positions[b] - mesh.positions[a];
    neighbors_[next[a]++] = {b, s, offset};
    neighbors_[next[b]++] = {a, s, -offset};
  }
}

void NodeRotations::reset(std::span<const std::uint8_t> intact) noexcept {
  std::copy(intact.begin(), intact.end(), intact_.begin());
  std::fill(uses_.begin(), uses_.end(), 0u);
  std::fill(started_.begin(), started_.end(), std::uint8_t{0});
  new_nodes_.clear();
  freed_nodes_.clear();
}

void NodeRotations::use(std::uint32_t node) noexcept {
  ++uses_[node];
  if (started_[node] == 0) new_nodes_.insert(node);
}

void NodeRotations::cut(std::uint32_t spring) noexcept {
  intact_[spring] = 0;
  for (const std::uint32_t node : springs_[spring]) {
    if (started_[node] != 0) freed_nodes_.insert(node);
  }
}

std::span<const NodeRotations::Neighbor> NodeRotations::neighbors(std::size_t node) const noexcept {
  return std::span(neighbors_).subspan(first_neighbor_[node], first_neighbor_[node + 1] - first_neighbor_[node]);
}

bool NodeRotations::has_cut(std::size_t node) const noexcept {
  const auto is_cut = [&](const Neighbor& neighbor) { return intact_[neighbor.spring] == 0; };
  return std::ranges::any_of(neighbors(node), is_cut);
}

// A over the intact springs, or over all.
Mat3 NodeRotations::spread(std::size_t node, VecView positions, bool count_cut) const noexcept {
  Mat3 a = Mat3::Zero();
  const Vec3 here = positions[node];
  for (const auto& [other, spring, offset] : neighbors(node)) {
    if (count_cut || intact_[spring] != 0) a += (positions[other] - here) * offset.transpose();
  }
  return a;
}

void NodeRotations::start_node(std::size_t node, VecView positions) noexcept {
  Turn& turn = turns_[node];
  turn.fit = nearest_rotation(spread(node, positions, true), Mat3::Identity());
  turn.offset.setZero();
  turn.freed = -std::numeric_limits<double>::infinity();
  started_[node] = 1;
}

void NodeRotations::fit_node(std::size_t node, VecView positions) noexcept {
  Mat3& fit = turns_[node].fit;
  const Mat3 a = spread(node, positions, false);
  if (a.isZero(0)) return;  // no spring: nothing is said of the rotation
  double scale = 0;
  for (const Neighbor& neighbor : neighbors(node)) scale += squared_norm(neighbor.offset);
  fit = nearest_rotation(a + kMemory * scale * fit, fit);
}

void NodeRotations::fit(VecView positions, double time) noexcept {
  for (std::size_t node = 0; node < uses_.size(); ++node) {
    if (uses_[node] == 0) {
      started_[node] = 0;
      continue;
    }
    fit_node(node, positions);
    const Turn& turn = turns_[node];
    const double age = time - turn.freed;
    drawn_[node] = turn.fit;
    if (age < settle_) drawn_[node] += (1 - age / settle_) * turn.offset;
  }
}

void NodeRotations::refit(VecView positions, double time) noexcept {
  for (const std::uint32_t node : new_nodes_.items()) {
    start_node(node, positions);
    if (has_cut(node)) fit_node(node, positions);
    drawn_[node] = turns_[node].fit;
  }
  for (const std::uint32_t node : freed_nodes_.items()) {
    fit_node(node, positions);
    Turn& turn = turns_[node];
    turn.offset = drawn_[node] - turn.fit;
    turn.freed = time;
    if (settle_ == 0) drawn_[node] = turn.fit;
  }
  new_nodes_.clear();
  freed_nodes_.clear();
}

}  // namespace crumble
