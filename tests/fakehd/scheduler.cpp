// The one servo thread, or the test's own in manual mode, and the ticks they run.
#include <algorithm>
#include <cmath>

#include "fakehd_state.hpp"

namespace fakehd {
namespace {

using Clock = std::chrono::steady_clock;

double seconds(Clock::duration d) {
  return std::chrono::duration<double>(d).count();
}

/// By priority; among equals the order is nobody's to rely on, so it turns round with every tick.
std::vector<unsigned long> tick_order(const State& s) {
  std::vector<Task> tasks = s.tasks;
  const bool youngest_first = s.ticks % 2 == 0;
  std::sort(tasks.begin(), tasks.end(), [=](const Task& a, const Task& b) {
    if (a.priority != b.priority) return a.priority > b.priority;
    return (a.handle > b.handle) == youngest_first && a.handle != b.handle;
  });
  std::vector<unsigned long> handles;
  handles.reserve(tasks.size());
  for (const Task& task : tasks) handles.push_back(task.handle);
  return handles;
}

void ramp(State& s, Session& d) {
  if (d.off_ticks > 0) --d.off_ticks;
  if (!is_enabled(d, hd::kForceOutput) || d.off_ticks > 0) {
    d.gain = 0;
  } else if (is_enabled(d, hd::kForceRamping) && d.ramp_time > 0) {
    d.gain = std::min(1.0, d.gain + 1 / (static_cast<double>(s.rate) * d.ramp_time));
  } else {
    d.gain = 1;
  }
}

void begin_tick(State& s) {
  const Clock::time_point now = Clock::now();
  const double since = seconds(now - s.tick_start);
  s.measured_rate = s.script.manual || since <= 0 ? static_cast<double>(s.rate) : 1 / since;
  s.servo = std::this_thread::get_id();
  s.tick_start = now;
  s.pretended = 0;
  s.tripped = false;
  ++s.ticks;
  for (auto& d : s.sessions) {
    if (!d->open) continue;
    d->frames_this_tick = 0;
    ramp(s, *d);
    if (!d->lost) advance(s, *d);
  }
  apply_faults(s);
}

void end_tick(State& s) {
  for (auto& d : s.sessions) {
    if (d->open) end_force(s, *d);
  }
  s.servo = {};
  s.changed.notify_all();
}

/// Absolute deadlines; those that have passed are skipped and counted, not made up for in a burst.
void run_thread(State& s, const std::shared_ptr<std::atomic<bool>>& stop) {
  Clock::time_point next = Clock::now();
  while (!stop->load()) {
    std::unique_lock lock(s.mutex);
    const auto period = std::chrono::nanoseconds(1'000'000'000 / s.rate);
    lock.unlock();
    next += period;
    std::this_thread::sleep_until(next);
    lock.lock();
    if (stop->load()) return;
    for (const auto now = Clock::now(); next + period <= now; next += period) ++s.missed;
    run_tick(s, lock);
  }
}

}  // namespace

bool in_servo(const State& s) {
  return s.servo == std::this_thread::get_id();
}

double tick_time(const State& s) {
  // In manual mode no test may depend on how busy the machine is.
  return s.pretended + (s.script.manual ? 0 : seconds(Clock::now() - s.tick_start));
}

void wait_for_turn(State& s, std::unique_lock<std::mutex>& lock) {
  s.changed.wait(lock, [&s] { return s.servo == std::thread::id(); });
}

void check_watchdog(State& s) {
  if (s.servo == std::thread::id() || s.tripped || tick_time(s) <= s.script.stall_limit) return;
  s.tripped = true;
  for (auto& d : s.sessions) {
    if (!d->open) continue;
    push_error(s, hd::kDeviceFault, d->handle);
    trip(s, *d);
  }
}

const Task* find_task(const State& s, unsigned long handle) {
  const auto same = [handle](const Task& task) { return task.handle == handle; };
  const auto at = std::find_if(s.tasks.begin(), s.tasks.end(), same);
  return at == s.tasks.end() ? nullptr : &*at;
}

void call_task(State& s, std::unique_lock<std::mutex>& lock, unsigned long handle) {
  const Task* found = find_task(s, handle);
  if (!found) return;
  const Task task = *found;
  lock.unlock();
  const unsigned answer = task.callback(task.user);
  lock.lock();
  check_watchdog(s);
  if (answer > hd::kContinue) misuse(s, "a callback returned neither DONE nor CONTINUE");
  if (answer == hd::kContinue) return;
  std::erase_if(s.tasks, [handle](const Task& t) { return t.handle == handle; });
  s.changed.notify_all();
}

void run_tick(State& s, std::unique_lock<std::mutex>& lock) {
  begin_tick(s);
  for (const unsigned long handle : tick_order(s)) call_task(s, lock, handle);
  end_tick(s);
}

void stop_scheduler(State& s, std::unique_lock<std::mutex>& lock) {
  if (!s.running) return;
  s.running = false;
  if (s.stop) s.stop->store(true);
  std::thread thread = std::move(s.thread);
  s.thread = {};
  lock.unlock();
  if (thread.joinable()) thread.join();
  lock.lock();
  wait_for_turn(s, lock);  // of a manual tick on another thread
  for (auto& d : s.sessions) {
    d->applied = d->limited = {};
    d->gain = 0;
  }
  s.changed.notify_all();
}

}  // namespace fakehd

using namespace fakehd;

void hdStartScheduler(void) {
  Guard s;
  if (s->running) return;
  s->running = true;
  ++s->starts;
  s->tick_start = Clock::now();
  for (auto& d : s->sessions) d->gain = 0;
  if (s->script.manual) return;
  s->stop = std::make_shared<std::atomic<bool>>(false);
  s->thread = std::thread([&only = *s, stop = s->stop] { run_thread(only, stop); });
}

void hdStopScheduler(void) {
  Guard s;
  if (in_servo(*s)) {
    refuse(*s, hd::kInvalidOperation, "hdStopScheduler in a callback would wait for itself");
    return;
  }
  stop_scheduler(*s, s.lock());
}

void hdSetSchedulerRate(unsigned long rate) {
  Guard s;
  const auto& rates = s->script.rates;
  if (std::find(rates.begin(), rates.end(), rate) != rates.end()) {
    s->rate = rate;
    return;
  }
  const RateQuirk quirk = s->script.rate_quirk;
  const unsigned code = quirk == RateQuirk::timer       ? hd::kTimerError
                        : quirk == RateQuirk::operation ? hd::kInvalidOperation
                                                        : hd::kInvalidValue;
  push_error(*s, code, hd::kInvalidHandle);
}

double hdGetSchedulerTimeStamp(void) {
  Guard s;
  return tick_time(*s);
}
