#include "sim/contact_plots.hpp"

#include <algorithm>
#include <array>

#include "crumble/base/file.hpp"
#include "crumble/base/text.hpp"
#include "render/gnuplot.hpp"

namespace crumble {
namespace {

constexpr int kWidth = 560, kHeight = 400;  // of a panel, pixels
constexpr std::array kColours{"#12355b", "#c2410c", "#2f855a", "#9a7b4f"};

constexpr const char* kStyle = R"(set encoding utf8
set termoption noenhanced
set border 3 linecolor '#444444'
set tics nomirror out scale 0.6 textcolor '#222222'
set grid ytics linetype 1 linecolor '#e6e6e6' linewidth 0.8
set key bmargin center horizontal Left reverse samplen 1.5 width -1 textcolor '#222222'
set bmargin 5
set rmargin 3
set xrange [*:*] noextend
)";

std::string data_block(const std::string& name, const Curve& curve) {
  constexpr std::size_t kRuns = 500;
  const std::size_t count = curve.x.size(), per_run = std::max<std::size_t>(1, count / kRuns);
  std::string block = "$" + name + " << EOD\n";
  for (std::size_t first = 0; first < count; first += per_run) {
    const auto begin = curve.y.begin() + static_cast<long>(first);
    const auto [least, greatest] =
        std::minmax_element(begin, begin + static_cast<long>(std::min(per_run, count - first)));
    for (const auto value : {std::min(least, greatest), std::max(least, greatest)}) {
      block += to_text(curve.x[static_cast<std::size_t>(value - curve.y.begin())]) + " " + to_text(*value) + "\n";
    }
  }
  return block + "EOD\n";
}

std::string panel_script(const Panel& panel, const std::string& name) {
  std::string script, plot = "plot ";
  for (std::size_t c = 0; c < panel.curves.size(); ++c) {
    const std::string block = name + "_" + std::to_string(c);
    script += data_block(block, panel.curves[c]);
    plot += (c > 0 ? ", $" : "$") + block + " with lines linewidth 1.6 linecolor '" + kColours.at(c) + "' title '" +
            panel.curves[c].title + "'";
  }
  script += panel.logarithmic ? "set logscale y\nset format y '%g'\n" : "unset logscale\n";
  script += "set title '" + panel.title + "'\nset xlabel '" + panel.x_label + "' offset 0,0.4\nset ylabel '" +
            panel.y_label + "'\n";
  return script + plot + "\n";
}

}  // namespace

void draw_panels(std::span<const Panel> panels, const std::filesystem::path& path) {
  std::string script = "set terminal pngcairo size " + std::to_string(kWidth * panels.size()) + "," +
                       std::to_string(kHeight) + " font 'Helvetica,12' background '#ffffff'\n" + kStyle +
                       "set multiplot layout 1," + std::to_string(panels.size()) + "\n";
  for (std::size_t p = 0; p < panels.size(); ++p) script += panel_script(panels[p], "panel" + std::to_string(p));
  write_text(path, render::run_gnuplot(script + "unset multiplot\n"));
}

}  // namespace crumble
