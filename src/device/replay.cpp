#include "crumble/device/replay.hpp"

#include <algorithm>
#include <cmath>

#include "crumble/base/clock.hpp"
#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
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

struct Setup {
  const Trajectory& trajectory;
  const PoseCurve& curve;
  Window window;
  EndPolicy end;
  double tick;  // s
};

/// What the clocks have in common: how a row and a time are played.
class Replay : public Device {
 public:
  const DeviceInfo& info() const noexcept override { return info_; }
  void write(const Vec3&, const Vec3&) noexcept override {}

 protected:
  explicit Replay(const Setup& setup)
      : columns_(setup.trajectory.columns),
        rows_(setup.trajectory.rows),
        curve_(setup.curve),
        window_(setup.window),
        end_(setup.end),
        tick_(setup.tick) {
    info_ = {.name = "replay", .kind = DeviceKind::replay, .measured = columns_, .rate = 1 / tick_};
    const std::string_view source = setup.trajectory.value_of("device");
    if (!source.empty()) info_.name += " of " + std::string(source);
    device::read_info_lines(setup.trajectory, info_);
  }

  /// Whether samples are rows or between them.
  void set_measured(bool rows) {
    constexpr std::uint32_t kVelocities = quantity::kLinearVelocity | quantity::kAngularVelocity;
    constexpr std::uint32_t kCurve = quantity::kPosition | quantity::kOrientation | quantity::kButtons;
    info_.measured &= columns_ & (rows ? kCurve | kVelocities : kCurve);
  }

  void play_row(const TrajectoryRow& row, DeviceSample& sample) const noexcept {
    const CurvePoint derived = curve_.at(row.time);
    sample.pose = row.pose;
    sample.linear_velocity = columns_ & quantity::kLinearVelocity ? row.linear_velocity : derived.linear_velocity;
    sample.angular_velocity = columns_ & quantity::kAngularVelocity ? row.angular_velocity : derived.angular_velocity;
    sample.buttons = row.buttons;
    sample.flags = row.flags & ~sample_flag::kFinished;
  }

  /// `elapsed` seconds after window_.from. Returns whether the window is over.
  bool play_time(double elapsed, DeviceSample& sample) const noexcept {
    const double length = window_.to - window_.from;
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

  ReadStatus hand_out(DeviceSample& sample, double time, bool finished) noexcept {
    sample.time = time;
    sample.sequence = count_++;
    if (!finished) return ReadStatus::ok;
    sample.linear_velocity = sample.angular_velocity = Vec3::Zero();
    sample.flags |= sample_flag::kFinished;
    return ReadStatus::finished;
  }

  DeviceInfo info_;
  std::uint32_t columns_;
  Vector<TrajectoryRow> rows_;
  PoseCurve curve_;
  Window window_;
  EndPolicy end_;
  double tick_;
  std::uint64_t count_ = 0;  // samples handed out
};

class StepLockedReplay final : public Replay {
 public:
  explicit StepLockedReplay(const Setup& setup) : Replay(setup), recorded_(rows_on_ticks(rows_, window_, tick_)) {
    if (recorded_.size() < 2) recorded_ = {};
    info_.step_locked = true;
    set_measured(!recorded_.empty());
  }

  ReadStatus read(DeviceSample& sample) noexcept override {
    const double time = static_cast<double>(count_) * tick_;
    return hand_out(sample, time, recorded_.empty() ? play_time(time, sample) : play_tick(sample));
  }

 private:
  /// Sample k is row k.
  bool play_tick(DeviceSample& sample) const noexcept {
    const std::size_t last = recorded_.size() - 1;
    // A lap ends where the next begins, so its last row is not played
    const std::size_t k = end_ == EndPolicy::loop ? count_ % last : std::min<std::uint64_t>(count_, last);
    play_row(recorded_[k], sample);
    return end_ == EndPolicy::hold && count_ > last;
  }

  std::span<const TrajectoryRow> recorded_;  // part of rows_; empty when resampling
};

class RealtimeReplay final : public Replay {
 public:
  explicit RealtimeReplay(const Setup& setup) : Replay(setup) { set_measured(false); }

  ReadStatus read(DeviceSample& sample) noexcept override {
    const double now = wall_seconds();
    if (count_ == 0) begin_ = now;
    const double elapsed = now - begin_;
    const bool over = end_ == EndPolicy::hold && elapsed > window_.to - window_.from;
    if (count_ > 0 && !over && elapsed - last_ < tick_ / 2) return ReadStatus::no_new_sample;
    last_ = elapsed;
    return hand_out(sample, elapsed, play_time(elapsed, sample));
  }

 private:
  double begin_ = 0, last_ = 0;  // s: wall time of the first read; from it to the last sample
};

class FastReplay final : public Replay {
 public:
  explicit FastReplay(const Setup& setup) : Replay(setup) {
    const auto from = std::lower_bound(rows_.begin(), rows_.end(), window_.from,
                                       [](const TrajectoryRow& row, double time) { return row.time < time; });
    const auto to = std::find_if(from, rows_.end(), [&](const TrajectoryRow& row) {
      return end_ == EndPolicy::loop ? row.time >= window_.to : row.time > window_.to;
    });
    if (from == to) throw Error(Code::empty, "replay.from, replay.to: no row lies between them");
    played_ = {from, to};
    set_measured(true);
  }

  ReadStatus read(DeviceSample& sample) noexcept override {
    const std::uint64_t lap = count_ / played_.size();
    const bool finished = end_ == EndPolicy::hold && lap > 0;
    const TrajectoryRow& row = finished ? played_.back() : played_[count_ % played_.size()];
    play_row(row, sample);
    const double since = row.time - window_.from;
    const double laps = end_ == EndPolicy::loop ? static_cast<double>(lap) * (window_.to - window_.from) : 0;
    return hand_out(sample, since + laps, finished);
  }

 private:
  std::span<const TrajectoryRow> played_;  // part of rows_
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
  const Setup setup{trajectory, curve, window, options.end, tick};
  switch (options.clock) {
    case ReplayClock::step_locked:
      return std::make_unique<StepLockedReplay>(setup);
    case ReplayClock::realtime:
      return std::make_unique<RealtimeReplay>(setup);
    case ReplayClock::fast:
      return std::make_unique<FastReplay>(setup);
  }
  throw Error(Code::out_of_range,
              "replay.clock must lie in [0, 2], is " + std::to_string(static_cast<int>(options.clock)));
}

}  // namespace crumble
