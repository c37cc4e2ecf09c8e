// A few threads that share the tasks of one step.
#pragma once

#include <cstdint>
#include <memory>

namespace crumble {

/// Runs task(data, i) for every i in [0, count), in any order and on any threads, and returns when all are done; may be
/// called from several threads at once. `context` is the host's own. A host that has worker threads gives one of these
/// instead of letting us start ours.
struct ParallelFor {
  void (*run)(void* context, std::uint32_t count, void (*task)(void* data, std::uint32_t index), void* data) = nullptr;
  void* context = nullptr;
};

/// The calling thread and `threads - 1` of our own. Workers spin for at most kSpinSeconds after a job and then sleep,
/// so an idle team uses no processor. Which thread does which task changes nothing: tasks write to places of their own.
class Team {
 public:
  /// threads in [1, 64]; 1 starts none. Throws Error: out_of_range, internal (the system gives no thread).
  explicit Team(std::uint32_t threads);
  /// The host's threads do the work. Throws Error: null (host.run).
  explicit Team(const ParallelFor& host);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  /// How many may work at once; of a host, which does not tell, the number of processors.
  std::uint32_t threads() const noexcept;
  /// Runs task(data, i) for every i in [0, count) and returns when all are done. What the caller wrote before is seen
  /// by the tasks, what they wrote is seen by the caller. Waits only for workers that took a task: one that has no
  /// processor just now is left out. Does not allocate. Thread-safe: when the team is in use by another caller, or by
  /// the caller's own task, the tasks run one after the other on this thread, as does a single task.
  void run(std::uint32_t count, void (*task)(void* data, std::uint32_t index), void* data) noexcept;

  static constexpr double kSpinSeconds = 50e-6;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace crumble
