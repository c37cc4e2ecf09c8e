// The simulation: one body, its tools, and the step that the servo loop calls.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "crumble/base/cloned.hpp"
#include "crumble/base/error.hpp"
#include "crumble/base/reserved_vector.hpp"
#include "crumble/contact/contacts.hpp"
#include "crumble/fracture/fragment_tracker.hpp"
#include "crumble/network/energy.hpp"
#include "crumble/network/solver.hpp"
#include "crumble/sim/debris.hpp"
#include "crumble/sim/definition.hpp"
#include "crumble/sim/event_log.hpp"
#include "crumble/sim/step_info.hpp"

namespace crumble {

/// One thread at a time may use a simulation. Set-up throws Error; step() never throws, allocates, locks or calls the
/// system, and gives the same bits in every build.
class Simulation {
 public:
  explicit Simulation(SimulationDef def);

  /// One servo tick (paper, section 2.6): the tools go to `poses` (one per tool) and the body answers. A bad pose
  /// leaves body and time as they are and makes all wrenches zero.
  const StepInfo& step(std::span<const Pose> poses) noexcept;

  const StepInfo& info() const noexcept { return info_; }
  const StepProfile& profile() const noexcept { return profile_; }
  const Counters& counters() const noexcept { return counters_; }
  const EnergyLedger& ledger() const noexcept { return ledger_; }

  /// What the body does to a tool (Eq 6; Eq 7's mean when asked for).
  const Wrench& wrench(std::size_t tool) const noexcept { return wrenches_[tool]; }
  /// Nodes held now: place, normal, state and the force on each.
  std::span<const NodeConstraint> contacts() const noexcept { return contacts_.constraints(); }

  const SimulationDef& definition() const noexcept { return def_; }
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
  /// Springs + gravity at the present positions, N. Works them out: not for the servo loop; allocates.
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
  std::vector<std::uint8_t> snapshot() const;
  void restore(std::span<const std::uint8_t> bytes);
  /// Hash of positions, velocities, cuts, contacts, wrenches and fragments: equal bits, equal hash.
  std::uint64_t state_hash() const noexcept;

 private:
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
  void wake_roused() noexcept;
  void wake(std::uint32_t fragment) noexcept;
  void put_to_sleep(std::uint32_t fragment) noexcept;
  void remove(std::uint32_t fragment) noexcept;
  void let_sleep(std::uint32_t node) noexcept;
  void take_away(std::uint32_t node) noexcept;
  void load_fragments(ByteReader& in);
  void take_state(Simulation& from) noexcept;
  void log_cut(std::uint32_t spring) noexcept;
  void log_contacts() noexcept;
  void set_share(std::uint32_t spring, double share) noexcept;
  void forget_copies() noexcept { positions_known_ = velocities_known_ = false; }

  SimulationDef def_;
  SpringNetwork network_;
  StepCoefficients coefficients_;
  std::uint64_t layout_hash_;
  double reference_energy_;

  std::uint32_t fade_substeps_;   // in which a cut spring still pulls, after the one that cut it
  Cloned<NetworkSolver> solver_;  // holds the state of nodes and springs
  Contacts contacts_;
  std::vector<double> stiffnesses_;   // in force now, N/m: fading to 0 once a spring is cut (spring_count)
  VecArray external_;                 // weight of each node, N
  std::vector<std::uint8_t> intact_;  // 1 intact, 0 cut (spring_count)
  std::vector<std::uint32_t> new_cuts_;
  ReservedVector<Fading> fading_;            // cut springs that still pull, oldest first
  std::vector<Pose> start_poses_;            // of the tools, at the start of the step
  mutable VecArray positions_, velocities_;  // copies by node
  mutable bool positions_known_ = false, velocities_known_ = false;
  VecArray before_solve_;  // positions, for the audit
  double kinetic_before_solve_ = 0;

  FragmentTracker fragments_;
  std::vector<FragmentState> fragment_states_;  // by id (node_count: there are never more)
  std::vector<std::uint8_t> is_debris_;         // by id, of find_debris
  ReservedVector<std::uint32_t> debris_;

  EventLog event_log_;
  std::vector<Wrench> wrenches_;
  std::vector<std::array<Wrench, 5>> history_;  // of Eq (7), newest at step % 5
  StepInfo info_;
  StepProfile profile_;
  Counters counters_;
  EnergyLedger ledger_;
};

}  // namespace crumble
