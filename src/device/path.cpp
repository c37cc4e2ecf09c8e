#include <algorithm>
#include <cmath>

#include "crumble/base/text.hpp"
#include "crumble/base/transcendental.hpp"
#include "crumble/device/scripted.hpp"
#include "device/check.hpp"

namespace crumble {
namespace {

constexpr double kMostTurn = 1e4;  // rad: what sin_exact takes

Quat turned_by(const Vec3& turn) {
  const double angle = norm(turn);
  return angle > 0 ? axis_angle(turn / angle, angle) : Quat::Identity();
}

// Angular velocity of exp(r) while r changes by `rate` a second.
Vec3 turning(const Vec3& r, const Vec3& rate) {
  const double angle = norm(r);
  const bool small = angle < 1e-3;  // series: the closed forms lose their digits
  const double a = small ? 0.5 : (1 - cos_exact(angle)) / (angle * angle);
  const double b = small ? 1.0 / 6 : (angle - sin_exact(angle)) / (angle * angle * angle);
  const Vec3 across = cross(r, rate);
  return rate + a * across + b * cross(r, across);
}

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
    // A millionth of a tick of slack, as for a press.
    const bool finished = time > points_.back().time + 1e-6 * tick_;
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
    sample.pose.orientation = multiply(turned_by(turn), start_.orientation);
    sample.linear_velocity = (b.move - a.move) / length;
    sample.angular_velocity = turning(turn, turn_rate);
    return sample;
  }

  DeviceInfo info_;
  Pose start_;
  std::vector<PathPoint> points_;  // the first one at time 0
  double tick_;
  std::uint64_t count_ = 0;
};

}  // namespace

std::unique_ptr<Device> open_path(const PathOptions& options, double tick) {
  device::require_pose("path.start", options.start);
  if (options.points.empty()) throw Error(Code::empty, "path.points is empty");
  for (std::size_t i = 0; i < options.points.size(); ++i) {
    const PathPoint& point = options.points[i];
    const std::string name = "path.points[" + std::to_string(i) + "]";
    require_finite(name + ".time", point.time);
    device::require_vector(name + ".move", point.move);
    device::require_vector(name + ".turn", point.turn);
    require_in_range("|" + name + ".turn|", norm(point.turn), 0, kMostTurn);
    const double before = i > 0 ? options.points[i - 1].time : 0;
    if (i > 0 ? point.time <= before : point.time < 0) {
      throw Error(Code::out_of_range, name + ".time must be " + (i > 0 ? "above that before, " : "at least ") +
                                          to_text(before) + ", is " + to_text(point.time));
    }
  }
  require_positive("tick", tick);
  return std::make_unique<PathDevice>(options, tick);
}

}  // namespace crumble
