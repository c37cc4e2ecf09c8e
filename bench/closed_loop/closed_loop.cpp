#include "closed_loop/closed_loop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "crumble/base/memory.hpp"
#include "crumble/base/text.hpp"
#include "crumble/device/hand.hpp"
#include "scenes/scene.hpp"

namespace crumble::closed_loop {
namespace {

constexpr double kClearance = 1e-3;       // m
constexpr double kWait = 0.8, kMove = 1;  // s; the loop lets nothing in before it has seen 100 samples
constexpr double kLook = 2;               // s, of the hold

Simulation make_body(const Case& c, const Setup& setup, Pose& start) {
  static const Scene scene = load_scene("tofu_cube", Preset::standard);  // the mesh takes its time
  SimulationDef def = scene.def;
  start = scene.motions[0].start;
  def.material.stiffness = c.spring_stiffness;
  def.step.tau = c.tick * setup.body_ticks;
  def.step.mean_force = c.mean;
  def.tools[0].friction = setup.lateral ? Friction{0.5, 0.5} : Friction{0, 0};
  return Simulation(std::move(def));
}

struct Times {
  double down, up, end;
};

Times times_of(const Setup& setup) {
  const double down = kWait + kMove, up = down + setup.hold;
  return {down, up, up + kMove + 0.3};
}

Vector<HandPoint> motion(const Setup& setup) {
  const double deep = -(kClearance + setup.depth), side = setup.lateral ? 1e-3 : 0;
  const Times t = times_of(setup);
  return {{kWait, Vec3::Zero()},
          {kWait + 0.4 * kMove, {side, 0.4 * deep, -side}},
          {kWait + 0.7 * kMove, {-side, 0.7 * deep, side}},
          {t.down, {0, deep, 0}},
          {t.up, {0, deep, 0}},
          {t.up + 0.5 * kMove, {side, 0.5 * deep, side}},
          {t.up + kMove, Vec3::Zero()},
          {t.end, Vec3::Zero()}};
}

HandOptions hand_options(const Case& c, const Setup& setup) {
  HandOptions options;
  options.start.position.y() = kClearance;
  options.points = motion(setup);
  options.mass = c.grip.mass, options.stiffness = c.grip.stiffness, options.damping = c.grip.damping;
  options.encoder_step = setup.encoder_step;
  options.delay = c.delay;
  options.device_mass = kDeviceMass;
  return options;
}

LoopDef loop_def(const Case& c, const Setup& setup, const Pose& start, SimulatedHand& hand) {
  LoopDef def;
  def.tick = c.tick;
  def.driver = LoopDriver::host;
  def.coupling = setup.body;
  def.body_ticks = setup.body_ticks;
  HandDef h;
  h.device = &hand;
  h.workspace.pose.position = start.position;
  h.workspace.mount = start.orientation;
  h.coupling.enabled = setup.coupling;
  h.coupling.stiffness = setup.coupling_stiffness;
  h.passivity.inject_damping = setup.damping;
  h.passivity.controller = setup.controller;
  h.passivity.max_damping = setup.max_damping;
  h.passivity.delay = c.delay;
  def.hands = {h};
  return def;
}

// What is seen while the hand holds still.
class Hold {
 public:
  void add(const Vec3& position, const Vec3& velocity, const Vec3& force) {
    low_ = low_.cwiseMin(position), high_ = high_.cwiseMax(position);
    low_force_ = low_force_.cwiseMin(force), high_force_ = high_force_.cwiseMax(force);
    squares_ += squared_norm(velocity);
    ++count_;
  }
  void report(Outcome& out) const {
    if (count_ == 0) return;
    out.hold_speed = std::sqrt(squares_ / static_cast<double>(count_));
    out.hold_span = (high_ - low_).maxCoeff();
    out.hold_force_span = (high_force_ - low_force_).maxCoeff();
  }

 private:
  Vec3 low_ = Vec3::Constant(1e9), high_ = Vec3::Constant(-1e9), low_force_ = low_, high_force_ = high_;
  double squares_ = 0;
  std::uint64_t count_ = 0;
};

// What a setup may do at most; infinite where it does not matter.
struct Limits {
  double energy, span, speed;  // J, m, m/s
};

Limits limits_of(const Setup& setup) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const bool encoder = setup.encoder_step > 0;
  return {encoder || setup.lateral ? 1e-4 : 1e-5, encoder ? 3 * setup.encoder_step : kNone, encoder ? kNone : 1e-3};
}

}  // namespace

Vector<Case> all_cases() {
  Vector<Case> cases;
  for (const Grip& grip : {kLoose, kFirm, kBare}) {
    for (const double k : {30.0, 100.0}) {
      for (const double tick : {2.9e-3, 1e-3}) {
        for (const bool mean : {false, true}) {
          for (const std::uint32_t delay : {0u, 1u}) cases.push_back({grip, k, tick, mean, delay});
        }
      }
    }
  }
  return cases;
}

std::string to_string(const Case& c) {
  return std::string(c.grip.name) + " grip, k " + to_text(c.spring_stiffness) + " N/m, tick " + to_text(1e3 * c.tick) +
         " ms, " + (c.mean ? "mean of 5" : "no mean") + ", delay " + std::to_string(c.delay);
}

Outcome press(const Case& c, const Setup& setup) {
  Pose start;
  Simulation sim = make_body(c, setup, start);
  SimulatedHand hand(hand_options(c, setup), c.tick);
  HapticLoop loop(sim, loop_def(c, setup, start, hand));
  const Times times = times_of(setup);
  const auto ticks = static_cast<std::uint64_t>(times.end / c.tick);
  Outcome out;
  Hold hold;
  std::optional<std::uint64_t> cuts_before;
  Vec3 lag_before = Vec3::Zero();
  for (std::uint64_t k = 0; k < ticks; ++k) {
    loop.tick();
    const double time = static_cast<double>(k) * c.tick;
    const HandStatus status = loop.status().hands[0];
    const Vec3 lag = status.tool.position - status.device.position;
    out.tool_jumps += k > 0 && norm(lag - lag_before) > 1e-4;
    lag_before = lag;
    out.least_energy = std::min(out.least_energy, hand.energy_given());
    out.peak_force = std::max(out.peak_force, norm(status.force));
    out.stiffness = std::max(out.stiffness, status.stiffness);
    if (time < times.down || time >= times.up) continue;
    if (!cuts_before) cuts_before = sim.counters().cuts;
    out.hold_cuts = sim.counters().cuts - *cuts_before;
    out.depth = -hand.position().y();
    if (time >= times.up - std::min(kLook, 0.5 * setup.hold)) hold.add(hand.position(), hand.velocity(), status.force);
  }
  hold.report(out);
  const HandStatus end = loop.status().hands[0];
  out.cuts = sim.counters().cuts;
  out.observed_least = end.energy.least;
  out.required_damping = end.energy.required_damping;
  out.capped = end.counters.capped;
  out.fault = end.fault;
  return out;
}

double chosen_stiffness(const Case& c, const Setup& setup) {
  SimulatedHand hand(hand_options(c, setup), c.tick);
  return safe_stiffness(hand.info(), loop_def(c, setup, {}, hand).hands[0].passivity, c.tick);
}

std::string failure(const Outcome& o, const Setup& setup) {
  const Limits most = limits_of(setup);
  std::string text;
  const auto add = [&](bool fails, const std::string& why) {
    if (fails) text += (text.empty() ? "" : ", ") + why;
  };
  add(o.fault != Fault::none, std::string("fault ") + crumble::to_string(o.fault));
  add(!(o.least_energy >= -most.energy), "gave energy");
  add(!(o.hold_span <= most.span) || !(o.hold_speed < most.speed), "moves in the hold");
  add(o.hold_cuts > 0, "cuts in the hold");
  return text;
}

double excess(const Outcome& o, const Setup& setup) {
  const Limits most = limits_of(setup);
  return std::max({-o.least_energy / most.energy, o.hold_span / most.span, o.hold_speed / most.speed});
}

bool passes(const Outcome& outcome, const Setup& setup) {
  return failure(outcome, setup).empty();
}

Setup default_setup() {
  return {};
}

Setup damping_only() {
  Setup setup;
  setup.name = "damping only";
  setup.coupling = false;
  setup.max_damping = 1000;  // so that only the mass limits it
  return setup;
}

Setup bare_setup() {
  Setup setup;
  setup.name = "bare";
  setup.coupling = setup.damping = false;
  return setup;
}

Setup paper_setup() {
  Setup setup = bare_setup();
  setup.name = "paper";
  setup.body = BodyCoupling::paper;
  return setup;
}

}  // namespace crumble::closed_loop
