#include "crumble/device/wander.hpp"

#include <cmath>
#include <limits>

#include "crumble/base/random.hpp"
#include "device/check.hpp"
#include "device/minimum_jerk.hpp"
#include "device/turn.hpp"

namespace crumble {
namespace {

constexpr double kShortest = 1.0 / 8;  // of the box's diagonal: shorter moves would take no time

Vec3 random_turn(Random& random, double most) {
  const double z = random.uniform(-1, 1), angle = random.uniform(0, 2 * kPi), radius = std::sqrt(1 - z * z);
  return random.uniform(0, most) * Vec3(radius * cos_exact(angle), radius * sin_exact(angle), z);
}

class WanderDevice final : public Device {
 public:
  WanderDevice(const WanderOptions& options, double tick) : options_(options), random_(options.seed), tick_(tick) {
    options_.start = renormalized(options.start);
    info_ = {.name = "wandering hand",
             .kind = DeviceKind::wander,
             .measured =
                 quantity::kPosition | quantity::kOrientation | quantity::kLinearVelocity | quantity::kAngularVelocity,
             .rate = 1 / tick,
             .step_locked = true};
    set_out();
  }
  const DeviceInfo& info() const noexcept override { return info_; }
  ReadStatus read(DeviceSample& sample) noexcept override {
    const double time = static_cast<double>(count_) * tick_;
    const bool finished = options_.seconds > 0 && device::is_over(time, options_.seconds, tick_);
    while (time >= leave_) set_out();
    sample = at(time);
    sample.sequence = count_;
    if (finished) sample.flags = sample_flag::kFinished;
    ++count_;
    return finished ? ReadStatus::finished : ReadStatus::ok;
  }
  void write(const Vec3&, const Vec3&) noexcept override {}

 private:
  struct Place {
    Vec3 move = Vec3::Zero();  // m, from the start
    Vec3 turn = Vec3::Zero();  // unit axis times radians, likewise
  };

  /// To the next place, at the time to leave this one.
  void set_out() noexcept {
    from_ = to_, begin_ = leave_;
    to_ = {random_move(), random_turn(random_, options_.max_turn)};
    const double speed = random_.uniform(options_.slowest, options_.fastest);
    arrive_ = begin_ + norm(to_.move - from_.move) / speed;
    leave_ = arrive_ + random_.uniform(0, options_.max_pause);
    if (options_.seconds > 0 && arrive_ > options_.seconds) {
      to_ = from_, arrive_ = begin_, leave_ = std::numeric_limits<double>::infinity();
    }
  }

  /// A random point of the box; when it is too near, half-way from there to the corner that is farthest from here,
  /// which is at least 1/4 - kShortest/2 of the diagonal away.
  Vec3 random_move() noexcept {
    Vec3 move, corner;
    for (int axis = 0; axis < 3; ++axis) {
      const double low = options_.low[axis], high = options_.high[axis], here = from_.move[axis];
      move[axis] = random_.uniform(low, high);
      corner[axis] = here - low > high - here ? low : high;
    }
    const double least = kShortest * norm(options_.high - options_.low);
    return norm(move - from_.move) < least ? Vec3(0.5 * (move + corner)) : move;
  }

  DeviceSample at(double time) const noexcept {
    const bool moving = time < arrive_;
    const double length = moving ? arrive_ - begin_ : 1, s = moving ? (time - begin_) / length : 1;
    const double share = device::minimum_jerk(s), rate = device::minimum_jerk_rate(s) / length;
    const Vec3 move = to_.move - from_.move, turn = to_.turn - from_.turn;
    DeviceSample sample;
    sample.time = time;
    sample.pose.position = options_.start.position + (from_.move + share * move);
    const Vec3 turned = from_.turn + share * turn;
    sample.pose.orientation = multiply(device::turned_by(turned), options_.start.orientation);
    sample.linear_velocity = rate * move;
    sample.angular_velocity = device::turning(turned, rate * turn);
    return sample;
  }

  DeviceInfo info_;
  WanderOptions options_;
  Random random_;
  double tick_;
  std::uint64_t count_ = 0;
  Place from_, to_;
  double begin_ = 0, arrive_ = 0, leave_ = 0;  // s: of the move, and of the pause after it
};

}  // namespace

std::unique_ptr<Device> open_wander(const WanderOptions& options, double tick) {
  constexpr double kMost = std::numeric_limits<double>::max();
  require_positive("tick", tick);
  device::require_pose("wander.start", options.start);
  for (int axis = 0; axis < 3; ++axis) {
    const std::string name = std::string(".") + "xyz"[axis];
    require_in_range("wander.low" + name, options.low[axis], -kMost, 0);
    require_in_range("wander.high" + name, options.high[axis], 0, kMost);
  }
  const double diagonal = norm(options.high - options.low);
  require_positive("|wander.high - wander.low|", diagonal);
  require_positive("wander.slowest", options.slowest);
  require_in_range("wander.fastest", options.fastest, options.slowest, kShortest * diagonal / tick);
  device::require_speed("wander.fastest", options.fastest);
  device::require_not_negative("wander.max_pause", options.max_pause);
  require_in_range("wander.max_turn", options.max_turn, 0, kPi);
  device::require_not_negative("wander.seconds", options.seconds);
  return std::make_unique<WanderDevice>(options, tick);
}

}  // namespace crumble
