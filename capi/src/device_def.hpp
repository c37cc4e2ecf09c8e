// crumble_device_def and DeviceDef.
#pragma once

#include "crumble/crumble.h"
#include "crumble/device/open.hpp"

namespace crumble::capi {

/// Throws Error: what crumble_device_open answers for the struct and for what only C can get wrong.
crumble_device_def read_device_def(const crumble_device_def* def);
/// As far as the kind, not custom, needs it. Throws Error(null).
DeviceDef to_device_def(const crumble_device_def& def);

}  // namespace crumble::capi
