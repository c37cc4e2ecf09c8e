// A bounded queue from one thread to another, without either ever waiting.
//
// Two counts that only grow: items pushed, written by the producer, and items popped, written by the consumer. Their
// difference is how many wait, and each modulo the capacity is where to go on. The producer writes an item and then
// releases the count that covers it; the consumer acquires that count and then reads. The other way round the consumer
// releases a place by its count when it has copied the item out, and the producer acquires that before it writes there
// again. Each thread reads its own count relaxed, since nobody else writes it.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <span>
#include <type_traits>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"

namespace crumble {

/// From one producing thread to one consuming thread. When it is full the newest is dropped, and counted: the producer
/// never waits for a consumer that is late. Nothing allocates after construction.
template <class T>
class Ring {
  static_assert(std::is_trivially_destructible_v<T>, "an item owns nothing, so that copying it cannot allocate");

 public:
  /// Throws Error: out_of_range (capacity 0).
  explicit Ring(std::size_t capacity) : items_(capacity) {
    if (capacity == 0) throw Error(Code::out_of_range, "capacity of a ring must be at least 1, is 0");
  }

  // The producing thread

  /// Appends, or drops `item` when capacity() items wait.
  void push(const T& item) noexcept {
    const std::uint64_t pushed = pushed_.load(std::memory_order_relaxed);
    if (pushed - popped_.load(std::memory_order_acquire) == items_.size()) {
      dropped_.store(dropped_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
      return;
    }
    items_[pushed % items_.size()] = item;
    pushed_.store(pushed + 1, std::memory_order_release);
  }

  // The consuming thread

  /// Takes the oldest, as many as wait and fit. Returns how many.
  std::size_t pop(std::span<T> out) noexcept {
    const std::uint64_t popped = popped_.load(std::memory_order_relaxed);
    const std::uint64_t waiting = pushed_.load(std::memory_order_acquire) - popped;
    const std::size_t count = std::min<std::size_t>(waiting, out.size());
    for (std::size_t i = 0; i < count; ++i) out[i] = items_[(popped + i) % items_.size()];
    popped_.store(popped + count, std::memory_order_release);
    return count;
  }

  // Any thread

  std::size_t capacity() const noexcept { return items_.size(); }
  /// Items that found the ring full since the start.
  std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

 private:
  Vector<T> items_;
  alignas(64) std::atomic<std::uint64_t> pushed_{0};  // the producer's, with dropped_
  std::atomic<std::uint64_t> dropped_{0};
  alignas(64) std::atomic<std::uint64_t> popped_{0};  // the consumer's
};

}  // namespace crumble
