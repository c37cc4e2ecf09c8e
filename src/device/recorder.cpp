#include "crumble/device/recorder.hpp"

#include <algorithm>
#include <new>

#include "crumble/base/error.hpp"
#include "crumble/base/text.hpp"
#include "crumble/device/open.hpp"
#include "device/info_lines.hpp"

namespace crumble {

Recorder::Recorder(std::unique_ptr<Device> device, std::size_t capacity) : device_(std::move(device)) {
  if (!device_) throw Error(Code::null, "recorder: device is null");
  if (capacity < 1 || capacity > kMaxTrajectoryRows) {
    throw Error(Code::out_of_range, "recorder: capacity must lie in [1, " + std::to_string(kMaxTrajectoryRows) +
                                        "], is " + std::to_string(capacity));
  }
  try {
    rows_.resize(capacity);  // written, not only reserved: the loop meets no page fault
  } catch (const std::bad_alloc&) {
    throw Error(Code::no_memory, "recorder: no memory for a capacity of " + std::to_string(capacity) + " samples");
  }
}

ReadStatus Recorder::read(DeviceSample& sample) noexcept {
  const ReadStatus status = device_->read(sample);
  last_kept_ = false;
  if (status != ReadStatus::ok) return status;
  if (size_ == rows_.size() || (size_ > 0 && !(sample.time > rows_[size_ - 1].time))) {
    ++dropped_;
    return status;
  }
  rows_[size_++] = {.time = sample.time,
                    .pose = sample.pose,
                    .linear_velocity = sample.linear_velocity,
                    .angular_velocity = sample.angular_velocity,
                    .buttons = sample.buttons,
                    .flags = sample.flags};
  last_kept_ = true;
  return status;
}

void Recorder::write(const Vec3& force, const Vec3& torque) noexcept {
  if (last_kept_) rows_[size_ - 1].force = force, rows_[size_ - 1].torque = torque;
  last_kept_ = false;
  device_->write(force, torque);
}

Trajectory Recorder::trajectory() const {
  Trajectory out;
  // A custom device chooses its name; only the file's own lines may end a line.
  std::string name = info().name;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  out.header = {"frame: device, right-handed, x right, y up, z towards the user",
                "units: m s N N*m rad",
                "quaternion: x y z w, tool to device",
                "device: " + name,
                std::string("kind: ") + to_string(info().kind),
                "nominal_rate_hz: " + to_text(info().rate),
                "force: as written to the device"};
  for (const std::string& line : device::info_lines(info())) out.header.push_back(line);
  if (dropped_ > 0) out.header.push_back("dropped: " + std::to_string(dropped_));
  out.columns = quantity::kAll;
  out.rows.assign(rows_.begin(), rows_.begin() + static_cast<std::ptrdiff_t>(size_));
  return out;
}

}  // namespace crumble
