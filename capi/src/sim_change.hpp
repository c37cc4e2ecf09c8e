// Edits of a simulation's definition that the C API offers for a simulation and for the loop that has it.
#pragma once

#include <functional>

#include "objects.hpp"

namespace crumble::capi {

using EditDefinition = std::function<void(SimulationDef&)>;

/// Builds the simulation anew if nobody has stepped it or looks at it; else changes it where it is, and tells the
/// recording.
crumble_result alter(Sim& sim, const Call& call, const EditDefinition& edit);

Wall make_floor();
/// `has_floor`: whether the first wall is one.
void configure(const crumble_sim_def& given, bool& has_floor, SimulationDef& definition);
/// Both throw Error(out_of_range): no such tool; the latter also what check() throws.
void set_tool(std::uint32_t tool, Tool to, SimulationDef& definition);
void set_friction(std::uint32_t tool, const Friction& friction, SimulationDef& definition);
void require_index(const char* field, std::uint32_t index, std::size_t count);

}  // namespace crumble::capi
