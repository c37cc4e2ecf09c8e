// A thread that does something at fixed deadlines.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>

#include "crumble/haptics/histogram.hpp"
#include "crumble/haptics/loop.hpp"

namespace crumble::haptics {

/// Deadlines stand `period` apart, on the monotonic clock. One that has gone by before the work of an earlier one was
/// over is missed: there is no burst to catch up.
class PeriodicThread {
 public:
  using Work = bool (*)(void* context) noexcept;  // false: not again

  PeriodicThread() = default;
  ~PeriodicThread() { stop(); }
  PeriodicThread(const PeriodicThread&) = delete;
  PeriodicThread& operator=(const PeriodicThread&) = delete;

  /// Throws Error(internal) when the system gives no thread.
  void start(double period, const ThreadOptions& options, Work work, void* context);
  /// Returns when the last call has. Not from within a call.
  void stop() noexcept;

  std::uint64_t missed() const noexcept { return missed_.load(std::memory_order_relaxed); }
  /// CPU time of each call; how long after its deadline it began.
  const Histogram& cpu() const noexcept { return cpu_; }
  const Histogram& lateness() const noexcept { return lateness_; }
  /// What became of the options; complete when start() has returned.
  const std::string& scheduling() const noexcept { return scheduling_; }

 private:
  void run(double period, Work work, void* context) noexcept;

  std::thread thread_;
  std::atomic<bool> stopping_{false};
  std::atomic<std::uint64_t> missed_{0};
  Histogram cpu_, lateness_;
  std::string scheduling_;
};

}  // namespace crumble::haptics
