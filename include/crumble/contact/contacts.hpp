// Nodes against tools: which nodes a tool, a wall or an attachment holds, where it holds them, and what it remembers
// between steps.
//
// A contact lives from the step in which a node is found inside a tool until the body pulls away from it or the tool
// leaves it behind. It remembers the node's place in the tool's frame, so a sticking node goes where the tool goes, to
// the last bit, and does not drift. A sliding node is only pushed along the normal: the solver moves it sideways.
// A tool thinner than the distance between nodes meets the faces between them too, and holds the nodes of a face that
// it presses: see src/contact/sample_contacts.cpp.
// Each node has one holder at a time; a tool takes a node from a wall, and the lower tool index wins.
#pragma once

#include <span>

#include "crumble/base/bytes.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/reserved_vector.hpp"
#include "crumble/base/vec_array.hpp"
#include "crumble/contact/surface_samples.hpp"
#include "crumble/contact/tool.hpp"
#include "crumble/tetmesh/node_constraint.hpp"
#include "crumble/tetmesh/node_source.hpp"

namespace crumble {

class Contacts {
 public:
  /// `fixed`: 1 for nodes that never move and so are never in contact (node_count). `surface`: of the body, for thin
  /// tools to meet between its nodes; empty: nodes only. Throws Error what check() throws of each part.
  Contacts(Vector<Tool> tools, Vector<Wall> walls, std::span<const std::uint8_t> fixed, ContactRule rule,
           Vector<Attachment> attachments = {}, SurfaceSamples surface = {});

  /// Stage 1: a tool or attachment goes from where it is to `target` within `tau` seconds. Holders are numbered as in
  /// NodeConstraint: the tools, then the attachments.
  /// A tool's path longer than half its thickness, or that of its point or edge, is walked in up to kMaxPlaces places.
  /// One longer than kMaxPlaces half thicknesses is a jump: contact is suspended until the tool has been outside the
  /// body once. An attachment that goes faster than kMaxAttachedSpeed jumps: its nodes stay for this step and have new
  /// places in its frame, as if it were first placed.
  void move_holder(std::size_t holder, const Pose& target, double tau) noexcept;

  /// Places that stage 2 has to visit for the moves just made; 1 when nothing moves fast.
  std::uint32_t place_count() const noexcept;
  /// Stage 2, first half: nodes that the tools at place `place` (0-based), the attachments and the walls hold. Searches
  /// `nodes` once or twice for each tool and once for each wall and reads no node that is neither found nor held.
  void find(std::uint32_t place, NodeSource& nodes) noexcept;
  /// Stage 2, second half: moves them onto the surface and gives them its normal velocity, and those that stick all of
  /// its velocity.
  void project(NodeSource& nodes) noexcept;
  /// After the solver has moved the nodes: those that came to lie inside a tool are put on its surface, as fresh
  /// contacts if they were free, so that no step ends with a node inside. Not under the paper's rule, which looks once
  /// a step.
  void push_out(NodeSource& nodes) noexcept;

  /// A sleeping node is held by nothing; a tool that comes to it rouses it and holds it. Not for fixed nodes; attached
  /// ones do not sleep.
  void let_sleep(std::uint32_t node) noexcept;
  void wake(std::uint32_t node) noexcept;
  /// The node touches nothing from here on, as if it were not there.
  void exclude(std::uint32_t node) noexcept;
  /// Nodes that tools have roused in the last find(): awake from here on.
  std::span<const std::uint32_t> roused() const noexcept { return roused_; }
  /// These springs are broken: faces that were inside come to lie open, and those with a broken edge are gone.
  void note_cut(std::span<const std::uint32_t> springs) noexcept { surface_.note_cut(springs); }

  /// For stage 3; in order of holder, then of entry: those that it held before stay in their order, and what comes in
  /// follows in the order of the search. What push_out() adds stands at the end.
  std::span<NodeConstraint> constraints() noexcept { return constraints_; }
  std::span<const NodeConstraint> constraints() const noexcept { return constraints_; }
  /// At the end of a step: forgets the contacts that the solver released.
  void drop_released() noexcept;

  std::span<const Tool> tools() const noexcept { return tools_; }
  std::span<const Attachment> attachments() const noexcept { return attachments_; }
  /// Of the hand that moves it.
  const Pose& pose(std::size_t holder) const noexcept { return motions_[holder].to; }
  /// False before the first move.
  bool placed(std::size_t holder) const noexcept { return motions_[holder].placed; }
  /// Of the tool or attachment itself.
  const Frame& frame(std::size_t holder) const noexcept { return motions_[holder].to_frame; }
  /// Of a tool: false from a jump, or from a start inside the body, until the tool has been outside once. Of an
  /// attachment: false until it is placed.
  bool engaged(std::size_t holder) const noexcept { return motions_[holder].engaged; }
  bool jumped(std::size_t holder) const noexcept { return motions_[holder].jumped; }

  /// A suspended tool lets go of all that it holds and touches nothing; after it, it is not engaged until it has been
  /// outside once. Attachments hold on.
  void suspend(std::size_t tool, bool suspended) noexcept;

  /// Between two steps: the tools, walls, rule, surface and fixed nodes of `next`, which has as many tools and the same
  /// attachments and gets what was here in exchange. What is held stays held, but by `moved_tools` (1; by tool), which
  /// are to be placed anew, and by walls when they have moved. Allocates nothing.
  void redefine(Contacts& next, std::span<const std::uint8_t> moved_tools, bool moved_walls) noexcept;

  /// Back to before the first move, all nodes awake, none excluded, nothing cut.
  void clear() noexcept;
  void save(ByteWriter& out) const;
  void load(ByteReader& in);

  static constexpr std::uint32_t kMaxPlaces = 8;
  static constexpr double kMaxAttachedSpeed = 10;  // m/s, of the fastest node of an attachment
  /// A held node that came to lie this far outside the tool, beyond the tool's own travel, is let go, metres.
  static constexpr double kKeepGap = 5e-5;

  /// A tool that is no deeper in the body than this counts as outside, so that one may start touching it, metres.
  static constexpr double kTouch = 1e-5;

 private:
  struct Motion {                          // of one holder in this substep
    Pose from, to;                         // of the hand
    Frame from_frame{from}, to_frame{to};  // of the holder
    Vec3 velocity = Vec3::Zero();          // a point p of the holder moves at velocity + turning p, m/s
    Mat3 turning = Mat3::Zero();
    double travel = 0, tau = 0;
    std::uint32_t places = 1;
    bool placed = false, engaged = false, jumped = false, suspended = false;
  };
  struct Bounds {  // of a tool in its own frame
    Vec3 low, high;
  };
  static constexpr std::uint32_t kNoFace = 0xffffffffu;
  struct Place {                                        // of a contact on its holder
    Vec3 anchor = Vec3::Zero(), normal = Vec3::Zero();  // in the holder's frame
    std::uint32_t wall = 0;                             // where that is one
    std::uint32_t face = kNoFace;                       // by which a thin tool holds a node that is off its surface
  };
  // held: named by constraints_; attached: for good, and in constraints_ once its attachment is placed
  enum class Use : std::uint8_t { free, held, fixed, asleep, excluded, attached };

  Frame frame_of(std::size_t holder, const Pose& hand) const noexcept;
  void move_tool(std::size_t tool) noexcept;
  void let_go(std::size_t tool) noexcept;
  void find_of_tool(std::uint32_t tool, std::uint32_t place, NodeSource& nodes) noexcept;
  bool is_outside(const Tool& tool, const Frame& frame, std::span<const std::uint32_t> near,
                  const NodeSource& nodes) const noexcept;
  void keep_on_tool(std::uint32_t tool, const Frame& frame, const NodeSource& nodes) noexcept;
  void enter_tool(std::uint32_t tool, const Frame& frame, std::span<const std::uint32_t> near,
                  const NodeSource& nodes) noexcept;
  bool place_on_tool(const Tool& tool, const Motion& motion, const Frame& frame, double keep_gap, const Vec3& local,
                     Place& place) const noexcept;
  void leave_along_motion(const Tool& tool, const Motion& motion, const Frame& frame, const Vec3& local,
                          Place& place) const noexcept;
  bool push_out_of(std::uint32_t tool, NodeSource& nodes) noexcept;
  void put_held(std::uint32_t at, const NodeConstraint& c, const Place& place) noexcept;

  double thickness_met(const SolidModel& shape) const noexcept;
  bool is_thin(const Tool& tool) const noexcept;
  bool is_near(std::uint32_t face, std::uint32_t tool, const Frame& frame, double gap,
               const NodeSource& nodes) const noexcept;
  static void keep_height(const Vec3& local, Place& place) noexcept;
  static void let_back(const Motion& motion, Place& place) noexcept;
  static void stay_outside(const Tool& tool, Place& place) noexcept;
  void meet_faces(std::uint32_t tool, const Frame& frame, NodeSource& nodes) noexcept;
  void press_face(std::uint32_t face, std::uint32_t tool, const Frame& frame, const NodeSource& nodes) noexcept;
  bool can_press(std::uint32_t node, std::uint32_t tool) const noexcept;
  void hold_pressed(std::uint32_t node, std::uint32_t tool, const Frame& frame, const Place& place) noexcept;
  Vec3 position_of(std::uint32_t node, const NodeSource& nodes) const noexcept;

  void move_attachment(std::size_t holder) noexcept;
  void find_attached(std::size_t attachment, const NodeSource& nodes) noexcept;
  std::span<Vec3> anchors(std::size_t attachment) noexcept;
  void find_of_walls(NodeSource& nodes) noexcept;

  NodeConstraint on_tool(std::uint32_t tool, const Frame& frame, std::uint32_t node, ContactState state,
                         const Place& place) const noexcept;
  void hold_by_wall(std::uint32_t node, const NodeConstraint* before, const Place& place) noexcept;
  void add(const NodeConstraint& constraint, const Place& place) noexcept;
  static void project(NodeConstraint& constraint, NodeSource& nodes) noexcept;
  void release(std::uint32_t node) noexcept;
  void take_friction(NodeConstraint& constraint, const Place& place) const noexcept;
  void load_contact(ByteReader& in);

  Vector<Tool> tools_;
  Vector<Wall> walls_;
  Vector<Attachment> attachments_;
  Vector<Bounds> bounds_;   // of the tools
  Vector<Motion> motions_;  // of the tools, then the attachments
  Vector<Vec3> anchors_;    // of attached nodes in their frames, one attachment behind the other
  ContactRule rule_;
  SurfaceSamples surface_;
  ReservedVector<NodeConstraint> constraints_, previous_;
  ReservedVector<Place> places_, previous_places_;
  ReservedVector<std::uint32_t> roused_;
  Vector<Use> uses_;               // of each node
  Vector<std::uint32_t> held_at_;  // index of its constraint, of each held node
  Vector<std::uint32_t> hints_;    // of each node, for SolidModel::find_inside
};

}  // namespace crumble
