// One block of a host's memory that serves as a memory source: for programs that give a library what it may use and
// no more.
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>

#include "crumble/base/memory.hpp"

namespace crumble {

/// Takes the first free stretch that fits; what is given back joins its free neighbours. Any thread.
class MemoryBlock {
 public:
  static constexpr std::size_t kLeast = 4096;  // bytes
  /// Throws Error: out_of_range (fewer than kLeast), too_large (than an address).
  static void check_size(std::uint64_t bytes);

  /// Borrows `bytes` of `memory`. Throws Error what check_size() throws.
  MemoryBlock(void* memory, std::size_t bytes);

  /// nullptr when no stretch is long enough.
  void* take(std::size_t bytes, std::size_t alignment) noexcept;
  void give_back(void* memory) noexcept;

  /// Of the longest free stretch, without what is needed to remember it.
  std::size_t longest_free() const noexcept;
  MemorySource source() noexcept;

 private:
  struct Stretch {  // free; they stand in the order of their addresses
    std::size_t bytes;
    Stretch* next;
  };
  struct Head {  // before what has been taken
    std::byte* begin;
    std::size_t bytes;
  };
  static constexpr std::size_t kGrain = 16;  // all stretches begin and end at multiples of it
  static_assert(sizeof(Stretch) == kGrain && sizeof(Head) == kGrain);

  void* take_from(Stretch** link, std::byte* place, std::byte* end) noexcept;

  mutable std::mutex mutex_;
  Stretch* first_ = nullptr;
};

}  // namespace crumble
