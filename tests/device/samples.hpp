// What several tests of this module share.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <string>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/random.hpp"
#include "crumble/device/device.hpp"
#include "crumble/device/trajectory.hpp"

namespace crumble {

/// Everything in a sample but its sequence number, bit by bit.
inline std::array<std::uint64_t, 16> bits(const DeviceSample& s) {
  const auto b = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  const Quat& q = s.pose.orientation;
  return {b(s.time),
          b(s.pose.position.x()),
          b(s.pose.position.y()),
          b(s.pose.position.z()),
          b(q.x()),
          b(q.y()),
          b(q.z()),
          b(q.w()),
          b(s.linear_velocity.x()),
          b(s.linear_velocity.y()),
          b(s.linear_velocity.z()),
          b(s.angular_velocity.x()),
          b(s.angular_velocity.y()),
          b(s.angular_velocity.z()),
          s.buttons,
          s.flags};
}

/// The next `n` samples, whatever their status.
inline Vector<DeviceSample> read_some(Device& device, std::size_t n) {
  Vector<DeviceSample> samples(n);
  for (DeviceSample& sample : samples) static_cast<void>(device.read(sample));
  return samples;
}

/// By the difference of its neighbours: what samples k - 1, k, k + 1 say of the velocities at k.
inline Vec3 differenced_velocity(const DeviceSample* at) {
  return (at[1].pose.position - at[-1].pose.position) / (at[1].time - at[-1].time);
}
inline Vec3 differenced_turning(const DeviceSample* at) {
  const Quat turned = multiply(at[1].pose.orientation, at[-1].pose.orientation.conjugate());
  return Vec3(turned.x(), turned.y(), turned.z()) * (2 / turned.w() / (at[1].time - at[-1].time));
}

/// Runs `action` and returns its Error; a code of Code{} when it throws none.
inline Error error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error;
  }
  return {Code{}, "no error"};
}

inline bool mentions(const Error& error, const std::string& text) {
  return std::string(error.what()).find(text) != std::string::npos;
}

inline Vec3 random_vec(Random& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

inline Quat random_quat(Random& random) {
  Vec3 axis = random_vec(random, 1);
  return axis_angle(normalized(axis), random.uniform(0.0, 3.0));
}

/// `n` rows every ~10 ms with jitter, all columns filled.
inline Trajectory random_trajectory(std::uint64_t seed, std::size_t n) {
  Random random(seed);
  Trajectory out;
  out.columns = quantity::kAll;
  out.header = {"device: none", "an unknown key: kept as it is; even with ; and : in it"};
  double time = random.uniform(-5, 5);
  for (std::size_t i = 0; i < n; ++i, time += random.uniform(0.005, 0.015)) {
    out.rows.push_back({.time = time,
                        .pose = {random_vec(random, 0.1), random_quat(random)},
                        .linear_velocity = random_vec(random, 1),
                        .angular_velocity = random_vec(random, 1),
                        .buttons = static_cast<std::uint32_t>(random.next()),
                        .force = random_vec(random, 3),
                        .torque = random_vec(random, 1e-12),
                        .flags = static_cast<std::uint32_t>(random.below(2))});
  }
  return out;
}

}  // namespace crumble
