// Errors at set-up. Nothing in a step throws: what a step drops or clamps is told in its flags and counters.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace crumble {

/// What went wrong. The values are those of the C API's result codes.
enum class Code : std::int32_t {
  null = -1,
  invalid_value = -2,  // NaN or infinite
  out_of_range = -3,   // finite, outside the allowed range
  uninitialized = -4,  // a def whose struct_size is 0
  version = -5,        // a def or file of a version this library does not know
  bad_handle = -6,
  stale_handle = -7,
  busy = -8,
  in_use = -9,
  buffer_too_small = -10,
  no_memory = -11,
  too_large = -12,
  too_coarse = -13,
  empty = -14,
  mesh = -15,
  mesh_open = -16,
  mesh_orientation = -17,
  mesh_nonconvex = -18,
  duplicate_node = -19,
  isolated_node = -20,
  dt_too_large = -21,
  bad_pose = -22,
  io = -23,
  format = -24,
  corrupt = -25,
  device_lost = -26,
  diverged = -27,
  state = -28,  // the call does not fit the object's state
  unsupported = -29,
  internal = -30,
};

/// Thrown by set-up functions; what() names the field and the value.
class Error : public std::runtime_error {
 public:
  Error(Code code, const std::string& text) : std::runtime_error(text), code_(code) {}
  Code code() const noexcept { return code_; }

 private:
  Code code_;
};

/// Each throws Error when the rule is broken; `field` stands in the message as the user writes it.
void require_finite(std::string_view field, double value);
void require_positive(std::string_view field, double value);
void require_in_range(std::string_view field, double value, double least, double greatest);

}  // namespace crumble
