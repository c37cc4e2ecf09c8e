// Pairs of balls that are near each other, by a hashed grid. What is near is told by the balls' anchors: where they
// were when they were last searched for. A ball that has gone from its anchor by less than half the margin has met
// nobody whom its anchor was not near to; one that has gone further is a stray, and is anchored and searched anew. A
// few strays are searched one by one and then kept beside the grid; for many the grid is made anew.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include "ball_pairs.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/reserved_vector.hpp"
#include "crumble/base/vec_array.hpp"

namespace crumble {

class BallSearch {
 public:
  BallSearch(std::size_t ball_room, std::size_t pair_room);

  /// Anchors all balls where they are: then pairs() are all whose distance is less than the sum of their radii and
  /// `margin`, and that `accept(a, b)` admits, a < b, as indices into positions and radii. Those beyond the room for
  /// pairs are left out and counted. A pair with `idle` 1 at both balls is never admitted: they cost next to nothing.
  template <class Accept>
  void search_all(const VecView& positions, std::span<const double> radii, std::span<const std::uint8_t> idle,
                  double margin, const Accept& accept) noexcept;

  /// From here on all balls are thought to move by this in addition: what they have in common makes no strays.
  void drift(const Vec3& way) noexcept { drift_ += way; }
  /// Which balls are strays. False: so many that search_all() is to be preferred.
  bool find_strays(const VecView& positions) noexcept;
  std::span<const std::uint32_t> strays() const noexcept { return strays_; }
  /// Anchors the strays anew: then pairs() are those with one or two of them in it.
  template <class Accept>
  void search_strays(const VecView& positions, const Accept& accept) noexcept;

  /// Keys of BallPair, ascending.
  std::span<const std::uint64_t> pairs() const noexcept { return pairs_; }
  /// That pairs() tells all about.
  bool is_renewed(std::uint32_t ball) const noexcept { return is_renewed_[ball]; }
  std::size_t dropped() const noexcept { return dropped_; }

 private:
  // Cells that follow each other along x are buckets that follow each other, so three of them are one stretch of
  // sorted_. Rows of cells may share buckets.
  struct Cell {
    std::int32_t x, y, z;
  };
  struct Ball {
    double x, y, z, radius;  // of its anchor
    Cell cell;
    std::uint32_t index;
    bool idle;
  };
  // Who is around a cell, one array per number: tested in one long loop.
  struct Crowd {
    explicit Crowd(std::size_t room) : x(room), y(room), z(room), radius(room), excess(room), index(room) {}
    std::uint32_t count = 0;
    Vector<double> x, y, z, radius, excess;
    Vector<std::uint32_t> index;
  };
  enum class Take { active, idle, all };
  static constexpr double kNowhere = std::numeric_limits<double>::infinity();

  static std::size_t room_beside(std::size_t ball_count) noexcept { return ball_count / 8 + 4; }
  Cell cell_at(double x, double y, double z) const noexcept;
  void sort_into_cells(const VecView& positions, std::span<const double> radii,
                       std::span<const std::uint8_t> idle) noexcept;
  void sort_pairs() noexcept;
  Ball& pick_up(std::uint32_t stray) noexcept;
  std::uint32_t bucket(const Cell& c) const noexcept {
    const std::uint32_t row =
        static_cast<std::uint32_t>(c.y) * 0x9e3779b1u ^ static_cast<std::uint32_t>(c.z) * 0x85ebca77u;
    return ((row ^ row >> 15) + static_cast<std::uint32_t>(c.x)) & mask_;
  }
  static bool is_in(const Cell& a, const Cell& b) noexcept { return a.x == b.x && a.y == b.y && a.z == b.z; }
  void gather_crowd(std::uint32_t begin, std::uint32_t end) noexcept;
  void add_those_beside_to_crowd() noexcept;
  void measure_crowd(const Ball& ball, std::uint32_t begin) noexcept;
  void add_to_crowd(std::uint32_t begin, std::uint32_t end, const Cell& row, Take take) noexcept;
  void add_row_to_crowd(const Cell& middle, Take take) noexcept;
  template <class Accept>
  void meet_crowd(const Ball& ball, std::uint32_t begin, const Accept& accept) noexcept;

  std::size_t pair_room_, dropped_ = 0;
  std::uint32_t count_ = 0, count_beside_ = 0, mask_ = 0;
  double margin_ = 0, cells_per_metre_ = 0;
  Vec3 drift_ = Vec3::Zero();
  VecArray anchors_;  // less the drift since the last search_all()
  Vector<std::uint32_t> starts_, buckets_;
  Vector<Ball> sorted_;          // the grid's in the order of the buckets, then those beside it
  Vector<std::uint32_t> slots_;  // of each ball in sorted_
  Crowd crowd_;
  Vector<std::uint32_t> hits_;  // in the crowd
  Vector<std::uint8_t> is_renewed_;
  ReservedVector<std::uint32_t> strays_;
  ReservedVector<std::uint64_t> found_, pairs_;
  Vector<std::uint32_t> ends_;  // of the pairs of each ball
  bool any_idle_ = false;
};

// From the `begin`-th of the crowd on. No branch hangs on where a ball is: a processor could not foresee it.
template <class Accept>
void BallSearch::meet_crowd(const Ball& ball, std::uint32_t begin, const Accept& accept) noexcept {
  measure_crowd(ball, begin);
  std::size_t hits = 0;
  for (std::uint32_t k = begin; k < crowd_.count; ++k) {
    hits_[hits] = crowd_.index[k];
    hits += crowd_.excess[k] < 0;
  }
  for (std::size_t k = 0; k < hits; ++k) {
    const std::uint32_t first = std::min(ball.index, hits_[k]), second = std::max(ball.index, hits_[k]);
    if (!accept(first, second)) continue;
    if (found_.size() < pair_room_) {
      found_.push_back(BallPair::key(first, second));
    } else {
      ++dropped_;
    }
  }
}

template <class Accept>
void BallSearch::search_all(const VecView& positions, std::span<const double> radii, std::span<const std::uint8_t> idle,
                            double margin, const Accept& accept) noexcept {
  double largest = 0;
  for (const double radius : radii) largest = std::max(largest, radius);
  margin_ = margin;
  cells_per_metre_ = 1 / (2 * largest + margin);
  sort_into_cells(positions, radii, idle);
  found_.clear();
  dropped_ = 0;
  for (std::uint32_t s = 0, end = 0; s < count_; s = end) {
    while (end < count_ && is_in(sorted_[end].cell, sorted_[s].cell)) ++end;
    gather_crowd(s, end);
    std::uint32_t begin = 0;
    for (std::uint32_t center = s; center < end; ++center) {
      if (!sorted_[center].idle) meet_crowd(sorted_[center], ++begin, accept);
    }
  }
  sort_pairs();
}

template <class Accept>
void BallSearch::search_strays(const VecView& positions, const Accept& accept) noexcept {
  found_.clear();
  std::fill_n(is_renewed_.begin(), count_, std::uint8_t{0});
  for (const std::uint32_t stray : strays_) pick_up(stray).x = kNowhere, is_renewed_[stray] = 1;
  for (const std::uint32_t stray : strays_) {
    const Vec3 at = positions[stray] - drift_;
    Ball& ball = sorted_[slots_[stray]];
    anchors_.set(stray, at);
    ball.x = at.x(), ball.y = at.y(), ball.z = at.z();
    const Ball here = ball;
    ball.x = kNowhere;  // for itself
    const Cell c = cell_at(here.x, here.y, here.z);
    crowd_.count = 0;
    for (const int z : {-1, 0, 1}) {
      for (const int y : {-1, 0, 1}) add_row_to_crowd({c.x, c.y + y, c.z + z}, Take::all);
    }
    add_those_beside_to_crowd();
    meet_crowd(here, 0, accept);
    ball.x = here.x;
  }
  pairs_.assign(found_.begin(), found_.end());
  std::sort(pairs_.begin(), pairs_.end());
}

}  // namespace crumble
