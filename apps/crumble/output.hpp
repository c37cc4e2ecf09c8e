// What an experiment leaves behind: files, the JSON object, and the report for people.
#pragma once

#include <filesystem>
#include <string>

#include "capture.hpp"
#include "output_folder.hpp"

namespace crumble::app {

/// Writes force.csv, force.svg, phases.png, surface_*.ply and experiment.crec: all of them or none.
void write_outputs(const Experiment& experiment, const Rerun& again, OutputFolder& folder);

/// The closed surface, metres, in the format of the path's extension.
void write_surface(const Capture& capture, const std::filesystem::path& path);
/// Throws Error(unsupported) when write_surface would refuse the extension: known before the long work. `others` stands
/// before the list of those that there are.
void require_surface_extension(const std::filesystem::path& path, const std::string& others = "");

std::string to_json(const Experiment& experiment, const Rerun& again);
std::string to_report(const Experiment& experiment, const Rerun& again, const std::filesystem::path& folder);

/// "float64" or "float32".
std::string precision_text(const Simulation& sim);
/// "float64, avx2 kernel, 1 thread"
std::string solver_text(const Simulation& sim);

/// 16 hexadecimal digits.
std::string hash_text(std::uint64_t hash);

}  // namespace crumble::app
