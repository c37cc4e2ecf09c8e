// What can be got and set by name: one row for each, so that a wrong name, type or moment gives its own error.
#pragma once

#include <array>

#include "fakehd_state.hpp"

namespace fakehd {

enum class Type { boolean, integer, real, text };

struct Parameter {
  unsigned name;
  Type type;
  int count;              // 0: one for each motor
  bool settable = false;  // by hdSet
  bool in_frame = false;  // hdSet needs a frame
  bool modelled = true;
};

using Values = std::array<double, 16>;

const Parameter* find_parameter(unsigned name);
int count_of(const Parameter&, const DeviceScript&);

}  // namespace fakehd
