// Motion logged by HAPI, SenseGraphics' haptics library: files of its DeviceLog.
#pragma once

#include "crumble/device/trajectory.hpp"

namespace crumble {

struct HapiLogOptions {
  double length_unit = 1;  // m per unit of length of the log's positions and velocities, > 0
  bool drop_repeated =
      true;  // leave out rows with the time of the row before, which rounding makes; false: refuse them
};

/// A log as text. Its columns TIME, POSITION, ORIENTATION, VELOCITY, FORCE, TORQUE and BUTTONS become those of the
/// trajectory, orientations (axis and angle) as quaternions; RAW_... and TIMESTAMP are checked and left out. No unit
/// and no frame stands in a log: times are taken for s, angles for rad, forces for N, torques for N m, axes for x
/// right, y up, z towards the user. The header lines of the result say what was assumed and how many rows were dropped.
///
/// A log as binary is refused: the width of its numbers depends on the version and the build of HAPI that wrote it.
///
/// Throws Error naming file, line, column and the log's name for it: empty (no text, no row), format (a column that is
/// unknown or stands twice, no TIME or POSITION, a cell that is no number, wrong count of cells), unsupported (binary),
/// invalid_value (not finite), out_of_range (time that goes back, or repeats; buttons that are no 32 bits; angles above
/// 1e4), bad_pose (an axis whose length is off by more than 1e-3), corrupt (no end of line after the last row),
/// too_large; or the field of the options.
Trajectory parse_hapi_log(std::string_view text, std::string_view name, const HapiLogOptions& options = {});
/// parse_hapi_log of a file; also throws Error(io) when it cannot be read.
Trajectory read_hapi_log(const std::string& path, const HapiLogOptions& options = {});

}  // namespace crumble
