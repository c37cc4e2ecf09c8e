// The rotation that fits node i's springs in the least-squares sense is the polar part of
//   A = sum over intact j of (x_j - x_i) (X_j - X_i)^T
// (Kabsch 1976; as in shape matching, Mueller et al. 2005). Springs in one line, or none, leave it undetermined, and
// broken matter has many such nodes; so a little of the previous rotation is added to A. It decides what the springs
// leave open and moves what they decide by less than a thousandth of the turn since the last fit.
//
// A node fitted for the first time, when its first spring has just been cut, takes all its springs, cut ones too, for
// the previous rotation: at that moment they still stand where they stood, so nothing jumps.
#include "node_rotations.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

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

NodeRotations::NodeRotations(const TetMesh& mesh)
    : first_neighbor_(mesh.node_count() + 1),
      neighbors_(2 * mesh.springs.size()),
      intact_(mesh.springs.size()),
      states_(mesh.node_count()),
      rotations_(mesh.node_count(), Mat3::Identity()) {
  for (const auto& [a, b] : mesh.springs) ++first_neighbor_[a + 1], ++first_neighbor_[b + 1];
  for (std::size_t i = 0; i < mesh.node_count(); ++i) first_neighbor_[i + 1] += first_neighbor_[i];
  std::vector<std::uint32_t> next(first_neighbor_.begin(), first_neighbor_.end() - 1);
  for (std::uint32_t s = 0; s < mesh.springs.size(); ++s) {
    const auto [a, b] = mesh.springs[s];
    const Vec3 offset = mesh.positions[b] - mesh.positions[a];
    neighbors_[next[a]++] = {b, s, offset};
    neighbors_[next[b]++] = {a, s, -offset};
  }
}

void NodeRotations::start(std::span<const std::uint8_t> intact) noexcept {
  std::copy(intact.begin(), intact.end(), intact_.begin());
  for (NodeState& state : states_) state.used = false;
}

void NodeRotations::use(std::uint32_t node) noexcept {
  states_[node].used = true;
}

void NodeRotations::forget_unused() noexcept {
  for (NodeState& state : states_) state.fitted = state.fitted && state.used;
}

std::span<const NodeRotations::Neighbor> NodeRotations::neighbors(std::size_t node) const noexcept {
  return std::span(neighbors_).subspan(first_neighbor_[node], first_neighbor_[node + 1] - first_neighbor_[node]);
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

void NodeRotations::fit(VecView positions) noexcept {
  for (std::size_t node = 0; node < states_.size(); ++node) {
    if (!states_[node].used) continue;
    Mat3& rotation = rotations_[node];
    if (!states_[node].fitted) rotation = nearest_rotation(spread(node, positions, true), Mat3::Identity());
    states_[node].fitted = true;
    double scale = 0;
    for (const Neighbor& neighbor : neighbors(node)) scale += squared_norm(neighbor.offset);
    rotation = nearest_rotation(spread(node, positions, false) + kMemory * scale * rotation, rotation);
  }
}

}  // namespace crumble
