// What `crumble zwidth` found, for people and for programs.
#pragma once

#include <string>

#include "zwidth_presses.hpp"

namespace crumble::app {

std::string to_json(const ZWidth& zwidth);
/// Counts by setup, and every combination that fails with the reason.
std::string to_report(const ZWidth& zwidth);
/// One row for each combination under each setup.
std::string combination_table(const ZWidth& zwidth);

}  // namespace crumble::app
