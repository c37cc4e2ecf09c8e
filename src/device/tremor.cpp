#include "crumble/device/tremor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "crumble/base/random.hpp"
#include "crumble/base/transcendental.hpp"
#include "device/check.hpp"
#include "device/minimum_jerk.hpp"

namespace crumble {
namespace {

constexpr int kWaves = 8;      // along each axis
constexpr double kFade = 1.0;  // s

/// The motion without a device around it.
class Tremor {
 public:
  struct Motion {
    Vec3 offset = Vec3::Zero();    // m
    Vec3 velocity = Vec3::Zero();  // m/s
  };

  explicit Tremor(const TremorOptions& options)
      : size_(options.amplitude / std::sqrt(3 * kWaves / 2.0)),  // the mean square of a sinusoid is half of its size's
        seconds_(options.seconds),
        fade_(options.seconds > 0 ? std::min(kFade, options.seconds / 2) : kFade) {
    Random random(options.seed);
    const double band = (options.high - options.low) / kWaves;
    for (auto& axis : waves_) {
      for (int i = 0; i < kWaves; ++i) {
        Wave& wave = axis[static_cast<std::size_t>(i)];
        wave.frequency = options.low + (i + random.uniform(0.25, 0.75)) * band;
        wave.phase = random.uniform();
      }
    }
  }

  double seconds() const noexcept { return seconds_; }

  Motion at(double time) const noexcept {
    const double left = seconds_ > 0 ? std::min(time, seconds_ - time) : time;  // to the nearer end
    if (!(left > 0)) return {};
    const double s = left / fade_;
    const double share = s < 1 ? device::minimum_jerk(s) : 1;
    const double growth = s < 1 ? device::minimum_jerk_rate(s) / fade_ : 0;
    Motion out;
    for (int axis = 0; axis < 3; ++axis) {
      double sine = 0, cosine = 0;  // of unit waves, and of their velocities
      for (const Wave& wave : waves_[static_cast<std::size_t>(axis)]) {
        const double turns = wave.frequency * time;
        const double angle = 2 * kPi * ((turns - std::floor(turns)) + wave.phase);  // small, however long it runs
        sine += sin_exact(angle);
        cosine += 2 * kPi * wave.frequency * cos_exact(angle);
      }
      out.offset[axis] = size_ * share * sine;
      out.velocity[axis] = size_ * (share * cosine + (left < time ? -growth : growth) * sine);
    }
    return out;
  }

 private:
  struct Wave {
    double frequency = 0;  // Hz
    double phase = 0;      // turns
  };
  std::array<std::array<Wave, kWaves>, 3> waves_;
  double size_;     // m, of each wave
  double seconds_;  // s; 0: without end
  double fade_;     // s
};

class TremorDevice final : public Device {
 public:
  TremorDevice(const TremorOptions& options, double tick)
      : tremor_(options), start_(renormalized(options.start)), tick_(tick) {
    info_ = {.name = "scripted tremor",
             .kind = DeviceKind::tremor,
             .measured = quantity::kPosition | quantity::kOrientation | quantity::kLinearVelocity,
             .rate = 1 / tick,
             .step_locked = true};
  }
  const DeviceInfo& info() const noexcept override { return info_; }
  ReadStatus read(DeviceSample& sample) noexcept override {
    const double time = static_cast<double>(count_) * tick_;
    const bool finished = tremor_.seconds() > 0 && device::is_over(time, tremor_.seconds(), tick_);
    const Tremor::Motion motion = tremor_.at(time);
    sample = {.time = time, .pose = start_, .linear_velocity = motion.velocity, .sequence = count_};
    sample.pose.position += motion.offset;
    if (finished) sample.flags = sample_flag::kFinished;
    ++count_;
    return finished ? ReadStatus::finished : ReadStatus::ok;
  }
  void write(const Vec3&, const Vec3&) noexcept override {}

 private:
  DeviceInfo info_;
  Tremor tremor_;
  Pose start_;
  double tick_;
  std::uint64_t count_ = 0;
};

class AddedTremor final : public Device {
 public:
  AddedTremor(std::unique_ptr<Device> device, const TremorOptions& options)
      : device_(std::move(device)), info_(device_->info()), tremor_(options) {
    info_.name += " with tremor";
  }
  const DeviceInfo& info() const noexcept override { return info_; }
  ReadStatus read(DeviceSample& sample) noexcept override {
    const ReadStatus status = device_->read(sample);
    if (status == ReadStatus::ok) {
      const Tremor::Motion motion = tremor_.at(sample.time);
      sample.linear_velocity += motion.velocity;
      offset_ = motion.offset;
    }
    if (status == ReadStatus::ok || status == ReadStatus::finished) sample.pose.position += offset_;
    return status;
  }
  void write(const Vec3& force, const Vec3& torque) noexcept override { device_->write(force, torque); }
  void start_servo(const ServoTick& tick) override { device_->start_servo(tick); }
  void stop_servo() noexcept override { device_->stop_servo(); }
  const char* error_text() const noexcept override { return device_->error_text(); }

 private:
  std::unique_ptr<Device> device_;
  DeviceInfo info_;
  Tremor tremor_;
  Vec3 offset_ = Vec3::Zero();  // m, of the last sample
};

/// `rate` in Hz; 0: the device does not tell.
void require_tremor(const TremorOptions& options, double rate) {
  require_positive("tremor.amplitude", options.amplitude);
  require_positive("tremor.low", options.low);
  require_in_range("tremor.high", options.high, options.low, rate > 0 ? rate / 2 : std::numeric_limits<double>::max());
  require_positive("tremor.high - tremor.low", options.high - options.low);
  device::require_speed("tremor.amplitude * tremor.high", options.amplitude * options.high);
  device::require_not_negative("tremor.seconds", options.seconds);
}

}  // namespace

std::unique_ptr<Device> open_tremor(const TremorOptions& options, double tick) {
  require_positive("tick", tick);
  device::require_pose("tremor.start", options.start);
  require_tremor(options, 1 / tick);
  return std::make_unique<TremorDevice>(options, tick);
}

std::unique_ptr<Device> add_tremor(std::unique_ptr<Device> device, const TremorOptions& options) {
  if (!device) throw Error(Code::null, "tremor: device is null");
  require_tremor(options, device->info().rate);
  return std::make_unique<AddedTremor>(std::move(device), options);
}

}  // namespace crumble
