#include "crumble/haptics/velocity_filter.hpp"

#include <algorithm>
#include <cmath>

namespace crumble {

Vec3 VelocityFilter::take(const Vec3& position, double passed) noexcept {
  const double time = count_ > 0 ? back(0).time + passed : 0;
  newest_ = (newest_ + 1) % kSize;
  places_[newest_] = {position, time};
  count_ = std::min(count_ + 1, kSize);
  return {slope(0), slope(1), slope(2)};
}

double VelocityFilter::slope(int axis) const noexcept {
  const Place& now = back(0);
  const std::uint32_t most = step_ > 0 ? count_ - 1 : std::min(count_ - 1, 1u);
  double best = 0;
  for (std::uint32_t w = 1; w <= most; ++w) {
    const double length = now.time - back(w).time;
    if (w > kLeastSamples && length > kMostTime * (1 + 1e-9)) break;
    const double slope = (now.position[axis] - back(w).position[axis]) / length;
    for (std::uint32_t k = 1; k < w; ++k) {
      const double line = now.position[axis] - slope * (now.time - back(k).time);
      if (std::abs(line - back(k).position[axis]) > step_ * (1 + 1e-9)) return best;
    }
    best = slope;
  }
  return best;
}

}  // namespace crumble
