#include "zwidth_plots.hpp"

#include <algorithm>
#include <cmath>

#include "crumble/base/file.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/text.hpp"
#include "line.hpp"
#include "render/gnuplot.hpp"

namespace crumble::app {
namespace {

constexpr double kWidth = 760, kPanelHeight = 178, kGap = 68, kTop = 82, kBottom = 158;  // pixels
constexpr double kLeft = 78, kRight = 22, kBetween = 62;
constexpr double kHalf = 0.47;      // of a cell whose neighbours are 1 apart
constexpr double kMostDecades = 2;  // that a colour tells, to both sides of the limit

constexpr const char* kStyle = R"(set encoding utf8
set termoption noenhanced
set border 0
set tics nomirror out scale 0 textcolor '#222222'
unset key
unset colorbox
set style fill solid noborder
set palette defined (-2 '#12355b', -1 '#6f97bd', -0.02 '#e3ecf4', 0.02 '#fbe6d8', 1 '#ee9a6c', 2 '#c2410c')
set cbrange [-2:2]
set cbtics ('0.01' -2, '0.1' -1, '1' 0, '10' 1, '100' 2) textcolor '#222222'
)";

// Where a stiffness lies between those of the rows, which stand at 0, 1, 2, ... whatever they are.
double row_of(const Vector<double>& stiffnesses, double stiffness) {
  std::size_t above = 1;
  while (above + 1 < stiffnesses.size() && stiffnesses[above] < stiffness) ++above;
  const double low = std::log(stiffnesses[above - 1]), high = std::log(stiffnesses[above]);
  return static_cast<double>(above) - 1 + (std::log(stiffness) - low) / (high - low);
}

std::string cells_block(const StabilityMap& map) {
  std::string block = "$cells << EOD\n";
  for (std::size_t k = 0; k < map.stiffnesses.size(); ++k) {
    for (std::size_t r = 0; r < map.rates.size(); ++r) {
      const Press& p = map.at(k, r);
      const double decades = std::log10(std::max(1e-12, closed_loop::excess(p.outcome, p.setup)));
      const double colour =
          p.outcome.fault != Fault::none ? kMostDecades : std::clamp(decades, -kMostDecades, kMostDecades);
      const auto x = static_cast<double>(r), y = static_cast<double>(k);
      block += line("%g %g %g %g %g %g %g\n", x, y, x - kHalf, x + kHalf, y - kHalf, y + kHalf, colour);
    }
  }
  return block + "EOD\n";
}

// Empty when all pass.
std::string fails_block(const StabilityMap& map) {
  std::string rows;
  for (std::size_t k = 0; k < map.stiffnesses.size(); ++k) {
    for (std::size_t r = 0; r < map.rates.size(); ++r) {
      if (!map.at(k, r).passes()) rows += line("%zu %zu\n", r, k);
    }
  }
  return rows.empty() ? "" : "$fails << EOD\n" + rows + "EOD\n";
}

// The edge above the last row that is stable, as a stair, and the loop's own choice.
std::string curves_block(const StabilityMap& map) {
  std::string stable = "$stable << EOD\n", chosen = "$chosen << EOD\n";
  const Vector<double> largest = map.largest_stable();
  for (std::size_t r = 0; r < map.rates.size(); ++r) {
    const double edge = largest[r] > 0 ? row_of(map.stiffnesses, largest[r]) + 0.5 : -0.5;
    const auto x = static_cast<double>(r);
    stable += line("%g %g\n%g %g\n", x - 0.5, edge, x + 0.5, edge);
    chosen += line("%g %g\n", x, row_of(map.stiffnesses, map.chosen[r]));
  }
  return stable + "EOD\n" + chosen + "EOD\n";
}

std::string tics(const char* axis, const Vector<double>& values) {
  std::string text = std::string("set ") + axis + "tics (";
  for (std::size_t i = 0; i < values.size(); ++i) {
    text += (i > 0 ? ", '" : "'") + to_text(values[i]) + "' " + std::to_string(i);
  }
  return text + ")\n";
}

struct Page {
  std::size_t rows;
  double height() const { return kTop + static_cast<double>(rows) * (kPanelHeight + kGap) - kGap + kBottom; }
  // Of the page, from the lower left corner.
  double x(double pixels) const { return pixels / kWidth; }
  double y(double from_top) const { return 1 - from_top / height(); }
};

std::string place(const Page& page, std::size_t row, std::size_t column) {
  const double width = (kWidth - kLeft - kRight - kBetween) / kMapColumns;
  const double left = kLeft + static_cast<double>(column) * (width + kBetween);
  const double top = kTop + static_cast<double>(row) * (kPanelHeight + kGap);
  return line(
      "set lmargin at screen %g\nset rmargin at screen %g\nset tmargin at screen %g\nset bmargin at screen %g\n",
      page.x(left), page.x(left + width), page.y(top), page.y(top + kPanelHeight));
}

std::string panel(const StabilityMap& map, const MapText& text, bool lowest, bool leftmost) {
  const std::string fails = fails_block(map);
  std::string script = cells_block(map) + fails;
  if (!map.chosen.empty()) script += curves_block(map);
  script += "set title '" + map.title + "' offset 0,-0.6 textcolor '#222222'\n";
  script += tics("x", map.rates) + tics("y", map.stiffnesses);
  script += line("set xrange [-0.5:%g]\nset yrange [-0.5:%g]\n", static_cast<double>(map.rates.size()) - 0.5,
                 static_cast<double>(map.stiffnesses.size()) - 0.5);
  script += std::string("set xlabel '") + (lowest ? "rate of the servo (Hz)" : "") + "' offset 0,0.4\n";
  script += "set ylabel '" + (leftmost ? text.stiffness : "") + "' offset 0.5,0\n";
  script += "plot $cells using 1:2:3:4:5:6:7 with boxxyerror linecolor palette";
  if (!fails.empty())
    script += ", $fails using 1:2 with points pointtype 2 pointsize 0.6 linewidth 1.4 linecolor '#222222'";
  if (!map.chosen.empty()) {
    script +=
        ", $stable using 1:2 with lines linewidth 2.2 linecolor '#222222', "
        "$chosen using 1:2 with linespoints linewidth 1.8 linecolor '#2f855a' pointtype 7 pointsize 0.5";
  }
  return script + "\n";
}

// What colours, crosses and lines mean, under the last row.
std::string legend(const Page& page, bool curves) {
  const double top = page.height() - kBottom + 88;
  const auto label = [&](double x, double y, const std::string& text, const char* colour) {
    return "set label '" + text + "' at screen " + line("%g,%g", page.x(x), page.y(y)) + " textcolor '" + colour +
           "'\n";
  };
  std::string script = line("set colorbox horizontal user origin screen %g,%g size screen %g,%g\n", page.x(kLeft),
                            page.y(top + 12), page.x(250), 12 / page.height());
  script += label(kLeft, top - 14, "motion in the hold or energy given, times the limit", "#222222");
  script += label(kLeft + 300, top + 6, "×  fails: beyond the limit, cut while it held, or let go", "#222222");
  if (curves) {
    script += label(kLeft + 300, top + 26, "―  all below it are stable", "#222222");
    script += label(kLeft + 300, top + 46, "●  what the loop chooses by itself", "#2f855a");
  }
  return script;
}

}  // namespace

void write_maps(std::span<const StabilityMap> maps, const MapText& text, const std::filesystem::path& path) {
  const Page page{(maps.size() + kMapColumns - 1) / kMapColumns};
  std::string script = line(
      "set terminal svg size %g,%g dynamic font 'Helvetica,Arial,sans-serif,13' linewidth 1 "
      "background '#ffffff'\n",
      kWidth, page.height());
  script += kStyle;
  script += "set multiplot\n";
  script +=
      line("set label 1 '%s' at screen 0.5,%g center font ',16' textcolor '#222222'\n", text.title.c_str(), page.y(26));
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const std::size_t row = i / kMapColumns, column = i % kMapColumns;
    script += place(page, row, column);
    if (i + 1 == maps.size()) script += legend(page, !maps[i].chosen.empty());
    script += panel(maps[i], text, row + 1 == page.rows, column == 0);
    if (i == 0) script += "unset label 1\n";
  }
  write_text(path, render::run_gnuplot(script + "unset multiplot\n"));
}

}  // namespace crumble::app
