// State as bytes: snapshots and recordings.
#include <string>

#include "arrays.hpp"
#include "crumble/base/memory.hpp"
#include "defs.hpp"
#include "objects.hpp"

namespace crumble::capi {
namespace {

Recording& running(Sim& sim) {
  if (!sim.recording) throw Error(Code::state, "no recording is running");
  return *sim.recording;
}

}  // namespace
}  // namespace crumble::capi

using namespace crumble;
using namespace crumble::capi;

crumble_result crumble_sim_snapshot(crumble_sim sim, void* dst, uint64_t dst_bytes, uint64_t* needed) {
  return with<Sim>(__func__, sim, [&](const Sim& s, const Call& call) {
    const Vector<std::uint8_t> bytes = s.simulation.snapshot();
    return deliver(call, bytes.size(), dst, dst_bytes, needed,
                   [&](void* to) { std::copy(bytes.begin(), bytes.end(), static_cast<std::uint8_t*>(to)); });
  });
}

crumble_result crumble_sim_restore(crumble_sim sim, const void* snapshot, uint64_t bytes) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call& call) {
    require_pointer("snapshot", snapshot);
    if (s.recording) return call.fail(CRUMBLE_E_STATE, {"a recording is running: end it first"});
    s.simulation.restore({static_cast<const std::uint8_t*>(snapshot), bytes});
    s.publish_now();
    return crumble_result{CRUMBLE_OK};
  });
}

crumble_result crumble_sim_state_hash(crumble_sim sim, uint64_t* hash) {
  return with<Sim>(__func__, sim, [&](const Sim& s, const Call&) {
    require_pointer("hash", hash);
    *hash = s.simulation.state_hash();
    return CRUMBLE_OK;
  });
}

crumble_result crumble_sim_begin_recording(crumble_sim sim) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call&) {
    if (s.recording) throw Error(Code::state, "a recording is already running");
    s.recording.emplace(s.simulation);
    return CRUMBLE_OK;
  });
}

crumble_result crumble_sim_save_recording(crumble_sim sim, const char* path) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call&) {
    running(s).save(path_of(path));
    return CRUMBLE_OK;
  });
}

crumble_result crumble_sim_end_recording(crumble_sim sim) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call&) {
    running(s);
    s.recording.reset();
    return CRUMBLE_OK;
  });
}

crumble_result crumble_verify_recording(const char* path, uint64_t* step_count, uint64_t* equal_steps) {
  return guard(__func__, [&](const Call&) {
    require_pointer("step_count", step_count);
    require_pointer("equal_steps", equal_steps);
    const Recording recording = Recording::load(path_of(path));
    Simulation simulation = recording.start();
    const auto first_difference = replay(recording, simulation);
    *step_count = recording.step_count();
    *equal_steps = first_difference.value_or(recording.step_count());
    return CRUMBLE_OK;
  });
}
