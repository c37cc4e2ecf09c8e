// A recorded loop run again, as fast as it goes, and held against what was recorded: forces, events, state.
#pragma once

#include "servo_run.hpp"

namespace crumble::app {

/// Plays row k of `trajectory` in tick k. The same settings as in the run that was recorded. Throws Error: state where
/// a run with a thread for the body is asked for, which is another one each time.
LoopReplay replay_loop(Scene scene, const LoopSettings& settings, const Trajectory& trajectory);

/// What a loop was run with, and what came of it, as header lines of its trajectory.
void add_loop_lines(const std::string& scene, const LoopSettings& settings, const LoopReplay& replay,
                    Trajectory& trajectory);
/// Runs it again and throws Error(diverged) naming what differs, or (state) when the run was not made with these
/// settings or carries no such lines.
LoopReplay verify_loop(Scene scene, LoopSettings settings, const Trajectory& trajectory);

}  // namespace crumble::app
