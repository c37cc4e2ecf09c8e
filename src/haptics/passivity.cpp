#include "crumble/haptics/passivity.hpp"

#include <algorithm>
#include <cmath>

#include "crumble/base/error.hpp"

namespace crumble {
namespace {

constexpr double kUnknownDamping = 5;  // N s/m: what makers of such devices tell
constexpr double kStableShare = 0.5;   // of mass / tick: a held brake of 1 would stop the device, of 2 turn it back
constexpr double kLeastSpeed = 0.01;   // m/s: below it the controller would divide by what the encoder cannot see

}  // namespace

void check(const PassivityOptions& o) {
  require_finite("passivity.delay", o.delay);
  require_in_range("passivity.delay", o.delay, 0, kMostDelay);
  require_finite("passivity.max_damping", o.max_damping);
  require_in_range("passivity.max_damping", o.max_damping, 0, 1e3);
  require_positive("passivity.energy_credit", o.energy_credit);
}

double damping_limit(const PassivityOptions& options, const DeviceInfo& info, double tick) noexcept {
  const double told = info.max_damping > 0 ? info.max_damping : kUnknownDamping;
  const double mass = info.mass > 0 ? info.mass : kUnknownMass;
  return std::min(options.max_damping > 0 ? options.max_damping : told, kStableShare * mass / tick);
}

Mat3 needed_damping(const Mat3& stiffness, double tick, double mean, double delay) noexcept {
  return (tick * (0.5 * mean + delay)) * stiffness;
}

double size_of(const Mat3& m) noexcept {
  double most = 0;
  for (int row = 0; row < 3; ++row) {
    most = std::max(most, std::abs(m(row, 0)) + std::abs(m(row, 1)) + std::abs(m(row, 2)));
  }
  return most;
}

EnergyObserver::EnergyObserver(const PassivityOptions& options)
    : delay_(static_cast<std::size_t>(std::lround(options.delay))), most_credit_(options.energy_credit) {}

void EnergyObserver::moved(const Vec3& position) noexcept {
  const Vec3 way = placed_ ? Vec3(position - position_) : Vec3::Zero();
  const Sent& felt = sent_[(newest_ + sent_.size() - delay_) % sent_.size()];
  const double taken = -dot(felt.force, way);
  energy_.absorbed += taken;
  energy_.least = std::min(energy_.least, energy_.absorbed);
  energy_.injected -= dot(felt.damping, way);
  energy_.controlled -= dot(felt.control, way);
  energy_.credit = std::min(energy_.credit + taken, most_credit_);
  position_ = position;
  placed_ = true;
}

void EnergyObserver::sent(const Sent& sent) noexcept {
  newest_ = (newest_ + 1) % sent_.size();
  sent_[newest_] = sent;
}

void EnergyObserver::required(double damping) noexcept {
  energy_.required_damping = std::max(energy_.required_damping, damping);
}

Vec3 EnergyObserver::brake(const Vec3& velocity, double tick, double limit) const noexcept {
  if (energy_.credit >= 0) return Vec3::Zero();
  const double squared = std::max(squared_norm(velocity), kLeastSpeed * kLeastSpeed);
  return -std::min(limit, -energy_.credit / (tick * squared)) * velocity;
}

}  // namespace crumble
