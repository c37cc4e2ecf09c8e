// What a loop makes of its definition before it begins.
#pragma once

#include <deque>
#include <string>

#include "crumble/base/memory.hpp"
#include "crumble/device/polled.hpp"
#include "crumble/haptics/loop.hpp"

namespace crumble::haptics {

/// Throws Error, see HapticLoop.
void check(const Simulation& sim, const LoopDef& def);
/// Ticks over which the body's force is a mean or held.
double mean_of(const Simulation& sim, const LoopDef& def);
/// The device that calls the ticks; null: none does. Throws Error: unsupported, out_of_range (its rate).
Device* driving_device(const LoopDef& def);
/// With a PolledDevice round each device whose thread is not that of `driving`: its force is a tick late.
LoopDef with_polled(LoopDef def, const Device* driving, std::deque<PolledDevice>& polled);
/// What a spring that one knows beforehand will ask for and not get, in words.
Vector<std::string> find_warnings(const LoopDef& def);

}  // namespace crumble::haptics
