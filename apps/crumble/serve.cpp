#include "serve.hpp"

#include <atomic>
#include <chrono>
#include <csignal>
#include <thread>

#include "crumble/base/clock.hpp"

namespace crumble::app {
namespace {

volatile std::sig_atomic_t interrupted = 0;

// From its construction on SIGINT only asks to end.
class Interruption {
 public:
  Interruption() : before_(std::signal(SIGINT, [](int) { interrupted = 1; })) { interrupted = 0; }
  ~Interruption() { std::signal(SIGINT, before_); }
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

 private:
  void (*before_)(int);
};

class Served {
 public:
  Served(Device& device, const Server& server) : device_(device), server_(server) {}

  /// False: enough.
  bool tick() noexcept {
    DeviceSample sample;
    status_ = device_.read(sample);
    const auto force = server_(status_, sample);
    device_.write(force.value_or(Vec3::Zero()), Vec3::Zero());
    if (!force || status_ == ReadStatus::lost) over_ = true;
    return !over_;
  }
  bool over() const noexcept { return over_; }
  ReadStatus status() const noexcept { return status_; }

 private:
  Device& device_;
  const Server& server_;
  std::atomic<bool> over_{false};
  std::atomic<ReadStatus> status_{ReadStatus::no_new_sample};
};

}  // namespace

ReadStatus serve(Device& device, double rate, double seconds, const Server& server) {
  const Interruption interruption;
  Served served(device, server);
  const double end = wall_seconds() + seconds;
  const auto go_on = [&] { return !served.over() && !interrupted && wall_seconds() < end; };
  if (device.info().servo_driven) {
    device.start_servo({[](void* self) noexcept { return static_cast<Served*>(self)->tick(); }, &served});
    while (go_on()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    device.stop_servo();
  } else if (device.info().step_locked) {
    while (go_on()) served.tick();
  } else {
    const auto period =
        std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(1 / rate));
    for (auto next = std::chrono::steady_clock::now(); go_on(); std::this_thread::sleep_until(next += period)) {
      served.tick();
    }
  }
  device.write(Vec3::Zero(), Vec3::Zero());
  return served.status();
}

}  // namespace crumble::app
