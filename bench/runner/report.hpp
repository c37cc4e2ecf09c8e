// Results as JSON, which is what is kept, and as tables, which are made from the JSON.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "runner/measure.hpp"

namespace crumble::bench {

/// An object with the machine, the revision and one row per measurement; docs/performance.md lists the fields.
std::string to_json(std::span<const Row> rows);

/// Of a file that to_json wrote, or of its text (`name` stands in messages). Throws Error(format).
std::string to_table(const std::string& json, const std::string& name);
/// Rows of two results that are of the same body and settings side by side. Throws Error: io, format.
std::string compare(const std::filesystem::path& before, const std::filesystem::path& after);

}  // namespace crumble::bench
