// What somebody with hardware runs first: who is there, does it keep time, does it stand still, does it push, and what
// happens when it is pulled out.
#pragma once

#include <functional>
#include <string>

#include "crumble/haptics/histogram.hpp"
#include "named_device.hpp"

namespace crumble::app {

struct CheckSettings {
  DeviceChoice device{.name = "phantom"};
  double seconds = 10;              // of holding still
  double calibration_seconds = 60;  // to wait for it
  double force = 0.3;               // N, at the top of the ramp
  bool push = false;                // whether to push at all: somebody holds the device and agrees
  bool unplug = false;              // whether somebody will pull it out
  double unplug_seconds = 60;       // to wait for that
};

/// The range of a number, and its mean.
struct Spread {
  double low = 0, high = 0, sum = 0;
  std::size_t count = 0;
  void add(double value);
  double mean() const { return count > 0 ? sum / static_cast<double>(count) : 0; }
};

struct CheckResult {
  CheckSettings settings;
  DeviceInfo info;
  bool calibrated = false;
  double calibration_seconds = 0;  // that it took
  std::string calibration_text;    // what the device said meanwhile

  // Holding still, with zero force
  std::uint64_t samples = 0, gaps = 0, unanswered = 0;
  double rate = 0;                  // Hz, mean
  Histogram period;                 // from sample to sample
  std::array<Spread, 3> position;   // m
  double greatest_speed = 0;        // m/s
  double greatest_temperature = 0;  // see DeviceSample
  std::uint32_t buttons = 0;        // that were pressed at some time

  // Pushing
  bool pushed = false;
  double push_shift = 0;  // m, along the force, at the top of the ramp
  double push_peak = 0;   // N, sent

  // Pulling out
  bool lost = false;
  double unplug_silence = 0;  // s from the last sample to knowing that it is gone
  std::string lost_text;
  std::string stopped;  // why the check ended early; empty: it did not
};

inline constexpr double kMostPush = 0.5;  // N

/// Throws Error naming the option.
void check(const CheckSettings& settings);
/// `tell`: a line for whoever holds the device. Throws Error when the device does not open.
void run_check(const CheckSettings& settings, const std::function<void(const std::string&)>& tell, CheckResult& out);

std::string to_report(const CheckResult& result);
std::string to_json(const CheckResult& result);

}  // namespace crumble::app
