#include "device_check.hpp"

#include <algorithm>
#include <cmath>

#include "crumble/base/clock.hpp"
#include "crumble/base/error.hpp"
#include "crumble/base/text.hpp"
#include "crumble/haptics/safety.hpp"
#include "line.hpp"
#include "serve.hpp"

namespace crumble::app {
namespace {

constexpr double kRampTime = 1, kHoldTime = 0.5;  // s, up; at the top; and down again
const Vec3 kUp(0, 1, 0);

// The way of the push: up to the top, hold, and down.
double push_share(double time) {
  if (time < kRampTime) return time / kRampTime;
  if (time < kRampTime + kHoldTime) return 1;
  return std::max(0.0, 1 - (time - kRampTime - kHoldTime) / kRampTime);
}

bool has_sample(ReadStatus status) {
  return status == ReadStatus::ok || status == ReadStatus::finished;
}

class Check {
 public:
  Check(Device& device, const std::function<void(const std::string&)>& tell, CheckResult& out)
      : device_(device), tell_(tell), out_(out), settings_(out.settings) {}

  void run() {
    if (!wait_for_calibration() || !hold_still()) return;
    if (settings_.push && !push()) return;
    if (settings_.unplug) wait_for_unplugging();
  }

 private:
  bool wait_for_calibration() {
    bool told = false;
    const double begin = wall_seconds();
    const ReadStatus status =
        serve(device_, rate(), settings_.calibration_seconds, [&](ReadStatus read, const DeviceSample& s) {
          out_.calibrated = has_sample(read) && !(s.flags & sample_flag::kUncalibrated);
          if (!out_.calibrated && has_sample(read) && !told) {
            told = true;
            out_.calibration_text = device_.error_text();
          }
          return out_.calibrated ? std::nullopt : std::optional<Vec3>(Vec3::Zero());
        });
    out_.calibration_seconds = wall_seconds() - begin;
    if (status == ReadStatus::lost) return stop("it was lost before it was calibrated");
    return out_.calibrated || stop("it was not calibrated in time: " + out_.calibration_text);
  }

  bool hold_still() {
    tell_(line("Hold the device still for %g s. No force is given.", settings_.seconds));
    double first = 0, last = 0, deadline = wall_seconds() + settings_.seconds;
    std::uint64_t sequence = 0;
    const ReadStatus status = serve(device_, rate(), settings_.seconds, [&](ReadStatus read, const DeviceSample& s) {
      if (read == ReadStatus::no_new_sample) ++out_.unanswered;
      if (read == ReadStatus::ok) {
        const double now = device_.info().step_locked ? s.time : wall_seconds();
        if (out_.samples == 0) {
          first = now;
        } else {
          out_.period.add(now - last);
          out_.gaps += s.sequence - sequence - 1;
        }
        last = now, sequence = s.sequence;
        keep(s);
        if (device_.info().step_locked && now - first >= settings_.seconds) deadline = 0;
      }
      const bool over = read == ReadStatus::finished || wall_seconds() >= deadline;
      return over ? std::nullopt : std::optional<Vec3>(Vec3::Zero());
    });
    if (last > first) out_.rate = static_cast<double>(out_.samples - 1) / (last - first);
    if (status == ReadStatus::lost) return stop("it was lost while it was held still");
    return out_.samples > 0 || stop("it told nothing");
  }

  void keep(const DeviceSample& s) {
    ++out_.samples;
    for (int axis = 0; axis < 3; ++axis) out_.position[static_cast<std::size_t>(axis)].add(s.pose.position[axis]);
    out_.greatest_speed = std::max(out_.greatest_speed, norm(s.linear_velocity));
    out_.greatest_temperature = std::max(out_.greatest_temperature, s.motor_temperature);
    out_.buttons |= s.buttons;
  }

  // Through the same guards as in a loop.
  bool push() {
    tell_(line("Now it pushes upwards, with at most %g N for %g s. Hold it loosely.", settings_.force,
               2 * kRampTime + kHoldTime));
    const double tick = 1 / rate();
    const SafetyOptions safety{.max_force = settings_.force};
    SampleGuard samples(safety, device_.info(), tick);
    ForceGuard forces(safety, device_.info(), tick, tick);
    SafetyCounters counters;
    Fault fault = Fault::none;
    double time = 0;
    std::optional<double> start;
    const ReadStatus status =
        serve(device_, rate(), 60, [&](ReadStatus read, const DeviceSample& s) -> std::optional<Vec3> {
          fault = samples.take(read, s, counters);
          time += tick;
          if (fault != Fault::none || time > 2 * kRampTime + kHoldTime) return std::nullopt;
          if (samples.good() == 0) return Vec3(Vec3::Zero());
          const double height = samples.sample().pose.position.y();
          if (!start) start = height;
          if (time < kRampTime + kHoldTime) out_.push_shift = height - *start;
          ForceGuard::Order order{.force = settings_.force * push_share(time) * kUp,
                                  .position = samples.sample().pose.position,
                                  .heat = samples.sample().motor_temperature,
                                  .let_in = true};
          if ((fault = forces.pass(order, counters)) != Fault::none) return std::nullopt;
          forces.sent(order.force, Vec3::Zero());
          out_.push_peak = std::max(out_.push_peak, norm(order.force));
          return order.force;
        });
    if (status == ReadStatus::lost) return stop("it was lost while it pushed");
    if (fault != Fault::none) return stop("while it pushed: " + std::string(reason(fault)));
    out_.pushed = out_.push_peak > 0;
    return out_.pushed || stop("no force could be sent");
  }

  void wait_for_unplugging() {
    tell_(line("Pull the device's plug now; there are %g s for it.", settings_.unplug_seconds));
    double last = wall_seconds();
    const ReadStatus status =
        serve(device_, rate(), settings_.unplug_seconds, [&](ReadStatus read, const DeviceSample&) {
          if (read == ReadStatus::lost) {
            out_.unplug_silence = wall_seconds() - last;
          } else if (read == ReadStatus::ok) {
            last = wall_seconds();
          }
          return read == ReadStatus::finished ? std::nullopt : std::optional<Vec3>(Vec3::Zero());
        });
    out_.lost = status == ReadStatus::lost;
    out_.lost_text = device_.error_text();
    if (!out_.lost) stop("nobody pulled the plug, or nobody noticed");
  }

  double rate() const { return device_.info().rate > 0 ? device_.info().rate : settings_.device.rate; }
  bool stop(const std::string& why) {
    out_.stopped = why;
    if (*device_.error_text()) out_.stopped += " (" + std::string(device_.error_text()) + ")";
    return false;
  }

  Device& device_;
  const std::function<void(const std::string&)>& tell_;
  CheckResult& out_;
  const CheckSettings& settings_;
};

}  // namespace

void Spread::add(double value) {
  low = count == 0 ? value : std::min(low, value);
  high = count == 0 ? value : std::max(high, value);
  sum += value;
  ++count;
}

void check(const CheckSettings& s) {
  check(s.device);
  require_positive("--seconds", s.seconds);
  require_in_range("--seconds", s.seconds, 0, 600);
  require_positive("--force", s.force);
  require_in_range("--force", s.force, 0, kMostPush);
  require_positive("--wait", s.unplug_seconds);
  require_in_range("--wait", s.unplug_seconds, 0, 600);
}

void run_check(const CheckSettings& settings, const std::function<void(const std::string&)>& tell, CheckResult& out) {
  out.settings = settings;
  NamedDevice open = open_named(settings.device);
  out.info = open.device->info();
  Check(*open.device, tell, out).run();
}

}  // namespace crumble::app
