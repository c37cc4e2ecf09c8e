// The force on the tool as a drawing: SVG by gnuplot.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "crumble/base/vec.hpp"

namespace crumble::render {

struct ForceSample {
  double time = 0;            // s
  double depth = 0;           // of the tool below the place where it met the body, m
  Vec3 force = Vec3::Zero();  // N
  std::uint64_t cuts = 0;     // springs cut so far
};

enum class PlotAxis { depth, time };

/// Force components and magnitude over depth (mm) or time (s), with the cuts so far on a second axis: the paper's
/// Figs 10 and 12. The file is written whole or not at all.
/// Throws Error: empty, invalid_value (a sample that is not finite), unsupported (gnuplot cannot be run), internal (it
/// failed; its message is in the text), io.
void write_force_plot(std::span<const ForceSample> samples, PlotAxis axis, const std::string& title,
                      const std::filesystem::path& path);

}  // namespace crumble::render
