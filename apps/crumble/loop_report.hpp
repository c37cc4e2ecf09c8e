// What `crumble loop` saw, for people and for programs.
#pragma once

#include <filesystem>
#include <string>

#include "output_folder.hpp"
#include "servo_run.hpp"

namespace crumble::app {

/// "direct" and so on, as --coupling takes them.
const char* to_string(BodyCoupling coupling);

std::string to_json(const LoopRun& run);
std::string to_report(const LoopRun& run);
/// loop.csv and loop.svg into the folder, without commit(). Throws Error.
void write_loop(const LoopRun& run, const OutputFolder& folder);

}  // namespace crumble::app
