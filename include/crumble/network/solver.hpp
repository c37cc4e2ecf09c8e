// One exponential step of the network: Eqs (5), (3) and (4), with the nodes that a tool holds.
//
// The state lives in here, in the order and precision that the processor likes (docs/performance.md); everything that
// goes in or out speaks of nodes and springs by the mesh's numbers, in doubles and SI units. Every kernel and any
// number of threads give the same bits.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "crumble/base/bytes.hpp"
#include "crumble/base/hash.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/team.hpp"
#include "crumble/base/vec_array.hpp"
#include "crumble/network/coefficients.hpp"
#include "crumble/network/spring_network.hpp"
#include "crumble/tetmesh/node_constraint.hpp"
#include "crumble/tetmesh/node_source.hpp"

namespace crumble {

/// How numbers are held. float32 positions carry a second float with what the first could not hold, so that a creep of
/// less than half a unit in the last place per step does not stall.
enum class Precision : std::uint8_t { float64 = 0, float32 = 1 };

struct SolverSettings {
  Precision precision = Precision::float64;
  std::string kernel;         // one of kernel_names(); empty: $CRUMBLE_KERNEL, else the fastest here
  std::uint32_t threads = 1;  // used when the body is large enough for more than one partition
  ParallelFor host_threads;   // instead of our own, when set
  double length_limit = 0;    // l_p of Eq (8): solve() reports springs longer than this; 0: none
  double cut_share = 0;       // of its force that a spring still has in the solve() that reports it, [0, 1]
};

/// Kernels that this library holds and this processor runs, slowest first. All give the same bits.
Vector<std::string> kernel_names();

/// How a network was laid out for the solver.
struct LayoutReport {
  std::size_t springs_in_segments = 0;  // of spring_count; the others go in batches
  std::size_t lanes = 0;                // places for springs, filled or not: springs / lanes is the lane use
  std::size_t segments = 0, batches = 0;
  std::uint32_t partitions = 1;  // pieces that threads can share
  bool sorted = false;           // nodes were renumbered, since their order was not a good one
};

/// Disjoint groups of nodes: those of group g are nodes[first[g]] to nodes[first[g + 1] - 1].
struct NodeGroups {
  std::span<const std::uint32_t> first;  // of each group, and the end; empty when there is none
  std::span<const std::uint32_t> nodes;
};

class NetworkSolver : public NodeSource, public Allocated {
 public:
  /// At rest, unbroken, without external force. Copies what it needs of its arguments. Throws Error: out_of_range or
  /// invalid_value (a setting), unsupported (a kernel that is not there).
  static std::unique_ptr<NetworkSolver> make(const SpringNetwork& network, const StepCoefficients& coefficients,
                                             std::span<const Vec3> rest_positions, const SolverSettings& settings);
  virtual std::unique_ptr<NetworkSolver> clone() const = 0;
  virtual void reset() noexcept = 0;

  /// Force on each node from outside (gravity), N (node_count).
  virtual void set_external(VecView forces) noexcept = 0;
  /// The spring's stiffness from now on is `share` of its unbroken one: 1 intact, 0 gone, between while it fades.
  virtual void set_share(std::uint32_t spring, double share) noexcept = 0;

  /// Force on one node, N, on top of that, in the next solve() only.
  virtual void push(std::uint32_t node, const Vec3& force) noexcept = 0;
  /// Loose bodies: the drag of their nodes acts on what their motion differs by from that of a rigid body. All others
  /// are braked against the room. No fixed or frozen node may be in a group. Copies.
  virtual void set_loose(const NodeGroups& groups) noexcept = 0;

  /// The coefficients, settings, kernel and threads of `next`, a solver of the same mesh and precision, which gets
  /// these in exchange. Positions and velocities stay; as after load() all springs are whole, no node is frozen and no
  /// body loose. Allocates nothing.
  virtual void redefine(NetworkSolver& next) noexcept = 0;

  /// A frozen node stays where it is, at rest, whatever pulls on it; it must not be held. `place` moves it all the
  /// same.
  virtual void set_frozen(std::uint32_t node, bool frozen) noexcept = 0;

  /// The whole of stage 3: Eq (5), contact filter, Eqs (3) and (4). At most one constraint per node. No allocation.
  /// A spring shorter than the root of the smallest normal number pulls nowhere. A node that would leave the world
  /// (1 km, 1 km/s, not a number) stays, see lost_node().
  virtual void solve(std::span<NodeConstraint> constraints) noexcept = 0;
  /// What the holders of loose bodies' nodes did in the last solve() beyond their reactions, by the drag of these
  /// nodes, J: for the energy ledger.
  virtual double holder_work() const noexcept = 0;
  /// Springs with a share of 1 that solve() found longer than the limit where it began, or find_overlong() where they
  /// are now, ascending.
  virtual std::span<const std::uint32_t> overlong() const noexcept = 0;
  /// Looks for springs longer than l_p = `length_limit` times their rest length at the present positions.
  virtual void find_overlong(double length_limit) noexcept = 0;
  virtual std::optional<std::uint32_t> lost_node() const noexcept = 0;

  /// Springs + external at the present positions, N (node_count); springs that are too long with cut_share. Works them
  /// out: not for the servo loop.
  virtual void read_forces(VecSpan forces) const = 0;
  /// Of nodes first, first + 1, ... as many as there is room for.
  virtual void read_positions(std::uint32_t first, VecSpan positions) const noexcept = 0;
  virtual void read_velocities(VecSpan velocities) const noexcept = 0;
  /// Both, of the nodes named.
  virtual void read_nodes(std::span<const std::uint32_t> nodes, VecSpan positions,
                          VecSpan velocities) const noexcept = 0;

  /// All bits of positions and velocities; load() also mends all springs, frees frozen nodes and knows no loose bodies.
  /// Throws Error(corrupt).
  virtual void add_to(Hash& hash) const noexcept = 0;
  virtual void save(ByteWriter& out) const = 0;
  virtual void load(ByteReader& in) = 0;

  virtual LayoutReport layout() const noexcept = 0;
  virtual const char* kernel() const noexcept = 0;
};

/// Coulomb's answer for each held node, from the force on it (forces[k] belongs to constraints[k]): released when the
/// body pulls away, stick, or slip; an attached node is never released. Writes each constraint's state and reaction. A
/// fresh or sticking node starts to slip above static_friction times the normal force; a slipping one goes on until
/// dynamic friction holds it.
void filter_contact(NodeConstraint& constraint, const Vec3& force) noexcept;

}  // namespace crumble
