#include "crumble/device/scripted.hpp"

#include "device/check.hpp"

namespace crumble {
namespace {

class NullDevice final : public Device {
 public:
  NullDevice(const Pose& pose, double tick) : pose_(renormalized(pose)), tick_(tick) {
    info_ = {.name = "null device", .kind = DeviceKind::null, .rate = 1 / tick, .step_locked = true};
  }
  const DeviceInfo& info() const noexcept override { return info_; }
  ReadStatus read(DeviceSample& sample) noexcept override {
    sample = {.time = static_cast<double>(count_) * tick_, .pose = pose_, .sequence = count_};
    ++count_;
    return ReadStatus::ok;
  }
  void write(const Vec3&, const Vec3&) noexcept override {}

 private:
  DeviceInfo info_;
  Pose pose_;
  double tick_;
  std::uint64_t count_ = 0;
};

class PressDevice final : public Device {
 public:
  PressDevice(const PressOptions& options, double tick)
      : start_(renormalized(options.start)),
        direction_(normalized(options.direction)),
        speed_(options.speed),
        depth_(options.depth),
        end_(options.depth / options.speed + options.hold),
        tick_(tick) {
    info_ = {.name = "scripted press", .kind = DeviceKind::press, .rate = 1 / tick, .step_locked = true};
  }
  const DeviceInfo& info() const noexcept override { return info_; }
  ReadStatus read(DeviceSample& sample) noexcept override {
    const double time = static_cast<double>(count_) * tick_;
    const double travel = speed_ * time;
    const bool moving = travel < depth_;
    const bool finished = device::is_over(time, end_, tick_);
    sample = {.time = time, .pose = start_, .sequence = count_};
    sample.pose.position += (moving ? travel : depth_) * direction_;
    if (moving) sample.linear_velocity = speed_ * direction_;
    if (finished) sample.flags = sample_flag::kFinished;
    ++count_;
    return finished ? ReadStatus::finished : ReadStatus::ok;
  }
  void write(const Vec3&, const Vec3&) noexcept override {}

 private:
  DeviceInfo info_;
  Pose start_;
  Vec3 direction_;  // unit
  double speed_, depth_, end_, tick_;
  std::uint64_t count_ = 0;
};

}  // namespace

std::unique_ptr<Device> open_null(const Pose& pose, double tick) {
  device::require_pose("pose", pose);
  require_positive("tick", tick);
  return std::make_unique<NullDevice>(pose, tick);
}

std::unique_ptr<Device> open_press(const PressOptions& options, double tick) {
  device::require_pose("press.start", options.start);
  device::require_vector("press.direction", options.direction);
  require_positive("|press.direction|", norm(options.direction));
  require_positive("press.speed", options.speed);
  require_positive("press.depth", options.depth);
  device::require_not_negative("press.hold", options.hold);
  require_positive("tick", tick);
  return std::make_unique<PressDevice>(options, tick);
}

}  // namespace crumble
