// What a host may do with small fragments: let them rest, or take them away.
#pragma once

#include <cstdint>

namespace crumble {

enum class FragmentState : std::uint8_t {
  active = 0,
  asleep = 1,   // stands still, weightless, until a tool touches it; walls do not push it
  removed = 2,  // is not there any more: nothing moves or touches it, no surface shows it. For good
};

/// Which fragments count as debris.
struct DebrisRule {
  std::uint32_t max_nodes = 8;
  double max_speed = 1e-3;  // of each of its nodes, m/s
};

}  // namespace crumble
