#include "crumble/device/hand.hpp"

#include <algorithm>
#include <cmath>

#include "crumble/base/memory.hpp"
#include "crumble/base/text.hpp"
#include "device/check.hpp"
#include "device/minimum_jerk.hpp"

namespace crumble {
namespace {

constexpr int kSubsteps = 64;
constexpr std::uint64_t kSlots = HandOptions::kMaxDelay + 1;

void require_points(const Vector<HandPoint>& points) {
  device::require_times("hand.points", points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    device::require_vector("hand.points[" + std::to_string(i) + "].move", points[i].move);
  }
}

// With substeps of h the integration stays bounded while k h^2 + 2 b h < 4 m (Jury).
void require_stable(const HandOptions& options, double tick) {
  const double h = tick / kSubsteps;
  const double least = (options.stiffness * h + 2 * options.damping) * h / 4;
  if (!(options.mass > least)) {
    throw Error(Code::out_of_range, "hand.mass must be above " + to_text(least) +
                                        " with this hand.stiffness, hand.damping and tick, is " +
                                        to_text(options.mass));
  }
}

HandOptions checked(const HandOptions& options, double tick) {
  device::require_pose("hand.start", options.start);
  require_points(options.points);
  require_positive("hand.mass", options.mass);
  device::require_not_negative("hand.stiffness", options.stiffness);
  device::require_not_negative("hand.damping", options.damping);
  device::require_not_negative("hand.friction", options.friction);
  device::require_not_negative("hand.encoder_step", options.encoder_step);
  require_in_range("hand.delay", options.delay, 0, HandOptions::kMaxDelay);
  require_positive("hand.device_mass", options.device_mass);
  require_in_range("hand.device_mass", options.device_mass, 0, options.mass);
  require_positive("hand.max_force", options.max_force);
  device::require_not_negative("hand.max_stiffness", options.max_stiffness);
  device::require_not_negative("hand.max_damping", options.max_damping);
  require_positive("tick", tick);
  require_stable(options, tick);
  return options;
}

// By the largest coordinate first: the square of a huge one is infinite.
Vec3 clamped(const Vec3& force, double most) {
  if (!is_finite(force)) return Vec3::Zero();
  const double largest = std::max({std::abs(force.x()), std::abs(force.y()), std::abs(force.z())});
  const Vec3 near = largest > most ? Vec3(force / largest * most) : force;
  const double size = norm(near);
  return size > most ? Vec3(near * (most / size)) : near;
}

// Dry friction takes at most all of it away, so that it stops and never turns round.
Vec3 slowed(const Vec3& velocity, double most) {
  const double speed = norm(velocity);
  return speed > most ? Vec3(velocity * (1 - most / speed)) : Vec3(Vec3::Zero());
}

}  // namespace

SimulatedHand::SimulatedHand(const HandOptions& options, double tick) : options_(checked(options, tick)), tick_(tick) {
  options_.start = renormalized(options_.start);
  if (options_.points.front().time > 0) options_.points.insert(options_.points.begin(), HandPoint{});
  position_ = options_.start.position;
  forces_.fill(Vec3::Zero());
  info_ = {.name = "simulated hand",
           .kind = DeviceKind::hand,
           .max_force = options_.max_force,
           .measured = quantity::kPosition | quantity::kOrientation,
           .rate = 1 / tick,
           .step_locked = true,
           .max_stiffness = options_.max_stiffness,
           .max_damping = options_.max_damping,
           .mass = options_.device_mass,
           .position_step = options_.encoder_step};
  if (options_.encoder_step == 0) info_.measured |= quantity::kLinearVelocity;
}

ReadStatus SimulatedHand::read(DeviceSample& sample) noexcept {
  if (count_ > 0) advance();
  const double time = static_cast<double>(count_) * tick_;
  const bool finished = device::is_over(time, options_.points.back().time, tick_);
  sample = {.time = time, .pose = {position_, options_.start.orientation}, .sequence = count_};
  if (const double step = options_.encoder_step; step > 0) {
    for (double& x : sample.pose.position) x = std::round(x / step) * step;
  } else {
    sample.linear_velocity = velocity_;
  }
  if (finished) sample.flags = sample_flag::kFinished;
  ++count_;
  return finished ? ReadStatus::finished : ReadStatus::ok;
}

void SimulatedHand::write(const Vec3& force, const Vec3&) noexcept {
  const std::uint64_t now = count_ > 0 ? count_ - 1 : 0;
  forces_[now % kSlots] = clamped(force, options_.max_force);
}

Vec3 SimulatedHand::wanted(double time) const noexcept {
  const Vector<HandPoint>& points = options_.points;
  const auto next = std::upper_bound(points.begin(), points.end(), time,
                                     [](double t, const HandPoint& point) { return t < point.time; });
  const HandPoint& a = *(next - 1);
  if (next == points.end()) return options_.start.position + a.move;
  const double s = (time - a.time) / (next->time - a.time);
  return options_.start.position + (a.move + device::minimum_jerk(s) * (next->move - a.move));
}

// Through tick count_ - 1. Semi-implicit Euler, velocity first.
void SimulatedHand::advance() noexcept {
  const std::uint64_t now = count_ - 1;
  const Vec3 force = forces_[(now + kSlots - options_.delay) % kSlots];  // of before tick 0: still 0
  const Vec3 before = position_;
  const double begin = static_cast<double>(now) * tick_, h = tick_ / kSubsteps;
  const double stiction = h * options_.friction / options_.mass;
  for (int i = 0; i < kSubsteps; ++i) {
    const Vec3 spring = options_.stiffness * (wanted(begin + i * h) - position_);
    const Vec3 pull = spring - options_.damping * velocity_ + force;
    velocity_ = slowed(velocity_ + h * (pull / options_.mass), stiction);
    position_ += h * velocity_;
  }
  energy_given_ -= dot(force, position_ - before);
  forces_[count_ % kSlots] = forces_[now % kSlots];  // stays in force until the next write
}

std::unique_ptr<Device> open_hand(const HandOptions& options, double tick) {
  return std::make_unique<SimulatedHand>(options, tick);
}

}  // namespace crumble
