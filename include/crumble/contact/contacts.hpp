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
#include "crumble/tetmesh/node_source.hpp"

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
  /// Stage 2, first half: nodes that the tools at place `place` (0-based) and the walls hold. Searches `nodes` once for
  /// each tool and each wall and reads no node that is neither found nor held.
  void find(std::uint32_t place, NodeSource& nodes) noexcept;
  /// Stage 2, second half: moves them onto the surface and gives them its normal velocity, and those that stick all of
  /// its velocity.
  void project(NodeSource& nodes) noexcept;

  /// A sleeping node is held by nothing; a tool that comes to it rouses it and holds it. Not for fixed nodes.
  void let_sleep(std::uint32_t node) noexcept;
  void wake(std::uint32_t node) noexcept;
  /// The node touches nothing from here on, as if it were not there.
  void exclude(std::uint32_t node) noexcept;
  /// Nodes that tools have roused in the last find(): awake from here on.
  std::span<const std::uint32_t> roused() const noexcept { return roused_; }

  /// For stage 3; in order of holder, then of entry: those that it held before stay in their order, and what comes in
  /// follows in the order of the search.
  std::span<NodeConstraint> constraints() noexcept { return constraints_; }
  std::span<const NodeConstraint> constraints() const noexcept { return constraints_; }
  /// At the end of a step: forgets the contacts that the solver released.
  void drop_released() noexcept;

  std::span<const Tool> tools() const noexcept { return tools_; }
  const Pose& pose(std::size_t tool) const noexcept { return motions_[tool].to; }
  /// False from a jump, or from a start inside the body, until the tool has been outside once.
  bool engaged(std::size_t tool) const noexcept { return motions_[tool].engaged; }
  bool jumped(std::size_t tool) const noexcept { return motions_[tool].jumped; }

  /// Back to before the first move, all nodes awake and none excluded.
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
    Frame from_frame{from}, to_frame{to};
    Vec3 velocity = Vec3::Zero();  // a point p of the tool moves at velocity + turning p, m/s
    Mat3 turning = Mat3::Zero();
    double travel = 0;
    std::uint32_t places = 1;
    bool placed = false, engaged = false, jumped = false;
  };
  struct Place {  // of a contact on its holder
    Vec3 anchor;  // in the holder's frame
    std::uint32_t face = 0;
  };
  enum class Use : std::uint8_t { free, held, fixed, asleep, excluded };  // held: named by constraints_

  void find_of_tool(std::uint32_t tool, std::uint32_t place, NodeSource& nodes) noexcept;
  void keep_on_tool(std::uint32_t tool, const Frame& frame, const NodeSource& nodes) noexcept;
  void enter_tool(std::uint32_t tool, const Frame& frame, std::span<const std::uint32_t> near,
                  const NodeSource& nodes) noexcept;
  bool is_outside(const Tool& tool, const Frame& frame, std::span<const std::uint32_t> near,
                  const NodeSource& nodes) const noexcept;
  void find_of_walls(NodeSource& nodes) noexcept;
  bool place_on_tool(const Tool& tool, const Motion& motion, const Frame& frame, double keep_gap, const Vec3& local,
                     Place& place) const noexcept;
  void leave_along_motion(const Tool& tool, const Motion& motion, const Frame& frame, const Vec3& local,
                          Place& place) const noexcept;
  NodeConstraint& hold(std::uint32_t tool, const Frame& frame, std::uint32_t node, ContactState state,
                       const Place& place) noexcept;
  NodeConstraint& hold_by_wall(std::uint32_t node, ContactState state, const Place& place) noexcept;
  void release(std::uint32_t node) noexcept;
  NodeConstraint& add(NodeConstraint& constraint, std::uint32_t node, ContactState state, const Place& place,
                      const Friction& friction) noexcept;

  std::vector<Tool> tools_;
  std::vector<VecArray> corners_;  // of each tool, see tool_bounds.hpp
  std::vector<Wall> walls_;
  std::vector<Motion> motions_;
  ContactRule rule_;
  ReservedVector<NodeConstraint> constraints_, previous_;
  ReservedVector<Place> places_, previous_places_;
  ReservedVector<std::uint32_t> roused_;
  std::vector<Use> uses_;                  // of each node
  std::vector<std::uint32_t> last_faces_;  // that each node was found outside of; a guess, changes no result
};

}  // namespace crumble
