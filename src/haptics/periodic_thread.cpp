#include "haptics/periodic_thread.hpp"

#ifdef __linux__
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <time.h>

#include <cerrno>
#include <cstring>
#else
#include <chrono>
#endif

#include <cmath>
#include <latch>
#include <system_error>

#include "crumble/base/clock.hpp"
#include "crumble/base/error.hpp"

namespace crumble::haptics {
namespace {

#ifdef __linux__
// `when`: of wall_seconds(), which is CLOCK_MONOTONIC here.
void sleep_until(double when) noexcept {
  timespec t{};
  t.tv_sec = static_cast<time_t>(when);
  t.tv_nsec = static_cast<long>((when - std::floor(when)) * 1e9);
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
  }
}

std::string apply(const ThreadOptions& options) {
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (options.priority > 0) {
    sched_param p{};
    p.sched_priority = options.priority;
    const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &p);
    add(error == 0 ? "SCHED_FIFO " + std::to_string(options.priority)
                   : std::string("no real-time priority: ") + std::strerror(error));
  }
  if (options.processor >= 0) {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(static_cast<unsigned>(options.processor), &set);
    const int error = pthread_setaffinity_np(pthread_self(), sizeof set, &set);
    add("processor " + std::to_string(options.processor) +
        (error == 0 ? "" : std::string(" not given: ") + std::strerror(error)));
  }
  if (options.lock_memory) {
    add(mlockall(MCL_CURRENT | MCL_FUTURE) == 0 ? "memory locked"
                                                : std::string("memory not locked: ") + std::strerror(errno));
  }
  return text;
}
#else
void sleep_until(double when) noexcept {
  const double left = when - wall_seconds();
  if (left > 0) std::this_thread::sleep_for(std::chrono::duration<double>(left));
}

std::string apply(const ThreadOptions& options) {
  return options.priority > 0 || options.lock_memory || options.processor >= 0
             ? "thread options are not supported on this system"
             : "";
}
#endif

}  // namespace

void PeriodicThread::start(double period, const ThreadOptions& options, Work work, void* context) {
  stop();
  stopping_ = false;
  missed_ = 0;
  cpu_.clear(), lateness_.clear();
  std::latch ready(1);
  try {
    thread_ = std::thread([this, period, &options, work, context, &ready] {
      try {
        scheduling_ = apply(options);
      } catch (const std::bad_alloc&) {  // the text alone
      }
      ready.count_down();
      run(period, work, context);
    });
  } catch (const std::system_error& error) {
    throw Error(Code::internal, std::string("the system gives no thread: ") + error.what());
  }
  ready.wait();
}

void PeriodicThread::stop() noexcept {
  stopping_ = true;
  if (thread_.joinable()) thread_.join();
}

void PeriodicThread::run(double period, Work work, void* context) noexcept {
  double deadline = wall_seconds() + period;
  while (!stopping_.load(std::memory_order_relaxed)) {
    sleep_until(deadline);
    lateness_.add(wall_seconds() - deadline);
    const double before = thread_cpu_seconds();
    if (!work(context)) return;
    cpu_.add(thread_cpu_seconds() - before);
    deadline += period;
    const double behind = wall_seconds() - deadline;
    if (behind <= 0) continue;
    const double skipped = std::ceil(behind / period);
    deadline += skipped * period;
    missed_.store(missed_.load(std::memory_order_relaxed) + static_cast<std::uint64_t>(skipped),
                  std::memory_order_relaxed);
  }
}

}  // namespace crumble::haptics
