// The format was learnt from HAPI's sources (GPL; nothing of them is here): DeviceLog writes a line of names, then
// lines of numbers with five decimals, all separated by single blanks; DeviceLog's own reader takes any blanks.
#include "crumble/device/hapi_log.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "crumble/base/file.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/text.hpp"
#include "device/check.hpp"
#include "device/quoted.hpp"

namespace crumble {
namespace {

struct Field {
  std::string_view name;
  std::size_t width;           // cells
  std::uint32_t quantity = 0;  // of the trajectory; 0: left out
};

enum : std::size_t { kTime, kPosition, kOrientation, kVelocity, kForce, kTorque, kButtons };

constexpr std::array<Field, 13> kFields = {{{"TIME", 1, quantity::kPosition},
                                            {"POSITION", 3, quantity::kPosition},
                                            {"ORIENTATION", 4, quantity::kOrientation},
                                            {"VELOCITY", 3, quantity::kLinearVelocity},
                                            {"FORCE", 3, quantity::kForce},
                                            {"TORQUE", 3, quantity::kTorque},
                                            {"BUTTONS", 1, quantity::kButtons},
                                            {"RAW_POSITION", 3},
                                            {"RAW_ORIENTATION", 4},
                                            {"RAW_VELOCITY", 3},
                                            {"RAW_FORCE", 3},
                                            {"RAW_TORQUE", 3},
                                            {"TIMESTAMP", 1}}};
constexpr double kMostAngle = 1e4;  // rad: what sin_exact takes

class LogParser {
 public:
  LogParser(std::string_view text, std::string_view name, const HapiLogOptions& options)
      : rest_(text), name_(name), options_(options) {}

  Trajectory parse() {
    if (!next_line()) throw Error(Code::empty, name_ + " is empty");
    if (line_.find('\0') != std::string_view::npos) {
      fail(Code::unsupported,
           "is a binary log: whether its numbers have 4 or 8 bytes depends on the HAPI that wrote it; log as text");
    }
    parse_names();
    if (cut_off_) fail(Code::corrupt, "is truncated: it ends within its column names");
    while (next_line()) {
      if (out_.rows.size() == kMaxTrajectoryRows) {
        fail(Code::too_large, "more than " + std::to_string(kMaxTrajectoryRows) + " rows");
      }
      parse_row();
    }
    if (out_.rows.empty()) fail(Code::empty, "has no row");
    write_header();
    return std::move(out_);
  }

 private:
  struct Cell {
    std::string_view text;  // part of line_
    double value = 0;
  };
  using Cells = std::array<Cell, 4>;  // of one field

  void parse_names() {
    while (const auto name = next_word()) {
      const auto* field = std::find_if(kFields.begin(), kFields.end(), [&](const Field& f) { return f.name == *name; });
      if (field == kFields.end()) fail_at(*name, "", Code::format, "unknown column " + device::quoted(*name));
      const auto index = static_cast<std::size_t>(field - kFields.begin());
      if (std::find(order_.begin(), order_.end(), index) != order_.end()) {
        fail_at(*name, "", Code::format, "column " + std::string(*name) + " stands twice");
      }
      order_.push_back(index);
      width_ += field->width;
      out_.columns |= field->quantity;
    }
    for (const std::size_t index : {kTime, kPosition}) {
      if (std::find(order_.begin(), order_.end(), index) == order_.end()) {
        fail(Code::format, "column " + std::string(kFields[index].name) + " is missing");
      }
    }
  }

  void parse_row() {
    // Its last number may have lost digits
    if (cut_off_) fail(Code::corrupt, "is truncated: it ends within a row");
    TrajectoryRow row;
    std::string_view time;
    std::size_t count = 0;
    for (const std::size_t index : order_) {
      Cells cells;
      for (std::size_t i = 0; i < kFields[index].width; ++i, ++count) cells[i] = next_cell(index, count);
      if (index == kTime) time = cells[0].text;
      take(index, cells, row);
    }
    if (const auto more = next_word()) {
      fail_at(*more, "", Code::format, "more than the " + std::to_string(width_) + " cells of the column names");
    }
    if (!out_.rows.empty() && !(row.time > out_.rows.back().time)) {
      if (row.time == out_.rows.back().time && options_.drop_repeated) {
        ++repeated_;
        return;
      }
      fail_at(time, kTime, Code::out_of_range,
              "must increase, is " + to_text(row.time) + " after " + to_text(out_.rows.back().time));
    }
    out_.rows.push_back(row);
  }

  Cell next_cell(std::size_t field, std::size_t count) {
    const auto word = next_word();
    if (!word) {
      fail(Code::format, std::to_string(count) + " cells, the column names are " + std::to_string(width_));
    }
    const auto value = parse_double(*word);
    if (!value) fail_at(*word, field, Code::format, device::quoted(*word) + " is not a number");
    const bool length = field == kPosition || field == kVelocity;
    const Cell cell{*word, length ? *value * options_.length_unit : *value};
    if (!std::isfinite(cell.value)) {
      fail_at(*word, field, Code::invalid_value, "must be finite, is " + to_text(cell.value));
    }
    return cell;
  }

  void take(std::size_t field, const Cells& cells, TrajectoryRow& row) const {
    const Vec3 vector = {cells[0].value, cells[1].value, cells[2].value};
    switch (field) {
      case kTime:
        row.time = vector.x();
        break;
      case kPosition:
        row.pose.position = vector;
        break;
      case kOrientation:
        row.pose.orientation = orientation(cells);
        break;
      case kVelocity:
        row.linear_velocity = vector;
        break;
      case kForce:
        row.force = vector;
        break;
      case kTorque:
        row.torque = vector;
        break;
      case kButtons:
        row.buttons = buttons(cells[0]);
        break;
      default:
        break;
    }
  }

  Quat orientation(const Cells& cells) const {
    const Vec3 axis = {cells[0].value, cells[1].value, cells[2].value};
    const double angle = cells[3].value, length = norm(axis);
    if (length == 0 && angle == 0) return Quat::Identity();
    if (!(std::abs(length - 1) <= 1e-3)) {
      fail_at(cells[0].text, kOrientation, Code::bad_pose,
              "the axis must have length 1 within 1e-3, has " + to_text(length));
    }
    if (std::abs(angle) > kMostAngle) {
      fail_at(cells[3].text, kOrientation, Code::out_of_range,
              "the angle must lie in [-10000, 10000], is " + to_text(angle));
    }
    return renormalized({Vec3::Zero(), axis_angle(axis / length, angle)}).orientation;
  }

  // HAPI keeps them in a signed number
  std::uint32_t buttons(const Cell& cell) const {
    if (!(cell.value >= -0x1p31 && cell.value < 0x1p31 && std::floor(cell.value) == cell.value)) {
      fail_at(cell.text, kButtons, Code::out_of_range,
              "must be a whole number in [-2147483648, 2147483647], is " + to_text(cell.value));
    }
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(cell.value));
  }

  void write_header() {
    const std::string unit = to_text(options_.length_unit);
    out_.header = {
        "source: HAPI DeviceLog", "units: m s N N*m rad", "frame: assumed to be x right, y up, z towards the user",
        "assumed: lengths in units of " + unit + " m, times in s, angles in rad, forces in N, torques in N*m"};
    if (repeated_ > 0) out_.header.push_back("repeated_rows_dropped: " + std::to_string(repeated_));
  }

  /// Takes the next word off line_; nothing when there is none.
  std::optional<std::string_view> next_word() {
    const std::size_t begin = std::min(line_.find_first_not_of(" \t"), line_.size());
    line_.remove_prefix(begin);
    if (line_.empty()) return std::nullopt;
    const std::string_view word = line_.substr(0, line_.find_first_of(" \t"));
    line_.remove_prefix(word.size());
    return word;
  }

  bool next_line() {
    ++number_;
    if (rest_.empty()) return false;
    const std::size_t newline = rest_.find('\n');
    line_ = rest_.substr(0, newline);
    rest_.remove_prefix(std::min(rest_.size(), line_.size() + 1));
    cut_off_ = newline == std::string_view::npos;
    if (line_.ends_with('\r')) line_.remove_suffix(1);
    begin_ = line_.data();
    return true;
  }

  [[noreturn]] void fail(Code code, const std::string& text) const {
    throw Error(code, name_ + ": line " + std::to_string(number_) + ": " + text);
  }
  [[noreturn]] void fail_at(std::string_view cell, std::string_view column, Code code, const std::string& text) const {
    const std::string note = column.empty() ? "" : " (" + std::string(column) + ")";
    throw Error(code, name_ + ": line " + std::to_string(number_) + ", column " +
                          std::to_string(cell.data() - begin_ + 1) + note + ": " + text);
  }
  [[noreturn]] void fail_at(std::string_view cell, std::size_t field, Code code, const std::string& text) const {
    fail_at(cell, kFields[field].name, code, text);
  }

  std::string_view rest_;
  std::string_view line_;        // what is left of it
  const char* begin_ = nullptr;  // of the whole of it
  std::string name_;
  HapiLogOptions options_;
  bool cut_off_ = false;       // whether the line ends with the text instead of an end of line
  std::size_t number_ = 0;     // of the line, from 1
  Vector<std::size_t> order_;  // fields of a row, as indices into kFields
  std::size_t width_ = 0;      // cells of a row
  std::size_t repeated_ = 0;
  Trajectory out_;
};

}  // namespace

Trajectory parse_hapi_log(std::string_view text, std::string_view name, const HapiLogOptions& options) {
  require_positive("hapi_log.length_unit", options.length_unit);
  return LogParser(text, name, options).parse();
}

Trajectory read_hapi_log(const std::string& path, const HapiLogOptions& options) {
  return parse_hapi_log(read_text(path), path, options);
}

}  // namespace crumble
