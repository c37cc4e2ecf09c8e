// A vector that begins at a cache line, so that vectors loaded in step with it never straddle two.
#pragma once

#include <cstddef>

#include "crumble/base/memory.hpp"

namespace crumble {

template <class T>
struct LineAllocator {
  using value_type = T;
  static constexpr std::size_t kLine = 64;

  LineAllocator() = default;
  template <class U>
  LineAllocator(const LineAllocator<U>&) {}
  T* allocate(std::size_t n) { return static_cast<T*>(take_memory(n * sizeof(T), kLine)); }
  void deallocate(T* p, std::size_t n) noexcept { give_memory_back(p, n * sizeof(T), kLine); }
  bool operator==(const LineAllocator&) const = default;
};

template <class T>
using AlignedVector = std::vector<T, LineAllocator<T>>;

}  // namespace crumble
