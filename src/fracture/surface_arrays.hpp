// Buffers of the extractor. They are as long as a fully broken body needs; what has not been used is not touched, so it
// costs addresses and no memory.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>

#include "crumble/base/memory.hpp"

namespace crumble {

template <class T>
class UntouchedArray {
 public:
  explicit UntouchedArray(std::size_t size)
      : items_(static_cast<T*>(take_memory(size * sizeof(T), alignof(T))), {size * sizeof(T)}), size_(size) {
    std::uninitialized_default_construct_n(items_.get(), size);
  }
  T& operator[](std::size_t i) noexcept { return items_[i]; }
  const T& operator[](std::size_t i) const noexcept { return items_[i]; }
  std::span<const T> first(std::size_t count) const noexcept { return {items_.get(), count}; }
  std::size_t size() const noexcept { return size_; }

 private:
  static_assert(std::is_trivially_destructible_v<T>);
  struct GiveBack {
    std::size_t bytes;
    void operator()(T* items) const noexcept { give_memory_back(items, bytes, alignof(T)); }
  };
  std::unique_ptr<T[], GiveBack> items_;
  std::size_t size_;
};

/// Indices below a bound, each once, in the order of their coming. Clearing costs what was inserted.
class IndexSet {
 public:
  explicit IndexSet(std::size_t bound) : marks_((bound + 63) / 64), items_(bound), all_items_(bound) {}

  void insert(std::uint32_t index) noexcept {
    if (all_ || contains(index)) return;
    marks_[index / 64] |= bit(index);
    items_[count_++] = index;
  }
  /// Everything below the bound of the next keep_below(); to be cleared before anything else is inserted.
  void insert_all() noexcept {
    clear();
    all_ = true;
  }
  bool contains(std::uint32_t index) const noexcept { return (marks_[index / 64] & bit(index)) != 0; }

  void keep_below(std::size_t bound) noexcept {
    if (all_) return count_all(bound);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const std::uint32_t index = items_[i];
      if (index < bound) {
        items_[kept++] = index;
      } else {
        marks_[index / 64] &= ~bit(index);
      }
    }
    count_ = kept;
  }
  void clear() noexcept {
    if (all_) count_ = 0;
    all_ = false;
    keep_below(0);
  }
  std::span<const std::uint32_t> items() const noexcept { return (all_ ? all_items_ : items_).first(count_); }

 private:
  // The list of all is made once, as far as it has been needed.
  void count_all(std::size_t bound) noexcept {
    for (; listed_ < bound; ++listed_) all_items_[listed_] = static_cast<std::uint32_t>(listed_);
    count_ = bound;
  }
  static std::uint64_t bit(std::uint32_t index) noexcept { return std::uint64_t{1} << index % 64; }

  Vector<std::uint64_t> marks_;
  UntouchedArray<std::uint32_t> items_, all_items_;
  std::size_t count_ = 0, listed_ = 0;
  bool all_ = false;
};

}  // namespace crumble
