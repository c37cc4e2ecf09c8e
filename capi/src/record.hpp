// What a host changes between steps, told to the recording that is going on.
#pragma once

#include "call.hpp"
#include "objects.hpp"

namespace crumble::capi {

/// keep(recording), if there is one. What has been done has been done, so only the recording can be given up.
template <class Keep>
crumble_result record(Sim& sim, const Call& call, Keep&& keep) noexcept {
  if (!sim.recording) return CRUMBLE_OK;
  try {
    keep(*sim.recording);
    return CRUMBLE_OK;
  } catch (...) {
    sim.recording.reset();
    return call.fail(CRUMBLE_E_NO_MEMORY, {"it is done, but the recording found no memory and was dropped"});
  }
}

}  // namespace crumble::capi
