#include "crumble/device/trajectory.hpp"

#include <cmath>

#include "crumble/base/text.hpp"
#include "device/quoted.hpp"
#include "device/trajectory_columns.hpp"

namespace crumble {
namespace device {

Cells to_cells(const TrajectoryRow& row) {
  const Vec3 &p = row.pose.position, &v = row.linear_velocity, &w = row.angular_velocity;
  const Vec3 &f = row.force, &m = row.torque;
  const Quat& q = row.pose.orientation;
  return {row.time,
          p.x(),
          p.y(),
          p.z(),
          q.x(),
          q.y(),
          q.z(),
          q.w(),
          v.x(),
          v.y(),
          v.z(),
          w.x(),
          w.y(),
          w.z(),
          static_cast<double>(row.buttons),
          f.x(),
          f.y(),
          f.z(),
          m.x(),
          m.y(),
          m.z(),
          static_cast<double>(row.flags)};
}

TrajectoryRow to_row(const Cells& c) {
  return {.time = c[0],
          .pose = {{c[1], c[2], c[3]}, Quat(c[7], c[4], c[5], c[6])},
          .linear_velocity = {c[8], c[9], c[10]},
          .angular_velocity = {c[11], c[12], c[13]},
          .buttons = static_cast<std::uint32_t>(c[14]),
          .force = {c[15], c[16], c[17]},
          .torque = {c[18], c[19], c[20]},
          .flags = static_cast<std::uint32_t>(c[21])};
}

std::optional<Problem> find_problem(const Cells& cells, std::optional<double> previous) {
  for (std::size_t i = 0; i < kColumnCount; ++i) {
    const Column& column = kColumns[i];
    if (!std::isfinite(cells[i])) {
      return Problem{Code::invalid_value, "must be finite, is " + to_text(cells[i]), column.name, i};
    }
    if (column.whole && !(cells[i] >= 0 && cells[i] <= 0xffffffffu && std::floor(cells[i]) == cells[i])) {
      return Problem{Code::out_of_range, "must be a whole number in [0, 4294967295], is " + to_text(cells[i]),
                     column.name, i};
    }
  }
  if (previous && !(cells[0] > *previous)) {
    return Problem{Code::out_of_range, "must increase, is " + to_text(cells[0]) + " after " + to_text(*previous), "t",
                   0};
  }
  const double length =
      std::sqrt((cells[4] * cells[4] + cells[5] * cells[5]) + (cells[6] * cells[6] + cells[7] * cells[7]));
  if (!(std::abs(length - 1) <= 1e-3)) {
    return Problem{Code::bad_pose, "must have length 1 within 1e-3, have " + to_text(length), "qx qy qz qw", 4};
  }
  return std::nullopt;
}

std::optional<Problem> find_problem(std::string_view header_line) {
  if (header_line.find_first_of("\r\n") != std::string_view::npos) {
    return Problem{Code::format, "a header line must not contain a line break"};
  }
  if (header_line.starts_with(kEnd.substr(2)))
    return Problem{Code::format, "a header line must not begin with '" + std::string(kEnd.substr(2)) + "'"};
  const auto units = value_in(header_line, "units");
  if (units && *units != kUnits) {
    return Problem{Code::unsupported, "units must be '" + std::string(kUnits) + "', are " + quoted(*units)};
  }
  return std::nullopt;
}

std::optional<std::string_view> value_in(std::string_view header_line, std::string_view key) {
  if (!header_line.starts_with(key) || !header_line.substr(key.size()).starts_with(':')) return std::nullopt;
  std::string_view value = header_line.substr(key.size() + 1);
  while (value.starts_with(' ')) value.remove_prefix(1);
  while (value.ends_with(' ')) value.remove_suffix(1);
  return value;
}

}  // namespace device

std::string_view Trajectory::value_of(std::string_view key) const {
  for (const std::string& line : header) {
    if (const auto value = device::value_in(line, key)) return *value;
  }
  return {};
}

void validate(const Trajectory& trajectory) {
  if (trajectory.rows.empty()) throw Error(Code::empty, "trajectory has no row");
  if (trajectory.rows.size() > kMaxTrajectoryRows) {
    throw Error(Code::too_large, "trajectory has " + std::to_string(trajectory.rows.size()) + " rows, more than " +
                                     std::to_string(kMaxTrajectoryRows));
  }
  for (std::size_t i = 0; i < trajectory.header.size(); ++i) {
    if (const auto problem = device::find_problem(trajectory.header[i])) {
      throw Error(problem->code, "trajectory.header[" + std::to_string(i) + "]: " + problem->text);
    }
  }
  std::optional<double> previous;
  for (std::size_t i = 0; i < trajectory.rows.size(); ++i) {
    const device::Cells cells = device::to_cells(trajectory.rows[i]);
    if (const auto problem = device::find_problem(cells, previous)) {
      const char* noun = problem->columns.find(' ') == std::string::npos ? "column " : "columns ";
      throw Error(problem->code,
                  "trajectory.rows[" + std::to_string(i) + "]: " + noun + problem->columns + ' ' + problem->text);
    }
    previous = cells[0];
  }
}

}  // namespace crumble
