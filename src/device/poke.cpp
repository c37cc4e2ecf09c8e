#include "crumble/device/poke.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "device/check.hpp"
#include "device/minimum_jerk.hpp"

namespace crumble {
namespace {

class PokeDevice final : public Device {
 public:
  PokeDevice(const PokeOptions& options, double tick)
      : options_(options),
        direction_(normalized(options.direction)),
        period_(options.in + options.hold + options.out + options.rest),
        last_(options.count - 1),
        end_(period_ * last_ + (options.in + options.hold + options.out)),
        tick_(tick) {
    options_.start = renormalized(options.start);
    info_ = {.name = "scripted poke",
             .kind = DeviceKind::poke,
             .measured = quantity::kPosition | quantity::kOrientation | quantity::kLinearVelocity,
             .rate = 1 / tick,
             .step_locked = true};
  }
  const DeviceInfo& info() const noexcept override { return info_; }
  ReadStatus read(DeviceSample& sample) noexcept override {
    const double time = static_cast<double>(count_) * tick_;
    const bool finished = device::is_over(time, end_, tick_);
    const double poke = std::min(std::floor(time / period_), last_);
    const Travel now = travel(std::max(time - poke * period_, 0.0));
    sample = {.time = time, .pose = options_.start, .sequence = count_};
    sample.pose.position += now.depth * direction_;
    sample.linear_velocity = now.speed * direction_;
    if (finished) sample.flags = sample_flag::kFinished;
    ++count_;
    return finished ? ReadStatus::finished : ReadStatus::ok;
  }
  void write(const Vec3&, const Vec3&) noexcept override {}

 private:
  struct Travel {
    double depth, speed;  // m, m/s, along direction_
  };

  /// `time` since one poke began.
  Travel travel(double time) const noexcept {
    const PokeOptions& o = options_;
    if (time < o.in) {
      const double s = time / o.in;
      return {o.depth * device::minimum_jerk(s), o.depth * device::minimum_jerk_rate(s) / o.in};
    }
    if (time < o.in + o.hold) return {o.depth, 0};
    const double s = (time - (o.in + o.hold)) / o.out;
    if (s >= 1) return {0, 0};
    return {o.depth * (1 - device::minimum_jerk(s)), -o.depth * device::minimum_jerk_rate(s) / o.out};
  }

  DeviceInfo info_;
  PokeOptions options_;
  Vec3 direction_;  // unit
  double period_;   // s, from poke to poke
  double last_;     // number of the last poke, from 0
  double end_, tick_;
  std::uint64_t count_ = 0;
};

}  // namespace

std::unique_ptr<Device> open_poke(const PokeOptions& options, double tick) {
  device::require_pose("poke.start", options.start);
  device::require_vector("poke.direction", options.direction);
  require_positive("|poke.direction|", norm(options.direction));
  require_positive("poke.depth", options.depth);
  require_positive("poke.in", options.in);
  device::require_not_negative("poke.hold", options.hold);
  require_positive("poke.out", options.out);
  device::require_not_negative("poke.rest", options.rest);
  require_in_range("poke.count", options.count, 1, std::numeric_limits<std::uint32_t>::max());
  require_finite("poke.count * (poke.in + poke.hold + poke.out + poke.rest)",
                 options.count * (options.in + options.hold + options.out + options.rest));
  device::require_speed("poke.depth / poke.in", options.depth / options.in);
  device::require_speed("poke.depth / poke.out", options.depth / options.out);
  require_positive("tick", tick);
  return std::make_unique<PokeDevice>(options, tick);
}

}  // namespace crumble
