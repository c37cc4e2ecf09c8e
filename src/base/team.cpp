// A fork-join team that nobody has to wait for.
//
// The caller opens a gate, works like the others, shuts the gate when no task is left and waits for those who came
// through it. Who is late, because the system gave its processor to somebody else, finds the gate shut and has not
// been waited for: on a busy machine the caller does all tasks at the speed of one thread. All that a job consists of
// (task, data, claims) is written while the gate is shut and nobody is behind it.
//
// The gate is one number: job << 8 | open << 7 | threads behind it.
#include "crumble/base/team.hpp"

#ifdef __linux__
#include <sched.h>
#endif

#include <algorithm>
#include <array>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>

#include "crumble/base/clock.hpp"
#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

constexpr std::uint32_t kMaxThreads = 64;
constexpr std::uint64_t kBehind = 0x7f, kOpen = 0x80, kJob = 0x100;
static_assert(kMaxThreads <= kBehind);

void pause() noexcept {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

// True as soon as `done()`, false when it was not for kSpinSeconds.
template <class Done>
bool spin_until(Done&& done) noexcept {
  const double start = wall_seconds();
  do {
    for (int i = 0; i < 32; ++i) {
      if (done()) return true;
      pause();
    }
  } while (wall_seconds() - start < Team::kSpinSeconds);
  return false;
}

// Linux may wake a worker on the very processor that its caller is running on and leave both there for milliseconds:
// one then only takes time from the other. A worker that finds itself there moves to any other that it was given.
#ifdef __linux__
int this_processor() noexcept {
  return sched_getcpu();
}

class Processors {
 public:
  Processors() noexcept { known_ = sched_getaffinity(0, sizeof given_, &given_) == 0; }
  void avoid(int processor) const noexcept {
    if (!known_ || processor < 0 || this_processor() != processor) return;
    cpu_set_t others = given_;
    CPU_CLR(static_cast<std::size_t>(processor), &others);
    if (CPU_COUNT(&others) > 0) sched_setaffinity(0, sizeof others, &others);
  }

 private:
  cpu_set_t given_{};  // to this thread by whoever started the program
  bool known_ = false;
};
#else
int this_processor() noexcept {
  return -1;
}

struct Processors {
  void avoid(int) const noexcept {}
};
#endif

// A place to sleep until `done()`. Whoever makes it true calls wake() afterwards, which costs one load when nobody
// sleeps: the sleeper counts itself and then looks, the waker changes and then reads the count, all in one order.
class Bed {
 public:
  template <class Done>
  void sleep_until(Done&& done) noexcept {
    std::unique_lock lock(mutex_);
    sleepers_.fetch_add(1);
    changed_.wait(lock, done);
    sleepers_.fetch_sub(1);
  }
  void wake() noexcept {
    if (sleepers_.load() == 0) return;
    { const std::lock_guard lock(mutex_); }
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::atomic<std::uint32_t> sleepers_{0};
};

}  // namespace

struct Team::State : Allocated {
  // The tasks that one thread takes first. Its data are then in its own cache from the last job; the others help when
  // they have done theirs.
  struct alignas(64) Block {
    std::atomic<std::uint32_t> next{0};
    std::uint32_t end = 0;
  };

  ParallelFor host;
  Vector<std::thread> workers;
  std::array<Block, kMaxThreads> blocks;
  void (*task)(void*, std::uint32_t) = nullptr;
  void* data = nullptr;
  std::atomic<int> callers_processor{-1};
  alignas(64) std::atomic<std::uint64_t> gate{0};
  std::atomic<bool> stopped{false};
  std::atomic<bool> in_use{false};
  Bed workers_bed, caller_bed;

  ~State() {
    stopped.store(true);
    workers_bed.wake();
    for (std::thread& worker : workers) worker.join();
  }

  std::uint32_t threads() const noexcept { return static_cast<std::uint32_t>(workers.size()) + 1; }

  void run(std::uint32_t count, void (*new_task)(void*, std::uint32_t), void* new_data) noexcept {
    task = new_task, data = new_data;
    callers_processor.store(this_processor(), std::memory_order_relaxed);
    for (std::uint64_t t = 0, begin = 0; t < threads(); ++t) {
      blocks[t].next.store(static_cast<std::uint32_t>(begin), std::memory_order_relaxed);
      begin = count * (t + 1) / threads();
      blocks[t].end = static_cast<std::uint32_t>(begin);
    }
    gate.fetch_add(kJob | kOpen);  // was shut with nobody behind it
    workers_bed.wake();
    take_tasks(0);
    gate.fetch_and(~kOpen);
    const auto all_out = [&] { return (gate.load() & kBehind) == 0; };
    if (!spin_until(all_out)) caller_bed.sleep_until(all_out);
  }

  void take_tasks(std::uint32_t me) noexcept {
    for (std::uint32_t k = 0; k < threads(); ++k) {
      Block& block = blocks[(me + k) % threads()];
      while (block.next.load(std::memory_order_relaxed) < block.end) {
        const std::uint32_t i = block.next.fetch_add(1, std::memory_order_relaxed);
        if (i < block.end) task(data, i);
      }
    }
  }

  void work(std::uint32_t me) noexcept {
    const Processors processors;
    std::uint64_t last_job = 0;
    while (true) {
      std::uint64_t seen = 0;
      const auto called = [&] {
        seen = gate.load();
        return stopped.load() || ((seen & kOpen) && seen / kJob != last_job);
      };
      if (!spin_until(called)) workers_bed.sleep_until(called);
      if (stopped.load()) return;
      processors.avoid(callers_processor.load(std::memory_order_relaxed));
      if (!gate.compare_exchange_strong(seen, seen + 1)) continue;
      last_job = seen / kJob;
      take_tasks(me);
      const std::uint64_t left = gate.fetch_sub(1) - 1;
      if ((left & (kOpen | kBehind)) == 0) caller_bed.wake();
    }
  }
};

Team::Team(std::uint32_t threads) : state_(std::make_unique<State>()) {
  require_in_range("threads", threads, 1, kMaxThreads);
  state_->workers.reserve(threads - 1);
  try {
    for (std::uint32_t t = 1; t < threads; ++t) {
      state_->workers.emplace_back([state = state_.get(), t] { state->work(t); });
    }
  } catch (const std::system_error&) {
    throw Error(Code::internal, "threads " + std::to_string(threads) + ": the system does not give them");
  }
}

Team::Team(const ParallelFor& host) : state_(std::make_unique<State>()) {
  if (!host.run) throw Error(Code::null, "parallel_for.run is null");
  state_->host = host;
}

Team::~Team() = default;

std::uint32_t Team::threads() const noexcept {
  return state_->host.run ? std::max(std::thread::hardware_concurrency(), 1u) : state_->threads();
}

void Team::run(std::uint32_t count, void (*task)(void* data, std::uint32_t index), void* data) noexcept {
  State& s = *state_;
  if (s.host.run && count > 1) {
    s.host.run(s.host.context, count, task, data);
  } else if (count > 1 && !s.workers.empty() && !s.in_use.exchange(true, std::memory_order_acquire)) {
    s.run(count, task, data);
    s.in_use.store(false, std::memory_order_release);
  } else {
    for (std::uint32_t i = 0; i < count; ++i) task(data, i);
  }
}

}  // namespace crumble
