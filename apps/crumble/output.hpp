// What an experiment leaves behind: files, the JSON object, and the report for people.
#pragma once

#include <filesystem>
#include <string>

#include "capture.hpp"
#include "output_folder.hpp"

namespace crumble::app {

/// Writes force.csv, events.csv, force.svg (force_2.svg, ... of more tools), phases.png, phases_bare.png, surface_*.ply
/// and experiment.crec: all of them or none.
void write_outputs(const Experiment& experiment, const Rerun& again, OutputFolder& folder);

/// Throws Error(unsupported) unless `path` ends in one of `extensions` (".a .b"): known before the long work.
void require_extension(const std::filesystem::path& path, const std::string& extensions);

std::string to_json(const Experiment& experiment, const Rerun& again);
std::string to_report(const Experiment& experiment, const Rerun& again, const std::filesystem::path& folder);

/// "float64" or "float32".
std::string precision_text(const Simulation& sim);
/// "float64, avx2 kernel, 1 thread"
std::string solver_text(const Simulation& sim);

/// 16 hexadecimal digits.
std::string hash_text(std::uint64_t hash);

}  // namespace crumble::app
