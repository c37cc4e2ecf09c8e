#include "render/force_plot.hpp"

#include <algorithm>
#include <functional>

#include "crumble/base/error.hpp"
#include "crumble/base/file.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/text.hpp"
#include "render/gnuplot.hpp"

namespace crumble::render {
namespace {

using Value = std::function<double(const ForceSample&)>;

void check(std::span<const ForceSample> samples) {
  if (samples.empty()) throw Error(Code::empty, "samples must have at least one entry, have 0");
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::string name = "samples[" + std::to_string(i) + "]";
    require_finite(name + ".time", samples[i].time);
    require_finite(name + ".depth", samples[i].depth);
    for (int k = 0; k < 3; ++k) require_finite(name + ".force", samples[i].force[k]);
  }
}

// A gnuplot data block of "x y" rows. A long curve is thinned to the first, the least and the greatest value of each of
// some hundred runs of samples, so that no peak is lost and the drawing stays small.
std::string data_block(const std::string& name, std::span<const ForceSample> samples, const Value& x, const Value& y) {
  constexpr std::size_t kRuns = 500;
  const std::size_t per_run = std::max<std::size_t>(1, samples.size() / kRuns);
  std::string block = "$" + name + " << EOD\n";
  const auto add = [&](const ForceSample& s) { block += to_text(x(s)) + " " + to_text(y(s)) + "\n"; };
  for (std::size_t first = 0; first < samples.size(); first += per_run) {
    const auto run = samples.subspan(first, std::min(per_run, samples.size() - first));
    const auto [least, greatest] = std::minmax_element(
        run.begin(), run.end(), [&](const ForceSample& a, const ForceSample& b) { return y(a) < y(b); });
    Vector<std::size_t> kept = {0, static_cast<std::size_t>(least - run.begin()),
                                static_cast<std::size_t>(greatest - run.begin())};
    if (first + run.size() == samples.size()) kept.push_back(run.size() - 1);
    std::sort(kept.begin(), kept.end());
    kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
    for (const std::size_t i : kept) add(run[i]);
  }
  return block + "EOD\n";
}

// Where the number of cuts changes, and both ends.
std::string cuts_block(std::span<const ForceSample> samples, const Value& x) {
  std::string block = "$cuts << EOD\n";
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i > 0 && i + 1 < samples.size() && samples[i].cuts == samples[i - 1].cuts) continue;
    block += to_text(x(samples[i])) + " " + std::to_string(samples[i].cuts) + "\n";
  }
  return block + "EOD\n";
}

// In single quotes gnuplot knows no escapes but the doubled quote.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'') out += '\'';
    out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out + "'";
}

constexpr const char* kStyle = R"(set encoding utf8
set terminal svg size 760,440 dynamic font 'Helvetica,Arial,sans-serif,13' linewidth 1 background '#ffffff'
set termoption noenhanced
set border 3 linecolor '#444444'
set tics nomirror out scale 0.6 textcolor '#222222'
set grid ytics linetype 1 linecolor '#e6e6e6' linewidth 0.8
set xzeroaxis linetype 1 linecolor '#888888' linewidth 0.8
set style fill solid noborder
set key bmargin center horizontal samplen 3 spacing 1.1 textcolor '#222222'
set ylabel 'force on the tool (N)'
)";

constexpr const char* kCutsAxis = R"(set border 11
set y2tics textcolor '#9a7b4f'
set y2range [0:*]
set y2label 'springs cut so far' textcolor '#9a7b4f'
)";

}  // namespace

void write_force_plot(std::span<const ForceSample> samples, PlotAxis axis, const std::string& title,
                      const std::filesystem::path& path) {
  check(samples);
  const bool over_depth = axis == PlotAxis::depth;
  const Value x = [&](const ForceSample& s) { return over_depth ? 1000 * s.depth : s.time; };
  const bool has_cuts = samples.back().cuts > 0;
  std::string script = kStyle;
  if (has_cuts) script += kCutsAxis;
  script += "set title " + quoted(title) + "\n";
  script += std::string("set xlabel ") + (over_depth ? "'depth of the tool (mm)'" : "'time (s)'") + " offset 0,0.4\n";
  script += cuts_block(samples, x);
  script += data_block("size", samples, x, [](const ForceSample& s) { return norm(s.force); });
  for (const int k : {0, 1, 2}) {
    script += data_block(std::string(1, "xyz"[k]), samples, x, [k](const ForceSample& s) { return s.force[k]; });
  }
  script += "plot ";
  if (has_cuts) script += "$cuts axes x1y2 with fillsteps fillcolor '#f4ead8' title 'cuts', ";
  script +=
      "$size with lines linewidth 4 linecolor '#c9ced6' title '|F|', "
      "$x with lines linewidth 1.4 linecolor '#c2410c' dashtype (6,4) title 'Fx', "
      "$y with lines linewidth 1.8 linecolor '#12355b' title 'Fy', "
      "$z with lines linewidth 1.6 linecolor '#2f855a' dashtype (1.5,2.5) title 'Fz'\n";
  write_text(path, run_gnuplot(script));
}

}  // namespace crumble::render
