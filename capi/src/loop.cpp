// A loop takes its simulation and devices as any caller does, from start to stop or for a tick: so nobody else is in
// them meanwhile, and nobody waits.
#include "loop.hpp"

#include "sim_change.hpp"

namespace crumble::capi {

constinit HandleTable Loop::table{5};

Loop::Loop(crumble_sim handle, Sim& sim) : sim_handle_(handle), owner_(sim), sim_(sim.simulation), need_(sim.loops) {}

// Has been closed.
Loop::~Loop() {
  haptic_.reset();
  if (taken_) give_back();
}

void Loop::add_device(crumble_device handle, OpenDevice& device) {
  device.polled.reset();  // its thread is the loop's now
  devices_.push_back({handle, &device, Need(device.loops)});
}

crumble_result Loop::take(const Call& call) noexcept {
  void* object = nullptr;
  if (const crumble_result result = Sim::table.acquire(sim_handle_, object); result != CRUMBLE_OK) {
    return fail_handle(call, Sim::kName, sim_handle_, result);
  }
  for (std::size_t i = 0; i < devices_.size(); ++i) {
    const crumble_result result = OpenDevice::table.acquire(devices_[i].handle, object);
    if (result == CRUMBLE_OK) continue;
    release(i);
    return fail_handle(call, OpenDevice::kName, devices_[i].handle, result);
  }
  taken_ = true;
  return CRUMBLE_OK;
}

void Loop::release(std::size_t device_count) noexcept {
  taken_ = false;
  for (std::size_t i = 0; i < device_count; ++i) OpenDevice::table.release(devices_[i].handle);
  Sim::table.release(sim_handle_);
}

// The readers and the recording that there are now. Those of last time may be gone, but nobody has asked them since.
void Loop::connect() {
  haptic_->forget_publishers();
  for (const auto& link : owner_.readers) {
    if (link->is_open) haptic_->publish_to(link->publisher);
  }
  haptic_->record_to(owner_.recording ? &*owner_.recording : nullptr);
  recorded_ = owner_.recording ? owner_.recording->step_count() : 0;
  done_ = sim_.info().step;
}

// A loop that finds no memory for its recording goes on without, so that fewer steps are in it than were done.
crumble_result Loop::keep_recording(const Call& call) noexcept {
  if (!owner_.recording || owner_.recording->step_count() - recorded_ >= sim_.info().step - done_) return CRUMBLE_OK;
  owner_.recording.reset();
  return call.fail(CRUMBLE_E_NO_MEMORY, {"it is done, but the recording found no memory and was dropped"});
}

crumble_result Loop::start(const Call& call) {
  if (haptic_->running()) return call.fail(CRUMBLE_E_STATE, {"the loop runs already"});
  if (const crumble_result result = take(call); result != CRUMBLE_OK) return result;
  Taken taken{this};
  connect();
  haptic_->start();
  taken.loop = nullptr;  // until stop()
  return CRUMBLE_OK;
}

crumble_result Loop::close(const Call& call) noexcept {
  const bool ran = haptic_->running();
  if (!taken_) {
    if (const crumble_result result = take(call); result != CRUMBLE_OK) return result;
  }
  haptic_->stop();
  ticked_ = false;
  return ran ? keep_recording(call) : CRUMBLE_OK;
}

crumble_result Loop::stop(const Call& call) noexcept {
  if (!haptic_->running() && !ticked_) return CRUMBLE_OK;
  const crumble_result result = close(call);
  if (taken_) give_back();
  return result;
}

// While it runs the simulation is the loop's, and what of the Sim the edit looks at is guarded by the loop.
crumble_result Loop::change(const char* function, const Call& call,
                            const std::function<void(SimulationDef&, Sim&)>& edit) {
  const auto edit_definition = [&](SimulationDef& definition) { edit(definition, owner_); };
  if (!haptic_->running()) {
    return with<Sim>(function, sim_handle_, [&](Sim& sim, const Call&) { return alter(sim, call, edit_definition); });
  }
  haptic_->change(edit_definition);
  return CRUMBLE_OK;
}

crumble_result Loop::tick(const Call& call) {
  const LoopDef& def = haptic_->definition();
  if (def.driver != LoopDriver::host) return call.fail(CRUMBLE_E_STATE, {"driver is not CRUMBLE_DRIVER_HOST"});
  if (haptic_->running()) {
    haptic_->tick();
    return CRUMBLE_OK;
  }
  if (def.body_thread) return call.fail(CRUMBLE_E_STATE, {"with body_thread the loop must be started first"});
  if (const crumble_result result = take(call); result != CRUMBLE_OK) return result;
  const Taken taken{this};
  connect();
  ticked_ = true;
  haptic_->tick();
  return keep_recording(call);
}

}  // namespace crumble::capi
