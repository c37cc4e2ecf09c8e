// Counts locks: what runs in a servo tick must take none.
#pragma once

#include <cstddef>

namespace crumble {

/// Counts the calling thread's calls of pthread's mutexes, reader-writer locks and condition variables while it lives
/// (std::mutex and its relatives end there). Link lock_counter.cpp into the test program.
class LockCounter {
 public:
  LockCounter() noexcept;
  ~LockCounter();
  LockCounter(const LockCounter&) = delete;
  LockCounter& operator=(const LockCounter&) = delete;
  std::size_t count() const noexcept;

  /// False where nothing is counted: under a sanitizer, which stands in front of them itself.
  static bool available() noexcept;
};

}  // namespace crumble
