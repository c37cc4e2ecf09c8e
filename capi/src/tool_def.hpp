// Tools and walls as C describes them.
#pragma once

#include "crumble/contact/tool.hpp"
#include "crumble/crumble.h"

namespace crumble::capi {

/// Throws Error: what crumble_sim_add_tool and crumble_sim_add_wall answer.
Tool read_tool(const crumble_tool_def* def);
Wall read_wall(const crumble_wall_def* def);

}  // namespace crumble::capi
