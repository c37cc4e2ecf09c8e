// Little-endian bytes in and out: snapshots and recordings.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"

namespace crumble {

static_assert(std::endian::native == std::endian::little, "files are little-endian as they stand in memory");

template <class T>
concept Plain = std::is_trivially_copyable_v<T> && std::is_arithmetic_v<T>;

class ByteWriter {
 public:
  template <Plain T>
  void put(T value) {
    put_raw(&value, sizeof value);
  }
  template <Plain T>
  void put(std::span<const T> values) {
    put(static_cast<std::uint64_t>(values.size()));
    put_raw(values.data(), values.size_bytes());
  }
  template <Plain T>
  void put(const Vector<T>& values) {
    put(std::span<const T>(values));
  }
  void put_raw(const void* data, std::size_t size) {
    const std::size_t at = bytes_.size();
    bytes_.resize(at + size);
    if (size > 0) std::memcpy(bytes_.data() + at, data, size);
  }
  Vector<std::uint8_t>& bytes() { return bytes_; }

 private:
  Vector<std::uint8_t> bytes_;
};

/// Reads what ByteWriter wrote. Throws Error(corrupt), naming `what` it was reading, instead of running past the end;
/// no count is believed before the bytes behind it are seen to be there.
class ByteReader {
 public:
  ByteReader(std::span<const std::uint8_t> bytes, std::string_view what) : bytes_(bytes), what_(what) {}
  template <Plain T>
  T get() {
    T value;
    get_raw(&value, sizeof value);
    return value;
  }
  template <Plain T>
  Vector<T> get_vector() {
    const auto count = get<std::uint64_t>();
    if (count > left() / sizeof(T)) fail();
    Vector<T> values(static_cast<std::size_t>(count));
    get_raw(values.data(), values.size() * sizeof(T));
    return values;
  }
  void get_raw(void* data, std::size_t size) {
    if (size > left()) fail();
    if (size > 0) std::memcpy(data, bytes_.data() + at_, size);
    at_ += size;
  }
  std::size_t left() const { return bytes_.size() - at_; }
  std::size_t at() const { return at_; }

 private:
  [[noreturn]] void fail() const {
    throw Error(Code::corrupt, what_ + " is truncated: it ends at byte " + std::to_string(bytes_.size()));
  }
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  std::string what_;
};

}  // namespace crumble
