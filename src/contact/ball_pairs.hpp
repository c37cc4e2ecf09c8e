// The pairs that may touch soon, with what they remember.
#pragma once

#include <cstddef>
#include <cstdint>

#include "crumble/base/memory.hpp"
#include "crumble/base/vec_array.hpp"

namespace crumble {

// Two balls in one number, so that pairs in order are numbers in order.
struct BallPair {
  std::uint32_t first, second;  // places in BallRoster::nodes(), first < second

  explicit BallPair(std::uint64_t key) noexcept
      : first(static_cast<std::uint32_t>(key >> 32)), second(static_cast<std::uint32_t>(key)) {}
  static std::uint64_t key(std::uint32_t first, std::uint32_t second) noexcept {
    return std::uint64_t{first} << 32 | second;
  }
};

// One array per number; the first `count` of each are in use, ascending by key.
struct BallPairs {
  explicit BallPairs(std::size_t room) : keys(room), sum(room), reach(room), touched_at(room), shear(room) {}

  std::size_t count = 0;
  Vector<std::uint64_t> keys;        // BallPair
  Vector<double> sum;                // square of the sum of the radii
  Vector<double> reach;              // square of the contact distance: at most `sum`
  Vector<std::uint64_t> touched_at;  // the last step in which they did
  VecArray shear;                    // of the friction's spring after that step, metres

  void copy(std::size_t to, const BallPairs& from, std::size_t k) noexcept {
    keys[to] = from.keys[k], sum[to] = from.sum[k], reach[to] = from.reach[k], touched_at[to] = from.touched_at[k];
    shear.x[to] = from.shear.x[k], shear.y[to] = from.shear.y[k], shear.z[to] = from.shear.z[k];
  }
  /// After step `now`, it does not start from zero.
  bool is_sheared(std::size_t k, std::uint64_t now) const noexcept {
    return touched_at[k] == now && (shear.x[k] != 0 || shear.y[k] != 0 || shear.z[k] != 0);
  }
  /// Others are as if never seen.
  bool remembers(std::size_t k, std::uint64_t now) const noexcept { return reach[k] < sum[k] || is_sheared(k, now); }
};

}  // namespace crumble
