// Counts heap allocations: what runs in a step must not make any.
#pragma once

#include <cstddef>

namespace crumble {

/// Counts what the calling thread asks of malloc and its relatives (operator new ends there too) while it lives. Not
/// nested. Link allocation_counter.cpp into the test program: it stands in front of the C library's functions.
class AllocationCounter {
 public:
  AllocationCounter() noexcept;
  ~AllocationCounter();
  AllocationCounter(const AllocationCounter&) = delete;
  AllocationCounter& operator=(const AllocationCounter&) = delete;

  std::size_t count() const noexcept;

  /// False where nothing is counted: under a sanitizer, which needs malloc for itself, and outside glibc.
  static bool available() noexcept;
};

}  // namespace crumble
