// Where the library's memory comes from: a pair of functions that a host may replace by its own
// (crumble_memory_set_source of the C API). All that grows with a body comes from here: arrays are Vectors, objects
// that stand alone are Allocated. Words for people, files, threads, and what other libraries take for themselves do
// not.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace crumble {

/// Two functions and what they work with. Called from every thread that makes, copies or destroys objects, never in a
/// step, also by several threads at once.
struct MemorySource {
  /// `bytes` at a multiple of `alignment`, a power of two; nullptr when there is none left.
  void* (*take)(std::size_t bytes, std::size_t alignment, void* user) = nullptr;
  void (*give_back)(void* memory, std::size_t bytes, std::size_t alignment, void* user) = nullptr;
  void* user = nullptr;
};

/// What the library has taken and not given back, and the most that it ever had, since the source was set.
struct MemoryUse {
  std::uint64_t blocks = 0, bytes = 0, most_bytes = 0;
};

/// Throws Error(in_use) while anything is taken. With take == nullptr: back to the C++ run time's.
void set_memory_source(const MemorySource& source);
MemoryUse memory_use() noexcept;

/// Throws std::bad_alloc.
void* take_memory(std::size_t bytes, std::size_t alignment);
void give_memory_back(void* memory, std::size_t bytes, std::size_t alignment) noexcept;

/// Of standard containers. All are equal.
template <class T>
struct Allocator {
  using value_type = T;
  Allocator() = default;
  template <class U>
  Allocator(const Allocator<U>&) noexcept {}  // NOLINT(google-explicit-constructor): containers convert
  T* allocate(std::size_t count) {
    if (count > static_cast<std::size_t>(-1) / sizeof(T)) throw std::bad_array_new_length();
    return static_cast<T*>(take_memory(count * sizeof(T), alignof(T)));
  }
  void deallocate(T* memory, std::size_t count) noexcept { give_memory_back(memory, count * sizeof(T), alignof(T)); }
  template <class U>
  bool operator==(const Allocator<U>&) const noexcept {
    return true;
  }
};

/// std::vector but for where its memory comes from.
template <class T>
using Vector = std::vector<T, Allocator<T>>;

/// Base of classes whose objects std::make_unique makes.
struct Allocated {
  static void* operator new(std::size_t bytes) { return take_memory(bytes, alignof(std::max_align_t)); }
  static void operator delete(void* memory, std::size_t bytes) noexcept {
    give_memory_back(memory, bytes, alignof(std::max_align_t));
  }
  // A constructor that throws finds no delete with size and alignment both: the size stands before the object.
  static void* operator new(std::size_t bytes, std::align_val_t alignment);
  static void operator delete(void* memory, std::align_val_t alignment) noexcept;
  static void* operator new(std::size_t, void* place) noexcept { return place; }
  static void operator delete(void*, void*) noexcept {}
};

/// std::make_shared, but for where the memory comes from.
template <class T, class... Arguments>
std::shared_ptr<T> share_new(Arguments&&... arguments) {
  return std::allocate_shared<T>(Allocator<std::remove_const_t<T>>(), std::forward<Arguments>(arguments)...);
}

}  // namespace crumble
