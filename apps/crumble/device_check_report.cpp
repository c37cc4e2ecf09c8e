#include <nlohmann/json.hpp>

#include "crumble/device/open.hpp"
#include "device_check.hpp"
#include "line.hpp"

namespace crumble::app {
namespace {

using Json = nlohmann::ordered_json;

Json vector(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

Json identity(const DeviceInfo& info) {
  return {{"kind", to_string(info.kind)},
          {"name", info.name},
          {"serial", info.serial},
          {"driver", info.driver},
          {"servo_driven", info.servo_driven},
          {"nominal_rate_hz", info.rate},
          {"max_force_n", info.max_force},
          {"continuous_force_n", info.continuous_force},
          {"max_torque_nm", info.max_torque},
          {"max_stiffness_n_m", info.max_stiffness},
          {"max_damping_n_s_m", info.max_damping},
          {"max_speed_m_s", info.max_speed},
          {"position_step_m", info.position_step},
          {"workspace_low_m", vector(info.workspace_low)},
          {"workspace_high_m", vector(info.workspace_high)}};
}

Json still(const CheckResult& r) {
  Json json{{"samples", r.samples},
            {"gaps", r.gaps},
            {"unanswered", r.unanswered},
            {"rate_hz", r.rate},
            {"period_us",
             {{"p50", 1e6 * r.period.quantile(0.5)},
              {"p99", 1e6 * r.period.quantile(0.99)},
              {"p99_9", 1e6 * r.period.quantile(0.999)},
              {"max", 1e6 * r.period.greatest()}}},
            {"position_m", Json::array()},
            {"greatest_speed_m_s", r.greatest_speed},
            {"greatest_motor_temperature", r.greatest_temperature},
            {"buttons", r.buttons}};
  for (const Spread& axis : r.position) {
    json["position_m"].push_back({{"low", axis.low}, {"high", axis.high}, {"mean", axis.mean()}});
  }
  return json;
}

}  // namespace

std::string to_json(const CheckResult& r) {
  Json json{{"device", identity(r.info)},
            {"calibration",
             {{"calibrated", r.calibrated}, {"seconds", r.calibration_seconds}, {"device_said", r.calibration_text}}},
            {"still", still(r)}};
  if (r.settings.push) {
    json["push"] = {{"done", r.pushed}, {"peak_n", r.push_peak}, {"moved_up_m", r.push_shift}};
  }
  if (r.settings.unplug) {
    json["unplugged"] = {{"noticed", r.lost}, {"silence_s", r.unplug_silence}, {"device_said", r.lost_text}};
  }
  json["stopped"] = r.stopped;
  return json.dump(1) + "\n";
}

std::string to_report(const CheckResult& r) {
  const DeviceInfo& info = r.info;
  std::string text;
  text += "device       " + info.name + (info.serial.empty() ? "" : ", serial " + info.serial) + "\n";
  if (!info.driver.empty()) text += "driver       " + info.driver + "\n";
  text += line("limits       %.2f N at its peak, %.2f N for long, %.0f N/m, %.1f N s/m; 0: it does not tell\n",
               info.max_force, info.continuous_force, info.max_stiffness, info.max_damping);
  text += "calibration  " + std::string(r.calibrated ? "ok" : "missing");
  text += r.calibration_text.empty() ? "\n" : "; it said: " + r.calibration_text + "\n";
  if (r.samples > 0) {
    text += line("rate         %.1f Hz of %.1f, %llu samples, %llu gaps\n", r.rate, info.rate,
                 static_cast<unsigned long long>(r.samples), static_cast<unsigned long long>(r.gaps));
    text += line("period       p50 %.0f us, p99 %.0f us, p99.9 %.0f us, max %.0f us\n", 1e6 * r.period.quantile(0.5),
                 1e6 * r.period.quantile(0.99), 1e6 * r.period.quantile(0.999), 1e6 * r.period.greatest());
    text += "held still   moved by ";
    for (const Spread& axis : r.position) text += line("%.3f ", 1e3 * (axis.high - axis.low));
    text +=
        line("mm (x y z), at most %.3f m/s, motors at %.2f of their limit\n", r.greatest_speed, r.greatest_temperature);
  }
  if (r.pushed) text += line("push         %.2f N upwards moved it by %.2f mm\n", r.push_peak, 1e3 * r.push_shift);
  if (!r.settings.push) text += "push         not tried: it needs --push\n";
  if (r.lost) text += line("unplugged    noticed after %.1f ms: %s\n", 1e3 * r.unplug_silence, r.lost_text.c_str());
  if (!r.settings.unplug) text += "unplugged    not tried: it needs --unplug\n";
  text += r.stopped.empty() ? "the check went through\n" : "the check ended early: " + r.stopped + "\n";
  return text;
}

}  // namespace crumble::app
