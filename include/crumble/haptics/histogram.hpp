// Times, counted into bins: written by one thread, read by any.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace crumble {

/// Bins of a 32nd of the time itself (3 %), from 1 ns to 2 s and more; nothing is ever lost or sorted.
class Histogram {
 public:
  /// Seconds; below 0 counts as 0. One thread.
  void add(double seconds) noexcept;
  void clear() noexcept;

  // Any thread; of what has been added so far

  std::uint64_t count() const noexcept { return count_.load(std::memory_order_relaxed); }
  double greatest() const noexcept;
  /// The time, s, that a share in [0, 1] of them stays within; 0 when there are none.
  double quantile(double share) const noexcept;

 private:
  static constexpr std::uint32_t kFine = 32, kOctaves = 26, kBins = kFine * (kOctaves + 1);

  std::array<std::atomic<std::uint64_t>, kBins> bins_{};
  std::atomic<std::uint64_t> count_{0}, greatest_{0};
};

}  // namespace crumble
