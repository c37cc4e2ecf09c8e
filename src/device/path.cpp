#include <algorithm>

#include "crumble/base/memory.hpp"
#include "crumble/device/scripted.hpp"
#include "device/check.hpp"
#include "device/turn.hpp"

namespace crumble {
namespace {

constexpr double kMostTurn = 1e4;  // rad: what sin_exact takes

class PathDevice final : public Device {
 public:
  PathDevice(const PathOptions& options, double tick)
      : start_(renormalized(options.start)), points_(options.points), tick_(tick) {
    if (points_.front().time > 0) points_.insert(points_.begin(), PathPoint{});
    info_ = {.name = "scripted path",
             .kind = DeviceKind::path,
             .measured = quantity::kPosition | quantity::kOrientation,
             .rate = 1 / tick,
             .step_locked = true};
  }
  const DeviceInfo& info() const noexcept override { return info_; }
  ReadStatus read(DeviceSample& sample) noexcept override {
    const double time = static_cast<double>(count_) * tick_;
    const bool finished = device::is_over(time, points_.back().time, tick_);
    sample = at(time);
    sample.sequence = count_;
    if (finished) sample.flags = sample_flag::kFinished;
    ++count_;
    return finished ? ReadStatus::finished : ReadStatus::ok;
  }
  void write(const Vec3&, const Vec3&) noexcept override {}

 private:
  DeviceSample at(double time) const noexcept {
    const auto next = std::upper_bound(points_.begin(), points_.end(), time,
                                       [](double t, const PathPoint& point) { return t < point.time; });
    const bool moving = next != points_.end();
    const PathPoint& a = *(next - 1);
    const PathPoint& b = moving ? *next : a;
    const double length = moving ? b.time - a.time : 1;
    const double share = moving ? (time - a.time) / length : 0;
    const Vec3 turn = a.turn + share * (b.turn - a.turn), turn_rate = (b.turn - a.turn) / length;
    DeviceSample sample;
    sample.time = time;
    sample.pose.position = start_.position + (a.move + share * (b.move - a.move));
    sample.pose.orientation = multiply(device::turned_by(turn), start_.orientation);
    sample.linear_velocity = (b.move - a.move) / length;
    sample.angular_velocity = device::turning(turn, turn_rate);
    return sample;
  }

  DeviceInfo info_;
  Pose start_;
  Vector<PathPoint> points_;  // the first one at time 0
  double tick_;
  std::uint64_t count_ = 0;
};

}  // namespace

std::unique_ptr<Device> open_path(const PathOptions& options, double tick) {
  device::require_pose("path.start", options.start);
  device::require_times("path.points", options.points);
  for (std::size_t i = 0; i < options.points.size(); ++i) {
    const PathPoint& point = options.points[i];
    const std::string name = "path.points[" + std::to_string(i) + "]";
    device::require_vector(name + ".move", point.move);
    device::require_vector(name + ".turn", point.turn);
    require_in_range("|" + name + ".turn|", norm(point.turn), 0, kMostTurn);
  }
  require_positive("tick", tick);
  return std::make_unique<PathDevice>(options, tick);
}

}  // namespace crumble
