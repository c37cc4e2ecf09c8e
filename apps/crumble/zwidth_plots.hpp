// Maps of where a loop is stable, as drawings: SVG by gnuplot.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "zwidth_presses.hpp"

namespace crumble::app {

struct MapText {
  std::string title, stiffness;  // of the whole; of the upright axis
};

/// The maps in rows of kMapColumns, one cell for each press: blue within the limits, red beyond them, a cross where it
/// fails. A map with `chosen` also shows the largest stable stiffness and what the loop chooses.
/// Throws Error: unsupported (gnuplot cannot be run), internal (it failed), io.
void write_maps(std::span<const StabilityMap> maps, const MapText& text, const std::filesystem::path& path);

}  // namespace crumble::app
