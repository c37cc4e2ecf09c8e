// Reads .ctraj text. Nothing in the file is believed: memory grows with the text that is there, never with a count that
// it states, and every complaint says where.
#include <algorithm>

#include "crumble/base/memory.hpp"
#include "crumble/base/text.hpp"
#include "device/quoted.hpp"
#include "device/trajectory_columns.hpp"

namespace crumble {
namespace {

using device::Cells;
using device::kColumnCount;
using device::kColumns;

class Parser {
 public:
  Parser(std::string_view text, std::string_view name) : rest_(text), name_(name) {}

  Trajectory parse() {
    if (rest_.empty()) throw Error(Code::empty, name_ + " is empty");
    parse_magic();
    parse_header();
    parse_column_names();
    parse_rows();
    return std::move(out_);
  }

 private:
  void parse_magic() {
    next_line();
    if (!line_.starts_with(device::kMagic)) {
      fail(Code::format, "is no .ctraj file: it must begin with '" + std::string(device::kMagic) + "', not with " +
                             device::quoted(line_));
    }
    const std::string_view version = line_.substr(device::kMagic.size());
    if (version != device::kVersion) {
      fail(Code::version,
           "has .ctraj version " + device::quoted(version) + ", this library reads " + std::string(device::kVersion));
    }
  }

  void parse_header() {
    while (next_line() && line_.starts_with('#')) {
      if (line_.starts_with(device::kEnd)) fail(Code::format, "ends before its column names");
      line_.remove_prefix(line_.starts_with("# ") ? 2 : 1);
      if (const auto problem = device::find_problem(line_)) fail(problem->code, problem->text);
      out_.header.emplace_back(line_);
    }
    if (at_end_) fail(Code::corrupt, "is truncated: it ends before its column names");
  }

  void parse_column_names() {
    std::array<bool, kColumnCount> seen{};
    for (std::string_view left = line_; auto name = next_cell(left);) {
      const auto column =
          std::find_if(kColumns.begin(), kColumns.end(), [&](const auto& c) { return c.name == *name; });
      if (column == kColumns.end()) fail_at(*name, "", Code::format, "unknown column " + device::quoted(*name));
      const auto index = static_cast<std::size_t>(column - kColumns.begin());
      if (seen[index]) fail_at(*name, "", Code::format, "column " + std::string(*name) + " stands twice");
      seen[index] = true;
      order_.push_back(index);
      out_.columns |= column->quantity;
    }
    for (std::size_t i = 0; i < kColumnCount; ++i) {
      if (!seen[i] && (out_.columns & kColumns[i].quantity)) {
        fail(Code::format, std::string("column ") + kColumns[i].name + " is missing");
      }
    }
  }

  void parse_rows() {
    while (next_line() && !line_.starts_with('#')) {
      if (out_.rows.size() == kMaxTrajectoryRows) {
        fail(Code::too_large, "more than " + std::to_string(kMaxTrajectoryRows) + " rows");
      }
      parse_row();
    }
    std::string end(device::kEnd);
    end += std::to_string(out_.rows.size());
    if (at_end_) fail(Code::corrupt, "is truncated: the end line '" + end + "' is missing");
    if (line_ != end) fail(Code::corrupt, "the end line must be '" + end + "', is " + device::quoted(line_));
    if (next_line()) fail(Code::corrupt, "text after the end line");
    if (out_.rows.empty()) fail(Code::empty, "has no row");
  }

  void parse_row() {
    const auto count = static_cast<std::size_t>(std::count(line_.begin(), line_.end(), ',')) + 1;
    if (count != order_.size()) {
      fail(Code::format, std::to_string(count) + " cells, the column names are " + std::to_string(order_.size()));
    }
    Cells cells = device::to_cells({});
    std::array<std::string_view, kColumnCount> texts;
    std::string_view left = line_;
    for (const std::size_t index : order_) {
      const std::string_view cell = texts[index] = *next_cell(left);
      const auto value = parse_double(cell);
      if (!value) fail_at(cell, kColumns[index].name, Code::format, device::quoted(cell) + " is not a number");
      cells[index] = *value;
    }
    std::optional<double> previous;
    if (!out_.rows.empty()) previous = out_.rows.back().time;
    if (const auto problem = device::find_problem(cells, previous)) {
      fail_at(texts[problem->first], problem->columns, problem->code, problem->text);
    }
    out_.rows.push_back(device::to_row(cells));
  }

  /// Takes the text up to the next comma off `left`; nothing when the last cell has been taken.
  static std::optional<std::string_view> next_cell(std::string_view& left) {
    if (left.data() == nullptr) return std::nullopt;
    const std::size_t comma = left.find(',');
    const std::string_view cell = left.substr(0, comma);
    left = comma == std::string_view::npos ? std::string_view() : left.substr(comma + 1);
    return cell;
  }

  /// Moves to the next line, which may end in CR LF, LF or the end of the text; false when there is none.
  bool next_line() {
    ++number_;
    at_end_ = rest_.empty();
    if (at_end_) return false;
    const std::size_t newline = rest_.find('\n');
    line_ = rest_.substr(0, newline);
    rest_ = newline == std::string_view::npos ? std::string_view() : rest_.substr(newline + 1);
    if (line_.ends_with('\r')) line_.remove_suffix(1);
    return true;
  }

  [[noreturn]] void fail(Code code, const std::string& text) const {
    throw Error(code, name_ + ": line " + std::to_string(number_) + ": " + text);
  }

  /// At `cell`, a part of line_.
  [[noreturn]] void fail_at(std::string_view cell, const std::string& columns, Code code,
                            const std::string& text) const {
    throw Error(code, name_ + ": line " + std::to_string(number_) + ", column " +
                          std::to_string(cell.data() - line_.data() + 1) +
                          (columns.empty() ? "" : " (" + columns + ")") + ": " + text);
  }

  std::string_view rest_;
  std::string_view line_;
  std::string name_;
  std::size_t number_ = 0;  // of line_, from 1
  bool at_end_ = false;
  Vector<std::size_t> order_;  // column of each cell, as an index into kColumns
  Trajectory out_;
};

}  // namespace

Trajectory parse_trajectory(std::string_view text, std::string_view name) {
  return Parser(text, name).parse();
}

}  // namespace crumble
