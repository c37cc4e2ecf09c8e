// Nodes against polygons: which nodes a tool or wall holds, where it holds them, and what it remembers between steps.
//
// A contact lives from the step in which a node is found inside a tool until the body pulls away from it or the tool
// leaves it behind. It remembers the node's place in the tool's frame, so a sticking node goes where the tool goes, to
// the last bit, and does not drift. A sliding node is only pushed along the normal: the solver moves it sideways.
// Each node has one holder at a time; a tool takes a node from a wall, and the lower tool index wins.
#pragma once

#include <span>
#include <vector>

#include "crumble/base/bytes.hpp"
#include "crumble/base/reserved_vector.hpp"
#include "crumble/base/vec_array.hpp"
#include "crumble/contact/tool.hpp"
#include "crumble/tetmesh/node_constraint.hpp"

namespace crumble {

class Contacts {
 public:
  /// `fixed`: 1 for nodes that never move and so are never in contact (node_count).
  Contacts(std::vector<Tool> tools, std::vector<Wall> walls, std::span<const std::uint8_t> fixed, ContactRule rule);

  /// Stage 1: the tool goes from where it is to `target` within `tau` seconds. A path longer than half the tool's
  /// thickness is walked in up to kMaxPlaces places; a longer one is a jump: contact is suspended until the tool has
  /// been outside the body once.
  void move_tool(std::size_t tool, const Pose& target, double tau) noexcept;

  /// Places that stage 2 has to visit for the moves just made; 1 when nothing moves fast.
  std::uint32_t place_count() const noexcept;
  /// Stage 2, first half: nodes that the tools at place `place` (0-based) and the walls hold.
  void find(std::uint32_t place, VecView positions) noexcept;
  /// Stage 2, second half: moves them onto the surface and gives them its normal velocity.
  void project(VecSpan positions, VecSpan velocities) noexcept;

  /// For stage 3; in order of holder, then of entry.
  std::span<NodeConstraint> constraints() noexcept { return constraints_; }
  std::span<const NodeConstraint> constraints() const noexcept { return constraints_; }
  /// At the end of a step: forgets the contacts that the solver released.
  void drop_released() noexcept;

  std::span<const Tool> tools() const noexcept { return tools_; }
  const Pose& pose(std::size_t tool) const noexcept { return motions_[tool].to; }
  /// False from a jump, or from a start inside the body, until the tool has been outside once.
  bool engaged(std::size_t tool) const noexcept { return motions_[tool].engaged; }
  bool jumped(std::size_t tool) const noexcept { return motions_[tool].jumped; }

  /// Back to before the first move.
  void clear() noexcept;
  void save(ByteWriter& out) const;
  void load(ByteReader& in);

  static constexpr std::uint32_t kMaxPlaces = 8;
  /// A held node that came to lie this far outside the tool, beyond the tool's own travel, is let go, metres.
  static constexpr double kKeepGap = 5e-5;

  /// A tool that is no deeper in the body than this counts as outside, so that one may start touching it, metres.
  static constexpr double kTouch = 1e-5;

 private:
  struct Motion {  // of one tool in this substep
    Pose from, to;
    double tau = 1, travel = 0;
    std::uint32_t places = 1;
    bool placed = false, engaged = false, jumped = false;
  };
  struct Place {  // of a contact on its holder
    Vec3 anchor;  // in the holder's frame
    std::uint32_t face = 0;
  };

  void find_of_tool(std::uint32_t tool, std::uint32_t place, VecView positions) noexcept;
  void find_of_walls(VecView positions) noexcept;
  bool place_on_tool(const Tool& tool, const Motion& motion, const Frame& frame, double keep_gap, const Vec3& local,
                     Place& place) const noexcept;
  void add(std::uint32_t node, std::uint32_t holder, ContactState state, const Place& place, const Frame& frame,
           const Vec3& normal, const Friction& friction) noexcept;

  std::vector<Tool> tools_;
  std::vector<Wall> walls_;
  std::vector<Motion> motions_;
  std::vector<std::uint8_t> fixed_;
  ContactRule rule_;
  ReservedVector<NodeConstraint> constraints_, previous_;
  ReservedVector<Place> places_, previous_places_;
  std::vector<std::uint8_t> taken_;  // nodes that have a holder in this find
};

}  // namespace crumble
