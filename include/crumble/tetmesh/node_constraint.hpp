// The one word that contact and network have in common: how a tool or a wall holds a node.
#pragma once

#include <cstdint>

#include "crumble/base/vec.hpp"

namespace crumble {

enum class ContactState : std::uint8_t {
  fresh = 0,     // found in this step: the solver decides between stick and slip by static friction
  stick = 1,     // held: moves with the tool
  slip = 2,      // slides along the surface under dynamic friction
  released = 3,  // the body pulled away: no force; dropped before the next step
  attached = 4,  // goes with its holder, whatever pulls on it
};

struct NodeConstraint {
  std::uint32_t node = 0;
  std::uint32_t holder = 0;  // index of the tool, or number of tools + index of the attachment; kWorldHolder: walls
  ContactState state = ContactState::fresh;
  Vec3 point = Vec3::Zero();     // where the node is held, metres
  Vec3 normal = Vec3::Zero();    // unit, from the holder's surface into the body; zero of an attached node
  Vec3 velocity = Vec3::Zero();  // of the holder's surface at the node, m/s
  double static_friction = 0;    // Coulomb, dimensionless
  double dynamic_friction = 0;
  double approach = 0;           // normal speed at which holder and node met, m/s; of a fresh contact
  Vec3 reaction = Vec3::Zero();  // out: force that the holder puts on the node, N
};

inline constexpr std::uint32_t kWorldHolder = 0xffffffffu;

}  // namespace crumble
