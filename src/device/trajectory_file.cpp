#include "crumble/base/file.hpp"
#include "crumble/base/text.hpp"
#include "device/trajectory_columns.hpp"

namespace crumble {
namespace {

/// A line with the cells of the columns present.
std::string joined(std::uint32_t columns, auto cell_of) {
  std::string line;
  for (std::size_t i = 0; i < device::kColumnCount; ++i) {
    if (!(columns & device::kColumns[i].quantity)) continue;
    if (!line.empty()) line += ',';
    line += cell_of(i);
  }
  return line + '\n';
}

}  // namespace

std::string format_trajectory(const Trajectory& trajectory) {
  validate(trajectory);
  const std::uint32_t columns = trajectory.columns | quantity::kPosition;
  std::string text = std::string(device::kMagic) + std::string(device::kVersion) + '\n';
  for (const std::string& line : trajectory.header) text += "# " + line + '\n';
  text += joined(columns, [](std::size_t i) { return std::string(device::kColumns[i].name); });
  for (const TrajectoryRow& row : trajectory.rows) {
    const device::Cells cells = device::to_cells(row);
    text += joined(columns, [&](std::size_t i) {
      return device::kColumns[i].whole ? std::to_string(static_cast<std::uint32_t>(cells[i])) : to_text(cells[i]);
    });
  }
  return text + std::string(device::kEnd) + std::to_string(trajectory.rows.size()) + '\n';
}

Trajectory read_trajectory(const std::string& path) {
  return parse_trajectory(read_text(path), path);
}

void write_trajectory(const std::string& path, const Trajectory& trajectory) {
  write_text(path, format_trajectory(trajectory));
}

}  // namespace crumble
