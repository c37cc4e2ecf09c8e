#include "render/text_curve.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"

namespace crumble::render {
namespace {

constexpr double kGreatest = 1e100;  // beyond it, and below its inverse, steps of the axes would leave double's range

struct Range {
  double least, greatest;
};

// The next greater of 1, 1.5, 2, 2.5, 3, 4, 5, 6 or 8 times a power of ten.
double next_round(double value) {
  double power = 1;
  while (power > value) power /= 10;
  while (power * 10 <= value) power *= 10;
  for (const double factor : {1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0}) {
    if (factor * power > value) return factor * power;
  }
  return 10 * power;
}

// Round numbers `step` apart, the first at the range's lower end.
struct Axis {
  Range range;
  double step;
};

// The smallest round step with which `intervals` steps (not always a whole number) cover 0 and all values.
Axis round_axis(std::span<const double> values, double intervals) {
  const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
  const double lower = std::min(0.0, *least), upper = std::max(0.0, *greatest);
  if (upper - lower < 1 / kGreatest) return {{0, intervals}, 1};
  double step = 0.999 * (upper - lower) / intervals;
  for (;;) {
    step = next_round(step);
    const double start = step * std::floor(lower / step);
    if (start + step * intervals >= upper) return {{start, start + step * intervals}, step};
  }
}

// Dots of a braille cell: bit of the dot in column 0 or 1, row 0 to 3 (Unicode block 2800).
constexpr std::uint8_t kDots[4][2] = {{0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}};

class Canvas {
 public:
  Canvas(int width, int height) : width_(width), height_(height), cells_(static_cast<std::size_t>(width) * height, 0) {}
  // From row `first` to row `last` of dots, rows counted from the bottom.
  void ink(int column, int first, int last) {
    for (int row = std::min(first, last); row <= std::max(first, last); ++row) {
      const int from_top = 4 * height_ - 1 - row;
      cells_[static_cast<std::size_t>(from_top / 4) * width_ + column / 2] |= kDots[from_top % 4][column % 2];
    }
  }
  std::string line(int row) const {
    std::string text;
    for (int column = 0; column < width_; ++column) {
      const std::uint8_t cell = cells_[static_cast<std::size_t>(row) * width_ + column];
      // U+2800 + cell as UTF-8; an empty cell is a plain space, which every font has.
      if (cell == 0)
        text += ' ';
      else
        text += {'\xe2', static_cast<char>(0xa0 | cell >> 6), static_cast<char>(0x80 | (cell & 0x3f))};
    }
    return text;
  }

 private:
  int width_, height_;
  Vector<std::uint8_t> cells_;
};

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

void check_input(std::span<const double> x, std::span<const double> y, int width, int height) {
  require_in_range("width", width, 20, 400);
  require_in_range("height", height, 3, 100);
  if (x.empty()) throw Error(Code::empty, "x must have at least one value, has 0");
  if (x.size() != y.size()) {
    throw Error(Code::invalid_value,
                "y must have " + std::to_string(x.size()) + " values like x, has " + std::to_string(y.size()));
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    require_in_range("x[" + std::to_string(i) + "]", x[i], -kGreatest, kGreatest);
    require_in_range("y[" + std::to_string(i) + "]", y[i], -kGreatest, kGreatest);
  }
}

// Straight lines from point to point, each column inked over the rows that the line passes there.
void ink_curve(Canvas& canvas, std::span<const double> columns, std::span<const double> rows) {
  const auto nearest = [](double v) { return static_cast<int>(std::lround(v)); };
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::size_t before = i > 0 ? i - 1 : 0;
    const int from = nearest(columns[before]), to = nearest(columns[i]), step = to < from ? -1 : 1;
    const double slope = from == to ? 0 : (rows[i] - rows[before]) / (columns[i] - columns[before]);
    for (int column = from;; column += step) {
      const auto row_at = [&](double at) {
        const double row = rows[before] + slope * (at - columns[before]);
        return nearest(std::clamp(row, std::min(rows[before], rows[i]), std::max(rows[before], rows[i])));
      };
      if (from == to)
        canvas.ink(column, nearest(rows[before]), nearest(rows[i]));
      else
        canvas.ink(column, row_at(column - 0.5 * step), row_at(column + 0.5 * step));
      if (column == to) break;
    }
  }
}

constexpr std::size_t kMargin = 8;  // columns for y's numbers
constexpr int kXIntervals = 5;

std::string right_aligned(const std::string& text) {
  return std::string(kMargin - 1 - std::min(text.size(), kMargin - 1), ' ') + text;
}

// The line below the curve with a tick at each step, and their numbers, the label after the last.
std::string x_axis(const Axis& axis, int width, std::string_view label) {
  Vector<bool> is_tick(static_cast<std::size_t>(width), false);
  std::string numbers;
  for (int i = 0; i <= kXIntervals; ++i) {
    const int column = (i * (width - 1) + kXIntervals / 2) / kXIntervals;
    is_tick[static_cast<std::size_t>(column)] = true;
    numbers.resize(std::max(static_cast<std::size_t>(column), numbers.size()), ' ');
    numbers += number(axis.range.least + i * axis.step);
  }
  std::string line;
  for (const bool tick : is_tick) line += tick ? "\u2534" : "\u2500";
  const std::string margin(kMargin, ' ');
  return margin + "\u2514" + line + '\n' + margin + ' ' + numbers + "  " + std::string(label) + '\n';
}

Vector<double> scaled(std::span<const double> values, const Range& range, int dots) {
  Vector<double> out;
  for (const double v : values) out.push_back((v - range.least) / (range.greatest - range.least) * (dots - 1));
  return out;
}

}  // namespace

std::string text_curve(std::span<const double> x, std::span<const double> y, int width, int height,
                       const CurveLabels& labels) {
  check_input(x, y, width, height);
  const int rows_per_tick = height < 6 ? 1 : std::max(2, (height - 1) / 4);
  const Axis across = round_axis(x, kXIntervals);
  const Axis up = round_axis(y, static_cast<double>(height - 1) / rows_per_tick);
  Canvas canvas(width, height);
  ink_curve(canvas, scaled(x, across.range, 2 * width), scaled(y, up.range, 4 * height));
  std::string out = std::string(kMargin, ' ') + std::string(labels.y) + '\n';
  for (int row = 0; row < height; ++row) {
    const int above = height - 1 - row;
    const bool is_tick = above % rows_per_tick == 0;
    const double value = up.range.least + above / rows_per_tick * up.step;
    out += is_tick ? right_aligned(number(value)) + " \u2524" : right_aligned("") + " \u2502";
    out += canvas.line(row) + '\n';
  }
  return out + x_axis(across, width, labels.x);
}

}  // namespace crumble::render
