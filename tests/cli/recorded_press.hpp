// Recordings to work with: half a second of a fast press, in which springs are cut.
#pragma once

#include <string>

#include "crumble/sim/recording.hpp"

namespace crumble::cli {

inline constexpr std::size_t kSteps = 501;

/// A built-in scene's own press at another speed (m/s). Writes the recording; returns the simulation at its end.
Simulation record_press(const std::string& scene, double speed, const std::string& recording);

}  // namespace crumble::cli
