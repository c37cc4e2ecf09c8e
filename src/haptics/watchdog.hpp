// Who may talk to the devices just now.
//
// The loop takes the gate while it reads and writes devices, and leaves it while the body is stepped and between ticks.
// The watchdog, a thread of its own that sleeps nearly always, looks when the loop last wrote. If that is too long ago
// it takes the gate, writes zero to every device and lets go. So a body that takes a second for one step, or a host
// that has stopped calling, does not leave a force in a hand. The loop never waits for the gate: a tick that finds it
// taken does nothing, and its force is zero already.
#pragma once

#include <atomic>
#include <cstdint>

namespace crumble::haptics {

class DeviceGate {
 public:
  /// False when the other has it.
  bool take() noexcept { return !taken_.exchange(true, std::memory_order_acquire); }
  void leave() noexcept { taken_.store(false, std::memory_order_release); }

  /// The loop has written at `when` (wall_seconds()); 0: it does not run.
  void wrote(double when) noexcept { last_write_.store(when, std::memory_order_relaxed); }
  double last_write() const noexcept { return last_write_.load(std::memory_order_relaxed); }

 private:
  std::atomic<bool> taken_{false};
  std::atomic<double> last_write_{0};
};

}  // namespace crumble::haptics
