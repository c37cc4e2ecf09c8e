// Several steps for a host whose frames are longer than one.
#include <algorithm>

#include "crumble/base/clock.hpp"
#include "crumble/sim/simulation.hpp"

namespace crumble {
namespace {

// Whether another step fits, going by the longest so far.
class Budget {
 public:
  explicit Budget(double seconds) : end_(seconds > 0 ? began_ + seconds : 0) {}
  bool allows_another() noexcept {
    const double now = wall_seconds();
    longest_ = std::max(longest_, now - last_);
    last_ = now;
    return end_ == 0 || now + longest_ <= end_;
  }
  double spent() const noexcept { return last_ - began_; }

 private:
  double began_ = wall_seconds(), last_ = began_, longest_ = 0, end_;
};

}  // namespace

AdvanceReport Simulation::advance(std::span<const Pose> poses, std::uint32_t steps, double budget,
                                  std::span<Wrench> wrenches, const AfterStep& after_step) noexcept {
  AdvanceReport report;
  Budget time(budget);
  const bool known = poses.size() == holder_count() && std::all_of(poses.begin(), poses.end(), is_valid);
  for (std::size_t i = 0; known && i < poses.size(); ++i) {
    advance_from_[i] = contacts_.placed(i) ? contacts_.pose(i) : poses[i];
  }
  std::fill(wrenches.begin(), wrenches.end(), Wrench{});
  for (std::uint32_t k = 1; k <= steps; ++k) {
    const double way = static_cast<double>(k) / steps;
    for (std::size_t i = 0; known && i < poses.size(); ++i) {
      advance_to_[i] = k == steps ? poses[i] : interpolate(advance_from_[i], renormalized(poses[i]), way);
    }
    const std::span<const Pose> here = known ? std::span<const Pose>(advance_to_) : poses;
    step(here);
    report.flags |= info_.flags;
    if (info_.status != Code{}) break;
    ++report.steps;
    report.new_cuts += info_.new_cuts;
    for (std::size_t i = 0; i < wrenches.size(); ++i) {
      wrenches[i].force += wrenches_[i].force, wrenches[i].torque += wrenches_[i].torque;
    }
    if (after_step.call) after_step.call(here, after_step.context);
    if (k < steps && !time.allows_another()) break;
  }
  const bool stood = info_.status != Code{};
  report.dropped = stood ? 0 : steps - report.steps;
  counters_.dropped_steps += report.dropped;
  time.allows_another();
  report.seconds = time.spent();
  for (Wrench& w : wrenches) {
    w = stood || report.steps == 0 ? Wrench{} : Wrench{w.force / report.steps, w.torque / report.steps};
  }
  return report;
}

}  // namespace crumble
