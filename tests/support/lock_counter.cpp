#include "support/lock_counter.hpp"

#include <dlfcn.h>
#include <pthread.h>

#include "support/allocation_counter.hpp"

namespace crumble {
namespace {

thread_local bool armed = false;
thread_local std::size_t locks = 0;

}  // namespace

LockCounter::LockCounter() noexcept {
  locks = 0;
  armed = true;
}
LockCounter::~LockCounter() {
  armed = false;
}
std::size_t LockCounter::count() const noexcept {
  return locks;
}
bool LockCounter::available() noexcept {
  return AllocationCounter::available();
}

}  // namespace crumble

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

namespace {

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}
void note() {
  if (crumble::armed) ++crumble::locks;
}

}  // namespace

#define CRUMBLE_INTERPOSED extern "C" __attribute__((visibility("default")))

CRUMBLE_INTERPOSED int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  static const auto real = next<int (*)(pthread_mutex_t*)>("pthread_mutex_lock");
  note();
  return real(mutex);
}
CRUMBLE_INTERPOSED int pthread_rwlock_rdlock(pthread_rwlock_t* lock) noexcept {
  static const auto real = next<int (*)(pthread_rwlock_t*)>("pthread_rwlock_rdlock");
  note();
  return real(lock);
}
CRUMBLE_INTERPOSED int pthread_rwlock_wrlock(pthread_rwlock_t* lock) noexcept {
  static const auto real = next<int (*)(pthread_rwlock_t*)>("pthread_rwlock_wrlock");
  note();
  return real(lock);
}
CRUMBLE_INTERPOSED int pthread_cond_signal(pthread_cond_t* condition) noexcept {
  static const auto real = next<int (*)(pthread_cond_t*)>("pthread_cond_signal");
  note();
  return real(condition);
}
CRUMBLE_INTERPOSED int pthread_cond_broadcast(pthread_cond_t* condition) noexcept {
  static const auto real = next<int (*)(pthread_cond_t*)>("pthread_cond_broadcast");
  note();
  return real(condition);
}

#endif
