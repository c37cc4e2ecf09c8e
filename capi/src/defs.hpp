// Structs that begin with struct_size, across versions: what the library takes and what it fills.
//
// A struct only ever grows at its end and in steps of 8 bytes, so every older version is a prefix of a size that 8
// divides, and what an older program did not say is the default.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <type_traits>

#include "call.hpp"

namespace crumble::capi {

inline constexpr std::uint32_t kSizeStep = 8;
inline constexpr std::uint32_t kMostSize = 4096;  // nothing will grow to this; keeps garbage from being read far

/// Throws Error: uninitialized (0), version (no version's size).
void check_struct_size(const char* name, std::uint32_t struct_size);
/// Throws Error(version) unless all bytes of [from, to) of the struct are 0.
void require_zero_tail(const char* name, const void* given, std::size_t from, std::size_t to);

template <class Struct>
concept Sized = std::is_trivially_copyable_v<Struct> && sizeof(Struct) % kSizeStep == 0 && requires(Struct s) {
  static_cast<std::uint32_t&>(s.struct_size);
};

/// What the caller says: known fields over `defaults`.
template <Sized Struct>
Struct read_def(const char* name, const Struct* given, const Struct& defaults) {
  require_pointer(name, given);
  const std::uint32_t size = given->struct_size;
  check_struct_size(name, size);
  require_zero_tail(name, given, sizeof(Struct), size);
  Struct def = defaults;
  std::memcpy(&def, given, std::min<std::size_t>(size, sizeof(Struct)));
  def.struct_size = sizeof(Struct);
  return def;
}

/// Fills what a caller's struct of `struct_size` bytes has room for, and what this library does not know with zero.
template <Sized Struct>
void write_struct(const char* name, Struct* out, std::uint32_t struct_size, const Struct& values) {
  require_pointer(name, out);
  check_struct_size(name, struct_size);
  const std::size_t known = std::min<std::size_t>(struct_size, sizeof(Struct));
  std::memset(reinterpret_cast<char*>(out) + known, 0, struct_size - known);
  std::memcpy(static_cast<void*>(out), &values, known);
  out->struct_size = struct_size;
}

/// The same for a struct whose size the caller has set.
template <Sized Struct>
void write_struct(const char* name, Struct* out, const Struct& values) {
  require_pointer(name, out);
  write_struct(name, out, out->struct_size, values);
}

/// UTF-8. Throws Error(null).
std::filesystem::path path_of(const char* path);

/// Throws Error(out_of_range) unless value <= greatest.
void require_at_most(const char* field, std::uint32_t value, std::uint32_t greatest);

}  // namespace crumble::capi
