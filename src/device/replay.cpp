#include "crumble/device/replay.hpp"

#include <algorithm>
#include <cmath>

#include "crumble/base/error.hpp"
#include "crumble/device/pose_curve.hpp"
#include "device/info_lines.hpp"

namespace crumble {
namespace {

constexpr double kSameTime = 1e-6;  // of a tick: a row this close to a tick is that tick's row

struct Window {
  double from, to;  // s
};

/// The rows of the window when they are its ticks, one for one.
std::span<const TrajectoryRow> rows_on_ticks(std::span<const TrajectoryRow> rows, const Window& window, double tick) {
  const double slack = kSameTime * tick;
  const auto first = std::partition_point(rows.begin(), rows.end(),
                                          [&](const TrajectoryRow& row) { return row.time < window.from - slack; });
  const auto last =
      std::partition_point(first, rows.end(), [&](const TrajectoryRow& row) { return row.time <= window.to + slack; });
  for (auto row = first; row != last; ++row) {
    const double time = window.from + static_cast<double>(row - first) * tick;
    if (!(std::abs(row->time - time) <= slack)) return {};
  }
  return {first, last};
}

class ReplayDevice final : public Device {
 public:
  ReplayDevice(const Trajectory& trajectory, const PoseCurve& curve, const Window& window, EndPolicy end, double tick)
      : columns_(trajectory.columns), rows_(trajectory.rows), curve_(curve), window_(window), end_(end), tick_(tick) {
    recorded_ = rows_on_ticks(rows_, window_, tick_);
    if (recorded_.size() < 2) recorded_ = {};
    info_ = {.name = "replay", .kind = DeviceKind::replay, .rate = 1 / tick, .step_locked = true};
    const std::string_view source = trajectory.value_of("device");
    if (!source.empty()) info_.name += " of " + std::string(source);
    constexpr std::uint32_t kVelocities = quantity::kLinearVelocity | quantity::kAngularVelocity;
    constexpr std::uint32_t kPlayed = quantity::kPosition | quantity::kOrientation | quantity::kButtons | kVelocities;
    info_.measured = columns_;
    device::read_info_lines(trajectory, info_);
    info_.measured &= columns_ & (recorded_.empty() ? kPlayed & ~kVelocities : kPlayed);
  }

  const DeviceInfo& info() const noexcept override { return info_; }

  ReadStatus read(DeviceSample& sample) noexcept override {
    const bool finished = recorded_.empty() ? read_curve(sample) : read_row(sample);
    sample.time = static_cast<double>(count_) * tick_;
    sample.sequence = count_++;
    if (!finished) return ReadStatus::ok;
    sample.linear_velocity = sample.angular_velocity = Vec3::Zero();
    sample.flags |= sample_flag::kFinished;
    return ReadStatus::finished;
  }
  void write(const Vec3&, const Vec3&) noexcept override {}

 private:
  /// Sample k is row k. Returns whether the window is over.
  bool read_row(DeviceSample& sample) const noexcept {
    const std::size_t last = recorded_.size() - 1;
    const bool finished = end_ == EndPolicy::hold && count_ > last;
    // A lap ends where the next begins, so its last row is not played
    const std::size_t k = end_ == EndPolicy::loop ? count_ % last : std::min<std::uint64_t>(count_, last);
    const TrajectoryRow& row = recorded_[k];
    const CurvePoint derived = curve_.at(row.time);
    sample.pose = row.pose;
    sample.linear_velocity = columns_ & quantity::kLinearVelocity ? row.linear_velocity : derived.linear_velocity;
    sample.angular_velocity = columns_ & quantity::kAngularVelocity ? row.angular_velocity : derived.angular_velocity;
    sample.buttons = row.buttons;
    sample.flags = row.flags & ~sample_flag::kFinished;
    return finished;
  }

  bool read_curve(DeviceSample& sample) const noexcept {
    const double length = window_.to - window_.from;
    double elapsed = static_cast<double>(count_) * tick_;
    const bool finished = end_ == EndPolicy::hold && elapsed > length + kSameTime * tick_;
    if (end_ == EndPolicy::loop) elapsed -= std::floor(elapsed / length) * length;
    const double time = std::clamp(window_.from + elapsed, window_.from, window_.to);
    const CurvePoint point = curve_.at(time);
    const TrajectoryRow& row = rows_[curve_.row_at(time)];
    sample.pose = point.pose;
    sample.linear_velocity = point.linear_velocity;
    sample.angular_velocity = point.angular_velocity;
    sample.buttons = row.buttons;
    sample.flags = (row.flags & ~sample_flag::kFinished) | sample_flag::kResampled;
    return finished;
  }

  DeviceInfo info_;
  std::uint32_t columns_;
  std::vector<TrajectoryRow> rows_;
  std::span<const TrajectoryRow> recorded_;  // part of rows_: sample k is its row k; empty when resampling
  PoseCurve curve_;
  Window window_;
  EndPolicy end_;
  double tick_;
  std::uint64_t count_ = 0;
};

}  // namespace

std::unique_ptr<Device> open_replay(const Trajectory& trajectory, const ReplayOptions& options, double tick) {
  require_positive("tick", tick);
  const PoseCurve curve(trajectory);
  const double first = curve.first_time(), last = curve.last_time();
  const Window window{options.from.value_or(first), options.to.value_or(last)};
  require_in_range("replay.from", window.from, first, last);
  require_in_range("replay.to", window.to, first, last);
  require_positive("replay.to - replay.from", window.to - window.from);
  return std::make_unique<ReplayDevice>(trajectory, curve, window, options.end, tick);
}

}  // namespace crumble
