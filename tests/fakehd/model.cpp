// What moves and warms: a hand that holds the device, or a trajectory that it follows, and the motors. By ticks, so
// that a run gives the same whatever the machine does.
#include <algorithm>

#include "fakehd_state.hpp"

namespace fakehd {
namespace {

constexpr int kSubsteps = 16;
constexpr double kSmoothing = 8;  // ticks
// A motor that gives the continuous force for ever ends here, of 1.
constexpr double kContinuousTemperature = 0.6;
constexpr double kMm = 1000;  // of a metre

double least_jerk(double u) {
  return u * u * u * (10 + u * (6 * u - 15));
}

Vec between(const Vec& a, const Vec& b, double u) {
  return {a[0] + u * (b[0] - a[0]), a[1] + u * (b[1] - a[1]), a[2] + u * (b[2] - a[2])};
}

Vec wanted(const Session& d, const Hand& hand, double time) {
  if (d.placed) return d.place;
  const auto later = [time](const HandPoint& p) { return p.t > time; };
  const auto next = std::find_if(hand.points.begin(), hand.points.end(), later);
  if (next == hand.points.begin()) return next->at;
  const auto& from = *(next - 1);
  if (next == hand.points.end()) return from.at;
  return between(from.at, next->at, least_jerk((time - from.t) / (next->t - from.t)));
}

void push_hand(Session& d, const Hand& hand, double dt) {
  const double h = dt / kSubsteps;
  for (int i = 0; i < kSubsteps; ++i) {
    const Vec target = wanted(d, hand, d.time - dt + (i + 1) * h);
    for (std::size_t k = 0; k < 3; ++k) {
      const double grip = hand.stiffness * (target[k] - d.position[k]) - hand.damping * d.velocity[k];
      d.velocity[k] += h * (grip + d.applied[k]) / hand.mass;
      d.position[k] += h * d.velocity[k];
    }
  }
}

/// The row at or before `time` and how far it is to the next, 0 to 1.
std::pair<std::size_t, double> row_at(const std::vector<Row>& rows, double time) {
  const auto later = [](double t, const Row& row) { return t < row.t; };
  const auto next = std::upper_bound(rows.begin(), rows.end(), time, later);
  if (next == rows.begin()) return {0, 0};
  const auto index = static_cast<std::size_t>(next - rows.begin()) - 1;
  if (next == rows.end()) return {index, 0};
  return {index, (time - rows[index].t) / (next->t - rows[index].t)};
}

void follow(Session& d, const std::vector<Row>& rows, double dt) {
  const auto [i, u] = row_at(rows, d.time);
  const Vec at = between(rows[i].at, rows[std::min(i + 1, rows.size() - 1)].at, u);
  d.velocity = scaled(minus(at, d.position), 1 / dt);
  d.position = at;
}

void warm(Session& d, const DeviceScript& script, double dt) {
  for (std::size_t i = 0; i < 3; ++i) {
    const double load = d.applied[i] / script.continuous_force;
    const double goal = kContinuousTemperature * load * load;
    d.temperature[i] = std::clamp(d.temperature[i] + dt / script.thermal_time * (goal - d.temperature[i]), 0.0, 1.0);
  }
}

Quat turn_at(const std::vector<Row>& rows, double time) {
  if (rows.empty()) return {0, 0, 0, 1};
  const auto [i, u] = row_at(rows, time);
  const Quat& a = rows[i].turn;
  const Quat& b = rows[std::min(i + 1, rows.size() - 1)].turn;
  const double dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  Quat q{};
  double square = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    q[k] = (1 - u) * a[k] + u * (dot < 0 ? -b[k] : b[k]);
    square += q[k] * q[k];
  }
  if (!(square > 0)) return {0, 0, 0, 1};
  for (double& x : q) x /= std::sqrt(square);
  return q;
}

/// Column-major. `skew` lengthens the first axis and leans the second on it: drivers tell rotations that are none.
std::array<double, 16> transform_of(const Quat& q, const Vec& at, double skew) {
  const auto [x, y, z, w] = q;
  const Vec i = {1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)};
  const Vec j = {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)};
  const Vec k = {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)};
  std::array<double, 16> m{};
  for (std::size_t row = 0; row < 3; ++row) {
    m[row] = i[row] * (1 + skew);
    m[4 + row] = j[row] + skew * i[row];
    m[8 + row] = k[row];
    m[12 + row] = at[row];
  }
  m[15] = 1;
  return m;
}

}  // namespace

void advance(State& s, Session& d) {
  const DeviceScript& script = script_of(s, d);
  const double dt = 1 / static_cast<double>(s.rate);
  const Vec before = d.position;
  d.time += dt;
  if (script.trajectory.empty() || d.placed) {
    push_hand(d, script.hand, dt);
  } else {
    follow(d, script.trajectory, dt);
  }
  const Vec moved = minus(d.position, before);
  for (std::size_t k = 0; k < 3; ++k) {
    d.smoothed[k] += (moved[k] * kMm / dt - d.smoothed[k]) / kSmoothing;
    d.integral[k] += d.applied[k] * dt;
    d.work += d.applied[k] * moved[k];
  }
  warm(d, script, dt);
}

Report make_report(const State& s, const Session& d) {
  const DeviceScript& script = script_of(s, d);
  Report r;
  r.buttons = d.pressed;
  if (!script.trajectory.empty()) r.buttons |= script.trajectory[row_at(script.trajectory, d.time).first].buttons;
  r.in_inkwell = in_inkwell(s, d);
  if (!d.calibrated) {
    r.position = script.uncalibrated;
    r.transform = transform_of({0, 0, 0, 1}, r.position, s.script.transform_skew);
    return r;
  }
  r.position = scaled(d.position, kMm);
  if (const double step = script.position_step; step > 0) {
    for (double& x : r.position) x = std::round(x / step) * step;
  }
  r.velocity = d.smoothed;
  r.transform = transform_of(turn_at(script.trajectory, d.time), r.position, s.script.transform_skew);
  // No arm's kinematics: angles that are not zero and move with the hand.
  r.joints = {std::atan2(r.position[0], 200), 0.5 + std::atan2(r.position[1], 200),
              0.5 + std::atan2(r.position[2], 200)};
  r.gimbal = {0.1, 0.2, 0.3};
  return r;
}

}  // namespace fakehd
