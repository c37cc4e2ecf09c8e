// crumble_loop_def, crumble_hand_def and LoopDef.
#pragma once

#include "crumble/base/memory.hpp"
#include "crumble/crumble.h"
#include "crumble/haptics/loop.hpp"

namespace crumble::capi {

/// Throws Error: what crumble_loop_create answers for the structs and for what only C can get wrong. `def` may be NULL.
LoopDef read_loop_def(const crumble_loop_def* def);
Vector<crumble_hand_def> read_hands(const crumble_hand_def* hands, std::uint32_t count);
/// All but the device.
HandDef to_hand_def(const crumble_hand_def& def);

}  // namespace crumble::capi
