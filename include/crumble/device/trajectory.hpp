// What a device did, row by row, and its file format `.ctraj` (reference: docs/devices.md).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "crumble/base/memory.hpp"
#include "crumble/device/device.hpp"

namespace crumble {

struct TrajectoryRow {
  double time = 0;                       // s, strictly increasing from row to row; where 0 lies is free
  Pose pose = {};                        // m; unit quaternion, tool -> device frame
  Vec3 linear_velocity = Vec3::Zero();   // m/s
  Vec3 angular_velocity = Vec3::Zero();  // rad/s
  std::uint32_t buttons = 0;
  Vec3 force = Vec3::Zero();   // N, on the hand
  Vec3 torque = Vec3::Zero();  // N m
  std::uint32_t flags = 0;     // sample_flag bits
};

struct Trajectory {
  /// Lines "key: value" that say where the motion comes from, in file order. Keys nobody knows are kept.
  Vector<std::string> header;
  /// quantity bits of the columns present; what is absent stands at its default in every row.
  std::uint32_t columns = quantity::kPosition;
  Vector<TrajectoryRow> rows;

  /// The value of the first header line "key: value"; empty when there is none.
  std::string_view value_of(std::string_view key) const;
};

inline constexpr std::size_t kMaxTrajectoryRows = 10'000'000;  // 2.7 hours at 1 kHz

/// Throws Error naming the row (from 0) and column: empty (no row), too_large, invalid_value (not finite), out_of_range
/// (time does not increase), bad_pose (| |q| - 1 | > 1e-3), format (a header line that would not read back).
void validate(const Trajectory& trajectory);

/// The text of a file, which parses back to the same bits. Throws what validate throws.
std::string format_trajectory(const Trajectory& trajectory);
/// `name` stands in the messages, which also give the line and, where cells are at fault, the character (byte) in it
/// where they begin, both from 1, and their columns' names: "line 7, column 3 (py)". Throws Error:
/// empty (no text, no row), format (no magic line, missing, unknown or double column, a cell that is no number, wrong
/// count of cells), version, unsupported (other units than SI), invalid_value, out_of_range, bad_pose (as validate),
/// corrupt (end line missing or wrong), too_large.
Trajectory parse_trajectory(std::string_view text, std::string_view name);

/// parse_trajectory of a file; also throws Error(io) when it cannot be read.
Trajectory read_trajectory(const std::string& path);
/// Written beside `path` under another name and then renamed, so that `path` is the whole file or untouched.
/// Throws Error(io) and what validate throws.
void write_trajectory(const std::string& path, const Trajectory& trajectory);

}  // namespace crumble
