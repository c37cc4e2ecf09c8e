// What an experiment leaves behind: files, the JSON object, and the report for people.
#pragma once

#include <filesystem>
#include <string>

#include "capture.hpp"

namespace crumble::app {

/// Writes force.csv, force.svg, phases.png, surface_*.ply and experiment.crec into `folder`, each whole or not at all.
void write_outputs(const Experiment& experiment, const Rerun& again, const std::filesystem::path& folder);

/// The closed surface, metres, in the format of the path's extension.
void write_surface(const Capture& capture, const std::filesystem::path& path);

std::string to_json(const Experiment& experiment, const Rerun& again);
std::string to_report(const Experiment& experiment, const Rerun& again, const std::filesystem::path& folder);

/// 16 hexadecimal digits.
std::string hash_text(std::uint64_t hash);

}  // namespace crumble::app
