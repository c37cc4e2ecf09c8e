// What touches the body: tools that a hand or a script moves, and walls that stand still.
#pragma once

#include <cstdint>

#include "crumble/base/memory.hpp"
#include "crumble/geometry/pose.hpp"
#include "crumble/geometry/solid.hpp"

namespace crumble {

/// Coulomb friction. The paper gives 3.0 and 1.5 (Table 1).
struct Friction {
  double static_coefficient = 0;   // >= dynamic_coefficient
  double dynamic_coefficient = 0;  // >= 0
};

/// The paper's manipulator: a solid in a frame of its own.
struct Tool {
  Solid shape;
  Friction friction = {};
  Pose offset = {};  // from the tool's frame to that of the hand that holds it, whose pose moves the tool
};

/// Nodes that go where a frame goes, from first to last: a clamp, a hand that never lets go. It is moved like a tool.
/// Nodes keep the places in it that they have when it is first placed.
struct Attachment {
  Vector<std::uint32_t> nodes;
};

/// A half-space that the body stays out of: n . x >= offset on the body's side. A floor is {(0, 1, 0), 0}.
struct Wall {
  Plane plane;
  Friction friction;
};

/// Which way a node found inside a tool is moved out.
enum class ContactRule : std::uint8_t {
  nearest_surface = 0,  // to the nearest face
  along_motion = 1,     // along the tool's motion: the paper's rule (section 2.4)
};

/// Throws Error naming the field.
void check(const Friction& friction);
void check(const Tool& tool);
void check(const Wall& wall);

}  // namespace crumble
