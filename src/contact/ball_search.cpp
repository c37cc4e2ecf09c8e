#include "ball_search.hpp"

#include <bit>

namespace crumble {
namespace {

// Cells beyond are one; not a number counts as far away.
std::int32_t cell_of(double coordinate, double cells_per_metre) noexcept {
  const double place = coordinate * cells_per_metre;
  const double bounded = place > -1e9 ? (place < 1e9 ? place : 1e9) : -1e9;
  const auto cell = static_cast<std::int32_t>(bounded);
  return cell - (bounded < cell);
}

}  // namespace

BallSearch::BallSearch(std::size_t ball_room, std::size_t pair_room)
    : pair_room_(pair_room),
      anchors_(ball_room),
      starts_(std::bit_ceil(2 * ball_room + 16) + 1),
      buckets_(ball_room),
      sorted_(ball_room + room_beside(ball_room)),
      slots_(ball_room),
      crowd_(sorted_.size() + 1),
      hits_(sorted_.size() + 1),
      is_renewed_(ball_room),
      ends_(ball_room + 1) {
  strays_.reserve(ball_room);
  found_.reserve(pair_room);
  pairs_.reserve(pair_room);
}

BallSearch::Cell BallSearch::cell_at(double x, double y, double z) const noexcept {
  return {cell_of(x, cells_per_metre_), cell_of(y, cells_per_metre_), cell_of(z, cells_per_metre_)};
}

void BallSearch::sort_into_cells(const VecView& positions, std::span<const double> radii,
                                 std::span<const std::uint8_t> idle) noexcept {
  count_ = static_cast<std::uint32_t>(radii.size());
  count_beside_ = 0;
  drift_.setZero();
  std::copy_n(positions.x.begin(), count_, anchors_.x.begin());
  std::copy_n(positions.y.begin(), count_, anchors_.y.begin());
  std::copy_n(positions.z.begin(), count_, anchors_.z.begin());
  std::fill_n(is_renewed_.begin(), count_, std::uint8_t{1});
  any_idle_ = std::find(idle.begin(), idle.end(), std::uint8_t{1}) != idle.end();
  mask_ = static_cast<std::uint32_t>(std::bit_ceil(2 * radii.size() + 16) - 1);
  std::fill_n(starts_.begin(), mask_ + 2, 0u);
  const auto cell = [&](std::uint32_t i) { return cell_at(positions.x[i], positions.y[i], positions.z[i]); };
  for (std::uint32_t i = 0; i < count_; ++i) ++starts_[buckets_[i] = bucket(cell(i))];
  std::uint32_t end = 0;
  for (std::uint32_t b = 0; b <= mask_ + 1; ++b) starts_[b] = end += starts_[b];
  for (std::uint32_t i = count_; i-- > 0;) {
    const std::uint32_t slot = slots_[i] = --starts_[buckets_[i]];
    sorted_[slot] = {positions.x[i], positions.y[i], positions.z[i], radii[i], cell(i), i, idle[i] == 1};
  }
}

// All whom the balls of a cell may meet: first themselves, then those further on in half of the 27 cells round it,
// since balls in the other half find these; last those who find nobody.
void BallSearch::gather_crowd(std::uint32_t begin, std::uint32_t end) noexcept {
  crowd_.count = 0;
  const auto is_idle = [](const Ball& ball) { return ball.idle; };
  if (std::all_of(sorted_.begin() + begin, sorted_.begin() + end, is_idle)) return;
  const Cell c = sorted_[begin].cell;
  const std::uint32_t own = bucket(c), next = (own + 1) & mask_;
  add_to_crowd(begin, starts_[own + 1], c, Take::active);
  add_to_crowd(starts_[next], starts_[next + 1], c, Take::active);
  for (const auto& [y, z] : {std::pair{1, 0}, std::pair{-1, 1}, std::pair{0, 1}, std::pair{1, 1}}) {
    add_row_to_crowd({c.x, c.y + y, c.z + z}, Take::active);
  }
  if (!any_idle_) return;
  for (const int z : {-1, 0, 1}) {
    for (const int y : {-1, 0, 1}) add_row_to_crowd({c.x, c.y + y, c.z + z}, Take::idle);
  }
}

// Those of the row only: others may share its buckets.
void BallSearch::add_to_crowd(std::uint32_t begin, std::uint32_t end, const Cell& row, Take take) noexcept {
  std::uint32_t n = crowd_.count;
  for (std::uint32_t s = begin; s < end; ++s) {
    const Ball& ball = sorted_[s];
    crowd_.x[n] = ball.x, crowd_.y[n] = ball.y, crowd_.z[n] = ball.z;
    crowd_.radius[n] = ball.radius, crowd_.index[n] = ball.index;
    n += (ball.cell.y == row.y) & (ball.cell.z == row.z) & (take == Take::all || ball.idle == (take == Take::idle));
  }
  crowd_.count = n;
}

// In a cell and the two on either side of it.
void BallSearch::add_row_to_crowd(const Cell& middle, Take take) noexcept {
  const std::uint32_t first = bucket({middle.x - 1, middle.y, middle.z});
  if (first + 2 <= mask_) return add_to_crowd(starts_[first], starts_[first + 3], middle, take);
  for (std::uint32_t k = 0; k < 3; ++k) {
    const std::uint32_t wrapped = (first + k) & mask_;
    add_to_crowd(starts_[wrapped], starts_[wrapped + 1], middle, take);
  }
}

void BallSearch::add_those_beside_to_crowd() noexcept {
  for (std::uint32_t s = count_; s < count_ + count_beside_; ++s) add_to_crowd(s, s + 1, sorted_[s].cell, Take::all);
}

void BallSearch::measure_crowd(const Ball& ball, std::uint32_t begin) noexcept {
  const double *const x = crowd_.x.data(), *const y = crowd_.y.data(), *const z = crowd_.z.data();
  const double* const radius = crowd_.radius.data();
  double* const excess = crowd_.excess.data();
  for (std::uint32_t k = begin; k < crowd_.count; ++k) {
    const double dx = ball.x - x[k], dy = ball.y - y[k], dz = ball.z - z[k];
    const double reach = (ball.radius + radius[k]) + margin_;
    excess[k] = ((dx * dx + dy * dy) + dz * dz) - reach * reach;
  }
}

// By the second ball, then by the first.
void BallSearch::sort_pairs() noexcept {
  pairs_.resize(found_.size());
  const auto sort_by = [&](const auto& ball_of) {
    std::fill_n(ends_.begin(), count_ + 1, 0u);
    for (const std::uint64_t key : found_) ++ends_[ball_of(BallPair(key)) + 1];
    for (std::size_t i = 0; i < count_; ++i) ends_[i + 1] += ends_[i];
    for (const std::uint64_t key : found_) pairs_[ends_[ball_of(BallPair(key))]++] = key;
  };
  sort_by([](const BallPair& pair) { return pair.second; });
  std::swap(found_, pairs_);
  sort_by([](const BallPair& pair) { return pair.first; });
}

// Less than half the margin, so that rounding errors do not matter. A stretch of balls at a time, most of them without
// a stray: this part the compiler makes vectors of.
bool BallSearch::find_strays(const VecView& positions) noexcept {
  constexpr std::uint32_t kStretch = 64;
  const double most = (0.49 * margin_) * (0.49 * margin_), dx = drift_.x(), dy = drift_.y(), dz = drift_.z();
  const double *const x = positions.x.data(), *const y = positions.y.data(), *const z = positions.z.data();
  const double *const ax = anchors_.x.data(), *const ay = anchors_.y.data(), *const az = anchors_.z.data();
  std::uint32_t fresh = 0;
  strays_.clear();
  for (std::uint32_t begin = 0; begin < count_; begin += kStretch) {
    double squares[kStretch];
    const std::uint32_t size = std::min(kStretch, count_ - begin);
    std::uint64_t near = 0;
    for (std::uint32_t k = 0; k < size; ++k) {
      const std::uint32_t i = begin + k;
      const double mx = (x[i] - dx) - ax[i], my = (y[i] - dy) - ay[i], mz = (z[i] - dz) - az[i];
      squares[k] = (mx * mx + my * my) + mz * mz;
      near += squares[k] < most ? 1 : 0;
    }
    for (std::uint32_t k = 0; near < size && k < size; ++k) {
      if (squares[k] < most) continue;
      strays_.push_back(begin + k);
      fresh += slots_[begin + k] < count_;
    }
  }
  return count_beside_ + fresh <= room_beside(count_);
}

// Its place beside the grid, from now on.
BallSearch::Ball& BallSearch::pick_up(std::uint32_t stray) noexcept {
  if (slots_[stray] < count_) {
    Ball& left = sorted_[slots_[stray]];
    slots_[stray] = count_ + count_beside_++;
    sorted_[slots_[stray]] = left;
    left.x = kNowhere;
  }
  return sorted_[slots_[stray]];
}

}  // namespace crumble
