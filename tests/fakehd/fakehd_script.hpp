// What the JSON script holds, with its defaults, which are those of a Touch where anything is known of one.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace fakehd {

using Vec = std::array<double, 3>;
using Quat = std::array<double, 4>;  // x, y, z, w

inline double norm(const Vec& v) {
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}
inline Vec scaled(const Vec& v, double f) {
  return {v[0] * f, v[1] * f, v[2] * f};
}
inline Vec minus(const Vec& a, const Vec& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline bool finite(const Vec& v) {
  return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

struct HandPoint {
  double t = 0;  // s
  Vec at{};      // m
};

struct Hand {
  double mass = 0.1, stiffness = 150, damping = 2.5;  // kg, N/m, N s/m
  std::vector<HandPoint> points{{}};
};

struct Row {
  double t = 0;  // s, from the first
  Vec at{};      // m
  Quat turn{0, 0, 0, 1};
  unsigned buttons = 0;
};

enum class Calibration { none, encoder_reset, automatic, inkwell };

struct DeviceScript {
  std::string name, model = "FAKE Touch", serial = "FAKE-0001";
  int input_dof = 6, output_dof = 3;
  double max_force = 3.3, continuous_force = 0.88;             // N
  double max_stiffness = 0.5, max_damping = 0.004;             // N/mm, N s/mm
  double velocity_limit = 2000, impulse_limit = 3.3;           // mm/s, N/ms
  std::array<double, 6> workspace{-80, -60, -35, 80, 60, 35};  // mm, usable
  Calibration calibration = Calibration::inkwell;
  double inkwell_at = 0, inkwell_for = 0.5, auto_after = 0.2;  // s
  Vec uncalibrated{11, -22, -33};                              // mm, the pose told before
  double position_step = 0;                                    // mm, 0: as it is
  double ramp_time = 0.5;                                      // s
  double temperature = 0, thermal_time = 60;                   // of all motors, 0 to 1; s
  std::vector<Row> trajectory;                                 // goes before the hand
  Hand hand;
};

enum class FaultKind : std::size_t {
  comm_error,
  device_fault,
  timer_error,
  warm_motors,
  exceeded_force,
  exceeded_velocity,
  nan_position,
  inf_velocity,
  teleport,
  freeze,
  bad_transform,
  init_error,
  error,
};
inline constexpr std::size_t kFaultKinds = 13;

struct Fault {
  std::uint64_t tick = 1, count = 1;  // the first, and how many
  std::size_t device = 0;
  FaultKind kind = FaultKind::error;
  unsigned code = 0;  // of kind error
  int internal = 0;
};

enum class RateQuirk { value, timer, operation };

struct Script {
  std::vector<DeviceScript> devices;
  std::vector<std::string> default_names{"Default Device"};  // of the first device
  bool manual = false, null_name_fails = false, license_refused = false;
  double stall_limit = 1, transform_skew = 1e-4;  // s, 1
  RateQuirk rate_quirk = RateQuirk::value;
  std::vector<unsigned long> rates{500, 1000, 2000};  // Hz
  std::size_t scheduler_slots = 64;
  std::vector<Fault> faults;
};

/// `text`: JSON or the path of it; null: defaults. Throws std::runtime_error naming what is wrong.
Script parse_script(const char* text);
/// The rows of a .ctraj file: t, px, py, pz, and qx, qy, qz, qw, buttons if there. Throws std::runtime_error.
std::vector<Row> read_trajectory(const std::string& path);

}  // namespace fakehd
