// The newest value, from one thread to any number of readers, without the writer ever waiting.
//
// A sequence lock (Boehm, Can Seqlocks Get Along With Programming Language Memory Models?, MSPC 2012). The writer makes
// the count odd, writes the words, makes it even. A reader that saw the same even count before and after it copied the
// words has them of one value; else it copies again. The words are atomics, so that a copy that races is no undefined
// behaviour, only thrown away: each is released after the odd count, so whoever acquires one sees that count, or a
// later one, when it looks again. For values that several threads want; where there is one reader and the value is
// large, base/latest_value.hpp copies nothing.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace crumble {

template <class T>
class SharedValue {
  // Eigen's small vectors copy as bytes although they do not say so, hence no more than this.
  static_assert(std::is_trivially_destructible_v<T> && std::is_default_constructible_v<T>);

 public:
  SharedValue() { store(T{}); }

  /// One thread at a time. Never waits.
  void store(const T& value) noexcept {
    std::array<std::uint64_t, kWords> words{};
    std::memcpy(words.data(), static_cast<const void*>(&value), sizeof value);
    const std::uint64_t count = count_.load(std::memory_order_relaxed);
    count_.store(count + 1, std::memory_order_relaxed);
    for (std::size_t i = 0; i < kWords; ++i) words_[i].store(words[i], std::memory_order_release);
    count_.store(count + 2, std::memory_order_release);
  }

  /// Any thread. Copies again as long as the writer comes in between.
  T load() const noexcept {
    std::array<std::uint64_t, kWords> words;
    while (true) {
      const std::uint64_t before = count_.load(std::memory_order_acquire);
      for (std::size_t i = 0; i < kWords; ++i) words[i] = words_[i].load(std::memory_order_acquire);
      if (before % 2 == 0 && before == count_.load(std::memory_order_relaxed)) break;
    }
    T value;
    std::memcpy(static_cast<void*>(&value), words.data(), sizeof value);
    return value;
  }

 private:
  static constexpr std::size_t kWords = (sizeof(T) + 7) / 8;
  alignas(64) std::atomic<std::uint64_t> count_{0};
  std::array<std::atomic<std::uint64_t>, kWords> words_{};
};

}  // namespace crumble
