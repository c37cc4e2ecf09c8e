// crumble_sim_def and SimulationDef: the same numbers, once as C and once as C++ keeps them.
#pragma once

#include "crumble/crumble.h"
#include "crumble/sim/definition.hpp"

namespace crumble::capi {

crumble_sim_def default_sim_def();
/// Throws Error: what crumble_sim_create answers for the struct and for values that only C can get wrong.
crumble_sim_def read_sim_def(const crumble_sim_def* def);

/// Everything but mesh, tools, attachments, walls and fixed nodes; the floor is the caller's.
void apply(const crumble_sim_def& from, SimulationDef& to);
crumble_sim_def describe(const SimulationDef& def, bool has_floor);

}  // namespace crumble::capi
