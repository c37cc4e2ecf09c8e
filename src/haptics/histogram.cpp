#include "crumble/haptics/histogram.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace crumble {
namespace {

constexpr double kNano = 1e-9;

void raise(std::atomic<std::uint64_t>& count) noexcept {
  count.store(count.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
}

}  // namespace

// Nanoseconds below 32 have a bin each; above, every doubling is shared out among 32 bins.
void Histogram::add(double seconds) noexcept {
  const double nanos = std::clamp(seconds / kNano, 0.0, 9e18);  // NaN falls to 0
  const auto value = nanos > 0 ? static_cast<std::uint64_t>(nanos) : 0;
  const auto octave = value < kFine ? 0u : static_cast<std::uint32_t>(std::bit_width(value)) - 5u;
  const auto fine = static_cast<std::uint32_t>(octave == 0 ? value : (value >> (octave - 1)) - kFine);
  raise(bins_[std::min(octave * kFine + fine, kBins - 1)]);
  raise(count_);
  greatest_.store(std::max(greatest_.load(std::memory_order_relaxed), value), std::memory_order_relaxed);
}

void Histogram::clear() noexcept {
  for (auto& bin : bins_) bin.store(0, std::memory_order_relaxed);
  count_.store(0, std::memory_order_relaxed);
  greatest_.store(0, std::memory_order_relaxed);
}

double Histogram::greatest() const noexcept {
  return kNano * static_cast<double>(greatest_.load(std::memory_order_relaxed));
}

double Histogram::quantile(double share) const noexcept {
  const auto wanted = static_cast<std::uint64_t>(std::ceil(std::clamp(share, 0.0, 1.0) * static_cast<double>(count())));
  std::uint64_t seen = 0;
  for (std::uint32_t bin = 0; bin < kBins; ++bin) {
    seen += bins_[bin].load(std::memory_order_relaxed);
    if (seen < std::max<std::uint64_t>(wanted, 1)) continue;
    const std::uint32_t octave = bin / kFine, fine = bin % kFine;
    const double upper = octave == 0 ? fine : std::ldexp(fine + kFine + 1.0, static_cast<int>(octave) - 1);
    return std::min(kNano * upper, greatest());
  }
  return greatest();
}

}  // namespace crumble
