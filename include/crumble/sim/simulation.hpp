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
#include "crumble/fracture/fragments.hpp"
#include "crumble/network/energy.hpp"
#include "crumble/network/solver.hpp"
#include "crumble/sim/definition.hpp"

namespace crumble {

/// What the body does to a tool: force in N, torque in N m about the tool's origin, in scene axes.
struct Wrench {
  Vec3 force = Vec3::Zero();
  Vec3 torque = Vec3::Zero();
};

/// What the last step did. The force is valid whatever the flags say.
enum StepFlag : std::uint32_t {
  kToolJumped = 1u << 0,        // a tool moved more than 8 half thicknesses: its contact is suspended
  kContactSuspended = 1u << 1,  // a tool that jumped, or began inside the body, has not been outside since
  kGuarded = 1u << 2,           // the guard raised the drag of some nodes (see Counters::guarded_nodes)
};
struct StepInfo {
  Code status{};               // 0; bad_pose: nothing moved, force 0; diverged: frozen until reset
  std::uint32_t flags = 0;     // StepFlag bits
  std::uint64_t step = 0;      // steps done since the start
  double time = 0;             // simulated seconds
  std::uint32_t contacts = 0;  // nodes that tools hold
  std::uint32_t new_cuts = 0;  // springs cut in this step
  std::uint32_t bad_node = 0;  // with status diverged: the first node that left the world
};

/// Wall seconds that the stages of the last step took; same names and order as in step.cpp.
struct StepProfile {
  double move_tool = 0;
  double find_contacts = 0;
  double project_contacts = 0;
  double solve_network = 0;
  double cut_springs = 0;
  double sum_reaction = 0;
  double finish_step = 0;
};

/// Sums since the start: what was guarded, clamped, suspended or refused.
struct Counters {
  std::uint64_t guarded_nodes = 0;  // nodes with drag raised by the guard (a property of the body and tau)
  std::uint64_t cuts = 0;           // springs cut
  std::uint64_t tool_jumps = 0;
  std::uint64_t suspended_steps = 0;  // steps in which some tool's contact was suspended
  std::uint64_t bad_poses = 0;        // steps refused for a pose that is not finite or not a rotation
};

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
  const TetMesh& mesh() const noexcept { return def_.mesh; }
  const SpringNetwork& network() const noexcept { return network_; }
  const StepCoefficients& coefficients() const noexcept { return coefficients_; }
  /// How the network was laid out for the solver, and the kernel in use.
  LayoutReport layout() const noexcept { return solver_->layout(); }
  const char* kernel() const noexcept { return solver_->kernel(); }
  /// By node, metres and m/s. The first call after a step fetches them all from the solver; valid until the next step.
  VecView positions() const noexcept;
  VecView velocities() const noexcept;
  /// Springs + gravity at the present positions, N. Works them out: not for the servo loop; allocates.
  VecArray forces() const;
  std::span<const std::uint8_t> intact() const noexcept { return intact_; }
  /// Springs cut by the last step, ascending.
  std::span<const std::uint32_t> new_cuts() const noexcept { return {new_cuts_.data(), info_.new_cuts}; }

  /// Back to rest and unbroken; also clears a latched fault.
  void reset() noexcept;

  /// All that the future depends on. A snapshot fits simulations of the same definition only; restoring throws
  /// Error(corrupt, version) and then changes nothing.
  std::vector<std::uint8_t> snapshot() const;
  void restore(std::span<const std::uint8_t> bytes);
  /// Hash of positions, velocities, cuts, contacts and wrenches: equal bits, equal hash.
  std::uint64_t state_hash() const noexcept;

 private:
  struct Fading {
    std::uint32_t spring, substeps_left;
  };

  bool accept(std::span<const Pose> poses) noexcept;
  void begin_step() noexcept;
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

  std::vector<Wrench> wrenches_;
  std::vector<std::array<Wrench, 5>> history_;  // of Eq (7), newest at step % 5
  StepInfo info_;
  StepProfile profile_;
  Counters counters_;
  EnergyLedger ledger_;
};

}  // namespace crumble
