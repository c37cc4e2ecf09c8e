// Callbacks come and go: hdSchedule..., hdUnschedule, hdWaitForCompletion.
#include "fakehd_state.hpp"

namespace fakehd {
namespace {

// Longer than 32 bits, so that a handle kept in 32 is found out.
constexpr unsigned long kFirstHandle = 0x100000001UL;
constexpr unsigned long kNoHandle = hd::kInvalidHandle;
constexpr int kPatience = 100'000;  // ticks that a wait in manual mode runs itself

unsigned long add_task(State& s, HdCallback callback, void* user, unsigned short priority) {
  if (!callback) {
    refuse(s, hd::kInvalidValue, "a callback that is null");
    return kNoHandle;
  }
  if (s.tasks.size() >= s.script.scheduler_slots) {
    push_error(s, hd::kSchedulerFull, hd::kInvalidHandle);
    return kNoHandle;
  }
  const unsigned long handle = kFirstHandle + s.next_task++;
  s.tasks.push_back({handle, callback, user, priority});
  return handle;
}

bool remove_task(State& s, unsigned long handle) {
  return std::erase_if(s.tasks, [handle](const Task& task) { return task.handle == handle; }) > 0;
}

/// In manual mode nobody else runs the ticks that are waited for.
void run_until_gone(State& s, std::unique_lock<std::mutex>& lock, unsigned long handle) {
  for (int i = 0; i < kPatience; ++i) {
    wait_for_turn(s, lock);
    if (!s.running || !find_task(s, handle)) return;
    run_tick(s, lock);
  }
  misuse(s, "waited for a callback that never ends");
}

void wait_until_gone(State& s, std::unique_lock<std::mutex>& lock, unsigned long handle) {
  if (s.script.manual) return run_until_gone(s, lock, handle);
  s.changed.wait(lock, [&] { return !s.running || !find_task(s, handle); });
}

}  // namespace
}  // namespace fakehd

using namespace fakehd;

unsigned long hdScheduleAsynchronous(HdCallback callback, void* user, unsigned short priority) {
  Guard s;
  const unsigned long handle = add_task(*s, callback, user, priority);
  if (handle != kNoHandle && in_servo(*s)) call_task(*s, s.lock(), handle);
  return handle;
}

void hdScheduleSynchronous(HdCallback callback, void* user, unsigned short priority) {
  Guard s;
  if (!s->running) {
    refuse(*s, hd::kInvalidOperation, "hdScheduleSynchronous while the scheduler is off");
    return;
  }
  const unsigned long handle = add_task(*s, callback, user, priority);
  if (handle == kNoHandle) return;
  if (in_servo(*s)) {
    call_task(*s, s.lock(), handle);
    if (remove_task(*s, handle)) misuse(*s, "hdScheduleSynchronous in a callback, of one that goes on");
    return;
  }
  wait_until_gone(*s, s.lock(), handle);
  remove_task(*s, handle);  // when the scheduler stopped meanwhile
}

void hdUnschedule(unsigned long handle) {
  Guard s;
  if (!remove_task(*s, handle)) push_error(*s, hd::kInvalidOperation, hd::kInvalidHandle);
  s->changed.notify_all();
}

unsigned char hdWaitForCompletion(unsigned long handle, unsigned code) {
  Guard s;
  if (code > hd::kWaitInfinite) {
    refuse(*s, hd::kInvalidValue, "hdWaitForCompletion with an unknown code");
  } else if (code == hd::kWaitInfinite && in_servo(*s)) {
    refuse(*s, hd::kInvalidOperation, "hdWaitForCompletion in a callback would wait for itself");
  } else if (code == hd::kWaitInfinite && s->running) {
    wait_until_gone(*s, s.lock(), handle);
  }
  return find_task(*s, handle) ? 1 : 0;
}
