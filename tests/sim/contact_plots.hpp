// Curves side by side, as PNG files.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "crumble/base/memory.hpp"

namespace crumble {

struct Curve {
  std::string title;
  Vector<double> x, y;
};

struct Panel {
  std::string title, x_label, y_label;
  Vector<Curve> curves;      // up to four
  bool logarithmic = false;  // in y
};

/// Panels from left to right; a curve of one title has one colour everywhere if it stands at the same place. Long
/// curves are drawn by the least and the greatest value of each stretch. Throws Error what run_gnuplot() throws; io.
void draw_panels(std::span<const Panel> panels, const std::filesystem::path& path);

}  // namespace crumble
