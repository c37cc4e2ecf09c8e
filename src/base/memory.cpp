#include "crumble/base/memory.hpp"

#include <atomic>
#include <mutex>
#include <new>
#include <string>

#include "crumble/base/error.hpp"

namespace crumble {
namespace {

void* take_from_run_time(std::size_t bytes, std::size_t alignment, void*) {
  if (alignment <= __STDCPP_DEFAULT_NEW_ALIGNMENT__) return ::operator new(bytes, std::nothrow);
  return ::operator new (bytes, std::align_val_t{alignment}, std::nothrow);
}

void give_run_time_back(void* memory, std::size_t, std::size_t alignment, void*) {
  if (alignment <= __STDCPP_DEFAULT_NEW_ALIGNMENT__) return ::operator delete(memory);
  ::operator delete (memory, std::align_val_t{alignment});
}

// Constant-initialised: static objects of the library and of hosts may take memory before main.
constinit MemorySource source{take_from_run_time, give_run_time_back, nullptr};
constinit std::atomic<std::uint64_t> blocks{0}, bytes_taken{0}, most_bytes{0};
constinit std::mutex setting;

void note_taken(std::size_t bytes) noexcept {
  const std::uint64_t now = bytes_taken.fetch_add(bytes, std::memory_order_relaxed) + bytes;
  std::uint64_t most = most_bytes.load(std::memory_order_relaxed);
  while (now > most && !most_bytes.compare_exchange_weak(most, now, std::memory_order_relaxed)) {
  }
}

}  // namespace

void set_memory_source(const MemorySource& given) {
  const std::lock_guard lock(setting);
  if (const std::uint64_t taken = blocks.load(std::memory_order_acquire); taken > 0) {
    throw Error(Code::in_use,
                "the library has " + std::to_string(taken) +
                    " blocks of memory: set its source before the first object is made, or after the last "
                    "is destroyed");
  }
  source = given.take ? given : MemorySource{take_from_run_time, give_run_time_back, nullptr};
  most_bytes.store(0, std::memory_order_relaxed);
}

MemoryUse memory_use() noexcept {
  return {blocks.load(std::memory_order_relaxed), bytes_taken.load(std::memory_order_relaxed),
          most_bytes.load(std::memory_order_relaxed)};
}

void* take_memory(std::size_t bytes, std::size_t alignment) {
  blocks.fetch_add(1, std::memory_order_acquire);
  void* const memory = source.take(bytes, alignment, source.user);
  if (!memory) {
    blocks.fetch_sub(1, std::memory_order_release);
    throw std::bad_alloc();
  }
  note_taken(bytes);
  return memory;
}

void give_memory_back(void* memory, std::size_t bytes, std::size_t alignment) noexcept {
  if (!memory) return;
  source.give_back(memory, bytes, alignment, source.user);
  bytes_taken.fetch_sub(bytes, std::memory_order_relaxed);
  blocks.fetch_sub(1, std::memory_order_release);
}

void* Allocated::operator new(std::size_t bytes, std::align_val_t alignment) {
  const auto before = static_cast<std::size_t>(alignment);
  auto* const memory = static_cast<std::byte*>(take_memory(before + bytes, before));
  new (memory) std::size_t(before + bytes);
  return memory + before;
}

void Allocated::operator delete(void* memory, std::align_val_t alignment) noexcept {
  if (!memory) return;
  const auto before = static_cast<std::size_t>(alignment);
  std::byte* const begin = static_cast<std::byte*>(memory) - before;
  give_memory_back(begin, *reinterpret_cast<const std::size_t*>(begin), before);
}

}  // namespace crumble
