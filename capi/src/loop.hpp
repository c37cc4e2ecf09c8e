// What a loop's handle stands for.
#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "crumble/base/memory.hpp"
#include "crumble/haptics/loop.hpp"
#include "device.hpp"
#include "objects.hpp"

namespace crumble::capi {

/// One loop that needs an object: as long as it lives, nobody destroys that.
class Need {
 public:
  explicit Need(std::atomic<std::uint32_t>& loops) noexcept : loops_(&loops) { ++loops; }
  Need(Need&& from) noexcept : loops_(std::exchange(from.loops_, nullptr)) {}
  Need& operator=(Need&&) = delete;
  ~Need() {
    if (loops_) --*loops_;
  }

 private:
  std::atomic<std::uint32_t>* loops_;
};

class Loop : public Allocated {
 public:
  using Handle = crumble_loop;
  static constexpr const char* kName = "loop";
  static HandleTable table;

  Loop(crumble_sim handle, Sim& sim);
  ~Loop();

  /// For the next hand; the device has been taken.
  void add_device(crumble_device handle, OpenDevice& device);
  /// The devices stand in `def`. Throws Error: what HapticLoop throws.
  void make(LoopDef def) { haptic_ = std::make_unique<HapticLoop>(sim_, std::move(def)); }
  HapticLoop& haptic() noexcept { return *haptic_; }
  const HapticLoop& haptic() const noexcept { return *haptic_; }
  const OpenDevice& device(std::size_t hand) const noexcept { return *devices_[hand].device; }
  std::size_t hand_count() const noexcept { return devices_.size(); }

  crumble_result start(const Call& call);
  crumble_result stop(const Call& call) noexcept;
  /// The same, before it is destroyed: simulation and devices stay the loop's, which sends them zero once more then.
  crumble_result close(const Call& call) noexcept;
  crumble_result tick(const Call& call);
  /// Any thread. `edit(definition, sim)`.
  crumble_result change(const char* function, const Call& call, const std::function<void(SimulationDef&, Sim&)>& edit);

 private:
  struct HandDevice {
    crumble_device handle;
    OpenDevice* device;
    Need need;
  };

  /// Gives back what take() took.
  struct Taken {
    Loop* loop;
    ~Taken() {
      if (loop) loop->give_back();
    }
  };

  crumble_result take(const Call& call) noexcept;
  void give_back() noexcept { release(devices_.size()); }
  void release(std::size_t device_count) noexcept;
  void connect();
  crumble_result keep_recording(const Call& call) noexcept;

  crumble_sim sim_handle_;
  Sim& owner_;
  Simulation& sim_;
  Need need_;
  Vector<HandDevice> devices_;             // by hand
  std::unique_ptr<HapticLoop> haptic_;     // borrows all the above
  bool taken_ = false;                     // simulation and devices
  bool ticked_ = false;                    // by the host, without start, since the last stop
  std::uint64_t recorded_ = 0, done_ = 0;  // steps in the recording and of the simulation when they were connected
};

}  // namespace crumble::capi
