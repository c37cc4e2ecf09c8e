// The columns of a .ctraj file, one table for reader, writer and check.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "crumble/base/error.hpp"
#include "crumble/device/trajectory.hpp"

namespace crumble::device {

struct Column {
  const char* name;
  std::uint32_t quantity;  // the group that it comes and goes with
  bool whole = false;      // holds bits: a whole number below 2^32
};

inline constexpr std::size_t kColumnCount = 22;
inline constexpr std::array<Column, kColumnCount> kColumns = {{
    {"t", quantity::kPosition},         {"px", quantity::kPosition},        {"py", quantity::kPosition},
    {"pz", quantity::kPosition},        {"qx", quantity::kOrientation},     {"qy", quantity::kOrientation},
    {"qz", quantity::kOrientation},     {"qw", quantity::kOrientation},     {"vx", quantity::kLinearVelocity},
    {"vy", quantity::kLinearVelocity},  {"vz", quantity::kLinearVelocity},  {"wx", quantity::kAngularVelocity},
    {"wy", quantity::kAngularVelocity}, {"wz", quantity::kAngularVelocity}, {"buttons", quantity::kButtons, true},
    {"fx", quantity::kForce},           {"fy", quantity::kForce},           {"fz", quantity::kForce},
    {"tx", quantity::kTorque},          {"ty", quantity::kTorque},          {"tz", quantity::kTorque},
    {"flags", quantity::kFlags, true},
}};

/// A row with its numbers in the order of kColumns.
using Cells = std::array<double, kColumnCount>;
Cells to_cells(const TrajectoryRow& row);
TrajectoryRow to_row(const Cells& cells);

struct Problem {
  Code code;
  std::string text;
  std::string columns = {};  // names of the cells at fault, when some are
  std::size_t first = 0;     // index of the first of them
};
/// What is wrong with a row, if anything; `previous` is the time of the row before it.
std::optional<Problem> find_problem(const Cells& cells, std::optional<double> previous);
/// What is wrong with a header line (the text after "# ").
std::optional<Problem> find_problem(std::string_view header_line);

inline constexpr std::string_view kMagic = "# crumble-traj ";
inline constexpr std::string_view kVersion = "1";
inline constexpr std::string_view kEnd = "# end rows=";
inline constexpr std::string_view kUnits = "m s N N*m rad";

/// What follows "key:" in a header line, without the blanks around it; nothing when the line has another key.
std::optional<std::string_view> value_in(std::string_view header_line, std::string_view key);

}  // namespace crumble::device
