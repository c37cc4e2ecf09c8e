// Keeps what passes between a device and the loop.
#pragma once

#include <memory>
#include <string>

#include "crumble/base/memory.hpp"
#include "crumble/device/trajectory.hpp"

namespace crumble {

/// A device around a device: passes everything through and keeps each new sample together with the first force and
/// torque written after it: a later one, as when a loop stops, is no answer to it. All memory is taken at construction.
/// A sample is dropped, and counted, when the capacity is used up or when its time does not come after the last one
/// kept. The samples of a finished device are not kept.
class Recorder final : public Device {
 public:
  /// `capacity` in samples, 1 to kMaxTrajectoryRows (out_of_range; no_memory when it cannot be had).
  Recorder(std::unique_ptr<Device> device, std::size_t capacity);

  const DeviceInfo& info() const noexcept override { return device_->info(); }
  [[nodiscard]] ReadStatus read(DeviceSample& sample) noexcept override;
  void write(const Vec3& force, const Vec3& torque) noexcept override;
  void start_servo(const ServoTick& tick) override { device_->start_servo(tick); }
  void stop_servo() noexcept override { device_->stop_servo(); }
  const char* error_text() const noexcept override { return device_->error_text(); }

  std::size_t size() const noexcept { return size_; }
  std::size_t dropped() const noexcept { return dropped_; }
  /// All columns, and header lines with the device, its rate, what it measures, and the drops when there were any.
  Trajectory trajectory() const;

 private:
  std::unique_ptr<Device> device_;
  Vector<TrajectoryRow> rows_;  // capacity long
  std::size_t size_ = 0;
  std::size_t dropped_ = 0;
  bool last_kept_ = false;  // whether the next write belongs to the last row
};

}  // namespace crumble
