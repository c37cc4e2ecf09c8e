// A loop's life: the crumble_loop_ functions that are for one thread at a time.
#include <string>

#include "arrays.hpp"
#include "field_names.hpp"
#include "log.hpp"
#include "loop.hpp"
#include "loop_def.hpp"
#include "rigid.hpp"

namespace crumble::capi {
namespace {

// Finds the hand's device and keeps it from being destroyed.
crumble_result add_device(const Call& call, Loop& loop, const std::string& name, crumble_device handle) {
  void* found = nullptr;
  const crumble_result result = handle ? OpenDevice::table.acquire(handle, found) : CRUMBLE_E_NULL;
  if (result != CRUMBLE_OK) return fail_handle(call, name.c_str(), handle, result);
  struct Taken {
    const void* handle;
    ~Taken() { OpenDevice::table.release(handle); }
  };
  const Taken taken{handle};
  loop.add_device(handle, *static_cast<OpenDevice*>(found));
  return CRUMBLE_OK;
}

/// `stop(loop, call)`, which waits for the devices' callbacks.
template <class Stop>
crumble_result outside_callbacks(const char* function, crumble_loop loop, Stop&& stop) noexcept {
  return with<Loop>(function, loop, [&](Loop& l, const Call& call) {
    if (!in_callback()) return stop(l, call);
    return call.fail(CRUMBLE_E_STATE, {"a device's callback must not stop a loop, which waits for the callback"});
  });
}

}  // namespace
}  // namespace crumble::capi

using namespace crumble;
using namespace crumble::capi;

crumble_result crumble_loop_create(crumble_sim sim, const crumble_loop_def* def, const crumble_hand_def* hands,
                                   uint32_t hand_count, crumble_loop* loop) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call& call) -> crumble_result {
    require_pointer("loop", loop);
    LoopDef definition = read_loop_def(def);
    auto object = std::make_unique<Loop>(sim, s);
    for (const crumble_hand_def& given : read_hands(hands, hand_count)) {
      const std::size_t hand = definition.hands.size();
      const std::string name = "hands[" + std::to_string(hand) + "].device";
      if (const crumble_result result = add_device(call, *object, name, given.device); result != CRUMBLE_OK) {
        return result;
      }
      definition.hands.push_back(to_hand_def(given));
      definition.hands.back().device = object->device(hand).device.get();
    }
    object->make(std::move(definition));
    for (const std::string& warning : object->haptic().warnings()) log(CRUMBLE_LOG_WARNING, in_names_of_c(warning));
    publish(std::move(object), loop);
    return CRUMBLE_OK;
  });
}

crumble_result crumble_loop_destroy(crumble_loop loop) {
  if (!loop) return CRUMBLE_OK;
  const crumble_result result =
      outside_callbacks(__func__, loop, [](Loop& l, const Call& call) { return l.close(call); });
  if (result != CRUMBLE_OK && result != CRUMBLE_E_NO_MEMORY) return result;  // the latter of a recording
  return destroy<Loop>(__func__, loop);
}

crumble_result crumble_loop_start(crumble_loop loop) {
  return with<Loop>(__func__, loop, [](Loop& l, const Call& call) {
    const crumble_result result = l.start(call);
    if (const std::string how = l.haptic().realtime(); result == CRUMBLE_OK && !how.empty()) {
      log(CRUMBLE_LOG_NOTE, "the loop's thread: " + how);
    }
    return result;
  });
}

crumble_result crumble_loop_stop(crumble_loop loop) {
  return outside_callbacks(__func__, loop, [](Loop& l, const Call& call) { return l.stop(call); });
}

crumble_result crumble_loop_tick(crumble_loop loop) {
  return with<Loop>(__func__, loop, [](Loop& l, const Call& call) { return l.tick(call); });
}

crumble_result crumble_loop_place(crumble_loop loop, uint32_t tool, const crumble_pose* pose) {
  return with<Loop>(__func__, loop, [&](Loop& l, const Call&) {
    require_pointer("pose", pose);
    l.haptic().place(tool, to_pose(*pose));
    return CRUMBLE_OK;
  });
}

crumble_result crumble_loop_get_scheduling(crumble_loop loop, char* dst, uint64_t dst_bytes, uint64_t* needed) {
  return with<Loop>(__func__, loop, [&](const Loop& l, const Call& call) {
    return deliver(call, l.haptic().realtime(), dst, dst_bytes, needed);
  });
}
