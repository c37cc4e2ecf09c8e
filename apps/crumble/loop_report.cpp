#include "loop_report.hpp"

#include <nlohmann/json.hpp>

#include "crumble/base/file.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/text.hpp"
#include "line.hpp"
#include "render/force_plot.hpp"

namespace crumble::app {
namespace {

using Json = nlohmann::ordered_json;

unsigned long long whole(std::uint64_t number) {
  return number;
}

Json microseconds(const TimePercentiles& t) {
  return {
      {"count", t.count}, {"p50", 1e6 * t.p50}, {"p99", 1e6 * t.p99}, {"p99_9", 1e6 * t.p99_9}, {"max", 1e6 * t.max}};
}

// In the order in which they are told.
Vector<std::pair<const char*, std::uint64_t>> counters(const SafetyCounters& c) {
  return {{"held", c.held},     {"aged", c.aged},     {"outside", c.outside}, {"clamped", c.clamped},
          {"heated", c.heated}, {"slewed", c.slewed}, {"capped", c.capped},   {"unanswered", c.unanswered},
          {"faults", c.faults}};
}

Json settings_json(const LoopSettings& s) {
  return {{"coupling", to_string(s.coupling)},
          {"body_ticks", s.body_ticks},
          {"body_thread", s.body_thread},
          {"rate_hz", s.device.rate},
          {"virtual_coupling", s.virtual_coupling},
          {"inject_damping", s.damping},
          {"controller", s.controller},
          {"encoder_step_m", s.device.encoder_step}};
}

std::string times_line(const char* name, const TimePercentiles& t) {
  if (t.count == 0) return {};  // not our thread
  return line("%-12sp50 %.1f us, p99 %.1f us, p99.9 %.1f us, max %.1f us\n", name, 1e6 * t.p50, 1e6 * t.p99,
              1e6 * t.p99_9, 1e6 * t.max);
}

std::string body_text(const LoopSettings& s) {
  if (s.coupling == BodyCoupling::direct) return "stepped in the tick";
  return std::string(to_string(s.coupling)) + ", a step for every " + std::to_string(s.body_ticks) +
         (s.body_ticks == 1 ? " tick" : " ticks") + (s.body_thread ? ", in a thread of its own" : "");
}

std::string state_text(const LoopRun& run) {
  const HandStatus& hand = run.status.hands[0];
  std::string text = to_string(run.state);
  if (hand.fault != Fault::none) text += std::string(": ") + to_string(hand.fault) + ", " + reason(hand.fault);
  if (!run.device_text.empty()) text += "; the device says: " + run.device_text;
  return text;
}

std::string counters_text(const SafetyCounters& c) {
  std::string text;
  for (const auto& [name, count] : counters(c)) {
    if (count > 0) text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + name;
  }
  return text.empty() ? "nothing had to be done" : text;
}

std::string thread_text(const LoopRun& run) {
  if (run.device_drove) return "the device's";
  return run.scheduling.empty() ? "as the system likes" : run.scheduling;
}

std::string replay_text(const LoopReplay& r) {
  std::string text = std::to_string(r.rows) + " ticks; run again, ";
  if (r.first_difference) return text + "the force of tick " + std::to_string(*r.first_difference) + " is another one";
  return text + "every force is the same to the last bit, with " + std::to_string(r.events) + " events";
}

std::string sample_table(const LoopRun& run) {
  std::string text = "time_s,x_m,y_m,z_m,qx,qy,qz,qw,fx_n,fy_n,fz_n,tool_x_m,tool_y_m,tool_z_m,contacts,cuts,state\n";
  for (const LoopSample& s : run.samples) {
    const Quat& q = s.device.orientation;
    text += to_text(s.time);
    for (const double value : s.device.position) text += ',' + to_text(value);
    for (const double value : {q.x(), q.y(), q.z(), q.w()}) text += ',' + to_text(value);
    for (const double value : s.force) text += ',' + to_text(value);
    for (const double value : s.tool) text += ',' + to_text(value);
    text += ',' + std::to_string(s.contacts) + ',' + std::to_string(s.cuts) + ',' + to_string(s.state) + '\n';
  }
  return text;
}

}  // namespace

const char* to_string(BodyCoupling coupling) {
  switch (coupling) {
    case BodyCoupling::direct:
      return "direct";
    case BodyCoupling::local_model:
      return "local_model";
    case BodyCoupling::paper:
      return "paper";
  }
  return "unknown";
}

std::string to_json(const LoopRun& run) {
  const LoopStatus& status = run.status;
  const HandStatus& hand = status.hands[0];
  Json json{{"scene", run.scene}, {"device", run.device}};
  json.update(settings_json(run.settings));
  json.update({{"seconds", run.seconds},
               {"scheduling", run.scheduling},
               {"measured_rate_hz", run.times.rate},
               {"ticks", status.ticks},
               {"missed", status.missed},
               {"body_steps", status.steps},
               {"late_answers", status.late_answers},
               {"watchdog", status.watchdog},
               {"tick_wall_us", microseconds(run.times.tick_wall)},
               {"tick_cpu_us", microseconds(run.times.tick_cpu)},
               {"lateness_us", microseconds(run.times.lateness)},
               {"period_us", microseconds(run.times.period)},
               {"peak_force_n", run.peak_force},
               {"stiffness_n_m", run.stiffness},
               {"damping_n_s_m", run.damping},
               {"required_damping_n_s_m", hand.energy.required_damping},
               {"energy",
                {{"absorbed_j", hand.energy.absorbed},
                 {"least_j", hand.energy.least},
                 {"injected_j", hand.energy.injected},
                 {"controlled_j", hand.energy.controlled}}},
               {"counters", Json::object()},
               {"cuts", run.cuts},
               {"samples", run.samples.size()},
               {"state", to_string(run.state)},
               {"fault", to_string(hand.fault)},
               {"fault_reason", hand.fault == Fault::none ? "" : reason(hand.fault)},
               {"device_text", run.device_text},
               {"warnings", run.warnings}});
  if (run.replay) {
    json["replay"] = {
        {"rows", run.replay->rows}, {"identical", !run.replay->first_difference}, {"events", run.replay->events}};
  }
  for (const auto& [name, count] : counters(hand.counters)) json["counters"][name] = count;
  return json.dump(1) + "\n";
}

std::string to_report(const LoopRun& run) {
  const LoopStatus& status = run.status;
  const HandStatus& hand = status.hands[0];
  std::string text;
  text += line("%s, %s, %g s\n\n", run.scene.c_str(), run.device.c_str(), run.seconds);
  text += "thread      " + thread_text(run) + "\n";
  text +=
      line("ticks       %llu at %.1f Hz of %g, %llu deadlines missed; the watchdog came %llu times\n",
           whole(status.ticks), run.times.rate, run.settings.device.rate, whole(status.missed), whole(status.watchdog));
  text += times_line("tick, wall", run.times.tick_wall) + times_line("tick, CPU", run.times.tick_cpu) +
          times_line("lateness", run.times.lateness);
  text += line("body        %s: %llu steps, %llu late answers, %llu springs cut\n", body_text(run.settings).c_str(),
               whole(status.steps), whole(status.late_answers), whole(run.cuts));
  text += line("force       peak %.2f N; the hand felt at most %.0f N/m\n", run.peak_force, run.stiffness);
  text += line("damping     at most %.2f N s/m injected, %.2f needed\n", run.damping, hand.energy.required_damping);
  text += line("energy      %.4f mJ absorbed, least %.4f mJ; %.4f mJ by damping, %.4f mJ by the controller\n",
               1e3 * hand.energy.absorbed, 1e3 * hand.energy.least, 1e3 * hand.energy.injected,
               1e3 * hand.energy.controlled);
  text += "safety      " + counters_text(hand.counters) + "\n";
  text += "state       " + state_text(run) + "\n";
  if (run.replay) text += "recorded    " + replay_text(*run.replay) + "\n";
  for (const std::string& warning : run.warnings) text += "warning: " + warning + "\n";
  return text;
}

void write_loop(const LoopRun& run, const OutputFolder& folder) {
  write_text(folder.temporary() / "loop.csv", sample_table(run));
  Vector<render::ForceSample> samples;
  for (const LoopSample& s : run.samples) samples.push_back({s.time, 0, s.force, s.cuts});
  render::write_force_plot(samples, render::PlotAxis::time, run.scene + ", " + run.device + ": force on the hand",
                           folder.temporary() / "loop.svg");
}

}  // namespace crumble::app
