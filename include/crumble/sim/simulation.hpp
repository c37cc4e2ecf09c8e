// The simulation: one body, its tools, and the step that the servo loop calls.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "crumble/base/cloned.hpp"
#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/reserved_vector.hpp"
#include "crumble/contact/ball_contacts.hpp"
#include "crumble/contact/contacts.hpp"
#include "crumble/fracture/fragment_tracker.hpp"
#include "crumble/network/energy.hpp"
#include "crumble/network/solver.hpp"
#include "crumble/sim/debris.hpp"
#include "crumble/sim/definition.hpp"
#include "crumble/sim/event_log.hpp"
#include "crumble/sim/local_model.hpp"
#include "crumble/sim/step_info.hpp"

namespace crumble {

/// Told of each step of several, with its poses.
struct AfterStep {
  void (*call)(std::span<const Pose> poses, void* context) = nullptr;
  void* context = nullptr;
};

/// One thread at a time may use a simulation. Set-up throws Error; step() never throws, allocates, locks or calls the
/// system, and gives the same bits in every build.
class Simulation {
 public:
  explicit Simulation(SimulationDef def);

  /// One servo tick (paper, section 2.6): the tools go to `poses` (one for each tool, then one for
  /// each attachment) and the body answers. A bad pose
  /// leaves body and time as they are and makes all wrenches zero.
  const StepInfo& step(std::span<const Pose> poses) noexcept;

  /// `steps` steps in which the tools go evenly from where they are to `poses`, for hosts whose frames are longer than
  /// a step. `wrenches` (by holder, or empty) receives their mean: times the time advanced, the impulse on each tool.
  /// Steps are whole or not at all: at least one is done, and another one only while it can be expected to end within
  /// `budget` seconds of wall time (0: no limit); tools stay where the last one brought them. `after_step` is told of
  /// each with its poses, for readers and recordings. A bad pose or a diverged body ends it: see info().
  AdvanceReport advance(std::span<const Pose> poses, std::uint32_t steps, double budget,
                        std::span<Wrench> wrenches = {}, const AfterStep& after_step = {}) noexcept;

  const StepInfo& info() const noexcept { return info_; }
  const StepProfile& profile() const noexcept { return profile_; }
  const Counters& counters() const noexcept { return counters_; }
  const EnergyLedger& ledger() const noexcept { return ledger_; }

  /// What the body does to a tool (Eq 6; Eq 7's mean when asked for).
  const Wrench& wrench(std::size_t holder) const noexcept { return wrenches_[holder]; }
  /// Where fragments and the lips of cracks touch: as many as there are, by index.
  std::size_t ball_contact_count() const noexcept { return balls_ ? balls_->contact_count() : 0; }
  BallContact ball_contact(std::size_t index) const noexcept { return balls_->contact(index); }
  /// Nodes held now: place, normal, state and the force on each.
  std::span<const NodeConstraint> contacts() const noexcept { return contacts_.constraints(); }

  /// A suspended tool lets go of the body and goes through it without touching; afterwards it touches again once it has
  /// been outside. For a hand that must not feel anything now. Between steps; part of the state, so a recording has to
  /// know of it. Attachments hold on.
  void suspend_contact(std::size_t tool, bool suspended) noexcept { contacts_.suspend(tool, suspended); }
  /// False while suspended, and from then, from a jump or a start inside the body on until the tool has been outside
  /// once; of an attachment, until it is placed.
  bool engaged(std::size_t holder) const noexcept { return contacts_.engaged(holder); }

  /// What the body does to a tool or attachment near where it is now; works it out, some microseconds. No allocation.
  LocalModel local_model(std::size_t tool) const noexcept;
  /// Drag of the nodes that a tool or attachment holds, sum of c_i, N s/m. It is in no force that a hand gets.
  double held_drag(std::size_t tool) const noexcept;

  /// Forces on the nodes from the host, N, beside their weight: kept until changed, 0 after reset(). Part of the state,
  /// so a recording has to know of them. Both take time in proportion to the body; no allocation unless they throw.
  /// Throws Error and changes nothing: out_of_range (count, node, 1e12 N along an axis), invalid_value (not finite); of
  /// the first such node.
  void set_node_forces(VecView forces);
  void set_node_force(std::uint32_t node, const Vec3& force);
  VecView node_forces() const noexcept { return node_forces_; }

  const SimulationDef& definition() const noexcept { return def_; }
  /// Tools and attachments: as many poses as a step takes.
  std::size_t holder_count() const noexcept { return def_.tools.size() + def_.attachments.size(); }
  /// May be borrowed, by other threads too: nothing touches it until the simulation is moved, assigned to or destroyed.
  const TetMesh& mesh() const noexcept { return def_.mesh; }
  const SpringNetwork& network() const noexcept { return network_; }
  const StepCoefficients& coefficients() const noexcept { return coefficients_; }
  /// How the network was laid out for the solver, and the kernel in use.
  LayoutReport layout() const noexcept { return solver_->layout(); }
  const char* kernel() const noexcept { return solver_->kernel(); }
  /// By node, metres and m/s. The first call after a step fetches them all from the solver; valid until the next step.
  VecView positions() const noexcept;
  VecView velocities() const noexcept;
  /// Positions of nodes first, first + 1, ... as many as there is room for, straight from the solver.
  void read_positions(std::uint32_t first, VecSpan positions) const noexcept {
    solver_->read_positions(first, positions);
  }
  /// Springs, gravity and node forces at the present positions, N. Works them out: not for the servo loop; allocates.
  VecArray forces() const;
  std::span<const std::uint8_t> intact() const noexcept { return intact_; }
  /// Springs cut by the last step, ascending.
  std::span<const std::uint32_t> new_cuts() const noexcept { return {new_cuts_.data(), info_.new_cuts}; }

  /// Stable ids, nodes and parents of the fragments; kNoFragment for nodes of removed ones.
  const FragmentTracker& fragments() const noexcept { return fragments_; }
  /// By id.
  std::span<const FragmentState> fragment_states() const noexcept {
    return {fragment_states_.data(), fragments_.count()};
  }
  std::span<const std::uint32_t> node_fragments() const noexcept { return fragments_.labels(); }
  /// What happened in the last step: cuts, then splits, then contacts.
  std::span<const Event> events() const noexcept { return event_log_.events(); }
  static constexpr std::size_t kMaxEvents = 65536;  // of one step

  /// Throws Error(out_of_range): no such fragment.
  FragmentState fragment_state(std::uint32_t fragment) const;
  /// Between steps; part of the state, so a recording has to know of it. Scans all nodes; no allocation. Throws Error:
  /// out_of_range (no such fragment), state (it has been removed).
  void set_fragment_state(std::uint32_t fragment, FragmentState state);
  /// Fragments, not removed, with at most max_nodes nodes that are all slower than max_speed and not held by a tool,
  /// ascending; valid until the next call. No allocation.
  std::span<const std::uint32_t> find_debris(const DebrisRule& rule) noexcept;

  /// Back to rest and unbroken; also clears a latched fault.
  void reset() noexcept;

  /// All that the future depends on. A snapshot fits simulations of the same definition only; restoring throws
  /// Error(corrupt, version) and then changes nothing.
  Vector<std::uint8_t> snapshot() const;
  void restore(std::span<const std::uint8_t> bytes);
  /// Hash of positions, velocities, cuts, contacts, wrenches and fragments: equal bits, equal hash.
  std::uint64_t state_hash() const noexcept;

 private:
  friend class DefinitionChange;
  struct Fading {
    std::uint32_t spring, substeps_left;
  };

  bool accept(std::span<const Pose> poses) noexcept;
  void begin_step() noexcept;
  double end_of_step() const noexcept;
  void move_tools(std::span<const Pose> poses, std::uint32_t substep) noexcept;
  void solve_network() noexcept;
  void cut_springs() noexcept;
  void fade_cut_springs() noexcept;
  void fade(Fading& fading) noexcept;
  void drop_faded() noexcept;
  void sum_reaction() noexcept;
  void finish_step() noexcept;
  void audit_projection() noexcept;
  void audit_before_solve() noexcept;
  void audit_overlong() noexcept;
  void audit_solve() noexcept;
  void audit_cut() noexcept;
  double stored_energy() const noexcept;
  void load_fading(ByteReader& in);
  bool find_divergence() noexcept;
  void track_fragments() noexcept;
  std::optional<BallContacts> make_balls() const;
  std::span<const BallFragment> ball_fragments() const noexcept;
  void regroup(std::uint64_t now, std::span<const std::uint32_t> cuts) noexcept;
  void find_loose_fragments(std::uint64_t now) noexcept;
  void find_leaders(std::uint64_t now) noexcept;
  std::uint64_t last_step() const noexcept { return info_.step > 0 ? info_.step - 1 : 0; }
  void touch_fragments() noexcept;
  void wake_roused() noexcept;
  void wake(std::uint32_t fragment) noexcept;
  void put_to_sleep(std::uint32_t fragment) noexcept;
  void remove(std::uint32_t fragment) noexcept;
  void let_sleep(std::uint32_t node) noexcept;
  void take_away(std::uint32_t node) noexcept;
  void load_fragments(ByteReader& in);
  void take_state(Simulation& from) noexcept;
  void adopt(Simulation& next, std::span<const std::uint8_t> moved_tools, bool moved_walls) noexcept;
  void swap_definition(Simulation& next) noexcept;
  void renew_shares() noexcept;
  void renew_fragment_states() noexcept;
  std::span<const std::uint32_t> list_cuts(std::span<std::uint32_t> room) const noexcept;
  void log_cut(std::uint32_t spring) noexcept;
  void log_contacts() noexcept;
  void set_share(std::uint32_t spring, double share) noexcept;
  void add_to_model(LocalModel& model, const NodeConstraint& contact) const noexcept;
  LocalContact springs_of_contact(const NodeConstraint& contact) const noexcept;
  bool has_node_forces() const noexcept;
  void clear_node_forces() noexcept;
  void apply_node_forces() noexcept;
  void load_node_forces(ByteReader& in);
  void forget_copies() noexcept { positions_known_ = velocities_known_ = false; }

  SimulationDef def_;
  SpringNetwork network_;
  StepCoefficients coefficients_;
  std::uint64_t layout_hash_;
  double reference_energy_;

  std::uint32_t fade_substeps_;   // in which a cut spring still pulls, after the one that cut it
  Cloned<NetworkSolver> solver_;  // holds the state of nodes and springs
  Contacts contacts_;
  std::optional<BallContacts> balls_;
  VecArray ball_positions_, ball_velocities_;  // of balls_->nodes()
  Vector<BallFragment> ball_fragments_;        // by id
  Vector<double> stiffnesses_;                 // in force now, N/m: fading to 0 once a spring is cut (spring_count)
  VecArray node_forces_;                       // from the host, N
  VecArray external_;                          // weight + node force of each node, N
  Vector<std::uint8_t> intact_;                // 1 intact, 0 cut (spring_count)
  Vector<std::uint32_t> new_cuts_;
  ReservedVector<Fading> fading_;            // cut springs that still pull, oldest first
  Vector<Pose> start_poses_;                 // of the tools, at the start of the step
  Vector<Pose> advance_from_, advance_to_;   // of the tools, in advance()
  mutable VecArray positions_, velocities_;  // copies by node
  mutable bool positions_known_ = false, velocities_known_ = false;
  mutable Vector<std::uint32_t> marks_;  // room to work (node_count), 0
  VecArray before_solve_;                // positions, for the audit
  double kinetic_before_solve_ = 0;

  FragmentTracker fragments_;
  Vector<FragmentState> fragment_states_;  // by id (node_count: there are never more)
  std::uint64_t regroup_at_ = 0;           // step in which a fragment stops following its parent
  Vector<std::uint32_t> loose_first_, loose_nodes_, loose_group_of_;  // of find_loose_fragments
  Vector<std::uint8_t> is_debris_;                                    // by id, of find_debris
  ReservedVector<std::uint32_t> debris_;

  EventLog event_log_;
  Vector<Wrench> wrenches_;
  Vector<std::array<Wrench, 5>> history_;  // of Eq (7), newest at step % 5
  StepInfo info_;
  StepProfile profile_;
  Counters counters_;
  EnergyLedger ledger_;
};

}  // namespace crumble
