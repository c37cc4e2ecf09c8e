// What happened in a step that a host may want to hear, show or feel.
#pragma once

#include <cstdint>

#include "crumble/base/vec.hpp"

namespace crumble {

enum class EventKind : std::uint8_t {
  cut = 1,            // a spring was cut
  split = 2,          // a fragment came off another
  contact_begin = 3,  // a tool or wall took hold of a node
  contact_end = 4,    // and let it go
};

/// What a field does not apply to holds kNone.
struct Event {
  static constexpr std::uint32_t kNone = 0xffffffffu;

  EventKind kind{};
  std::uint32_t spring = kNone;    // cut
  std::uint32_t node = kNone;      // contact; split: a node of the new fragment
  std::uint32_t holder = kNone;    // contact: tool; kNone: floor or wall
  std::uint32_t fragment = kNone;  // of the cut spring's first node, or of the node; split: the new fragment
  std::uint32_t parent = kNone;    // split: the fragment it came off
  std::uint64_t step = 0;          // in which it happened, counted from 0
  double time = 0;                 // simulated seconds at the end of that step
  Vec3 place = Vec3::Zero();       // metres: middle of the spring; split and contact_end: the node; contact_begin:
                                   // the point where it is held
  double energy = 0;  // J. cut: what the spring held, k/2 (l - l0)^2; contact_begin: m/2 v^2 of the node's approach
                      // along the normal; else 0
};

}  // namespace crumble
