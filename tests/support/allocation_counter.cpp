#include "support/allocation_counter.hpp"

#include <cerrno>
#include <cstdlib>

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define CRUMBLE_SANITIZED 1
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define CRUMBLE_SANITIZED 1
#endif
#if defined(__GLIBC__) && !defined(CRUMBLE_SANITIZED)
#define CRUMBLE_COUNTS_ALLOCATIONS 1
#endif

namespace crumble {
namespace {

thread_local bool armed = false;
thread_local std::size_t allocations = 0;

}  // namespace

AllocationCounter::AllocationCounter() noexcept {
  allocations = 0;
  armed = true;
}

AllocationCounter::~AllocationCounter() {
  armed = false;
}

std::size_t AllocationCounter::count() const noexcept {
  return allocations;
}

bool AllocationCounter::available() noexcept {
#ifdef CRUMBLE_COUNTS_ALLOCATIONS
  return true;
#else
  return false;
#endif
}

}  // namespace crumble

#ifdef CRUMBLE_COUNTS_ALLOCATIONS

// The program's own definitions win over the C library's for every library in the process, if they are visible.
// free is left alone: what these return comes from the C library.
#define CRUMBLE_INTERPOSED extern "C" __attribute__((visibility("default")))

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
}

namespace {
void note() {
  if (crumble::armed) ++crumble::allocations;
}
}  // namespace

CRUMBLE_INTERPOSED void* malloc(std::size_t size) {
  note();
  return __libc_malloc(size);
}

CRUMBLE_INTERPOSED void* calloc(std::size_t count, std::size_t size) {
  note();
  return __libc_calloc(count, size);
}

CRUMBLE_INTERPOSED void* realloc(void* old, std::size_t size) {
  note();
  return __libc_realloc(old, size);
}

CRUMBLE_INTERPOSED void* memalign(std::size_t alignment, std::size_t size) {
  note();
  return __libc_memalign(alignment, size);
}

CRUMBLE_INTERPOSED void* aligned_alloc(std::size_t alignment, std::size_t size) {
  note();
  return __libc_memalign(alignment, size);
}

CRUMBLE_INTERPOSED int posix_memalign(void** out, std::size_t alignment, std::size_t size) {
  note();
  *out = __libc_memalign(alignment, size);
  return *out ? 0 : ENOMEM;
}

#endif
