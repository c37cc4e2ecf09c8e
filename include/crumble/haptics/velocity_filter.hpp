// Velocity from positions that come in steps.
#pragma once

#include <array>
#include <cstdint>

#include "crumble/base/vec.hpp"

namespace crumble {

/// First-order adaptive windowing (Janabi-Sharifi, Hayward and Chen, IEEE Trans. Control Syst. Technol. 8, 2000), each
/// axis by itself: the slope over the longest window in which a straight line explains all positions to within one
/// encoder step. Short, so quick, while the hand is fast; long, so quiet, while it is slow. At most kMostTime or
/// kLeastSamples long: longer windows lag and made loops ring (docs/haptics.md). Without encoder steps: the last
/// difference.
class VelocityFilter {
 public:
  /// `step`: m, of the encoder, 0: none.
  explicit VelocityFilter(double step) : step_(step) {}

  /// m/s at `position`, `passed` seconds (> 0) after the one before.
  Vec3 take(const Vec3& position, double passed) noexcept;
  void forget() noexcept { count_ = 0; }

  static constexpr double kMostTime = 5e-3;  // s
  static constexpr std::uint32_t kLeastSamples = 5;
  static constexpr std::uint32_t kMostSamples = 64;

 private:
  struct Place {
    Vec3 position = Vec3::Zero();
    double time = 0;
  };
  double slope(int axis) const noexcept;
  const Place& back(std::uint32_t k) const noexcept { return places_[(newest_ + kSize - k) % kSize]; }

  static constexpr std::uint32_t kSize = kMostSamples + 1;
  std::array<Place, kSize> places_{};
  std::uint32_t newest_ = 0, count_ = 0;
  double step_;
};

}  // namespace crumble
