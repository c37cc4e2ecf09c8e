// The solver in one precision.
#pragma once

#include <memory>

#include "crumble/base/memory.hpp"
#include "crumble/network/solver.hpp"
#include "network/aligned_vector.hpp"
#include "network/kernels.hpp"
#include "network/layout.hpp"
#include "network/rigid_frames.hpp"

namespace crumble {

/// x, y and z by slot, with room behind for whole vectors.
template <class Real>
class SlotArray {
 public:
  SlotArray() = default;
  explicit SlotArray(std::size_t size) : stride_((size + 15) / 16 * 16), data_(3 * stride_) {}
  bool empty() const { return data_.empty(); }
  std::size_t size() const { return stride_; }
  Triple<Real> from(std::size_t i = 0) { return {data_.data() + i, stride_}; }
  Triple<const Real> from(std::size_t i = 0) const { return {data_.data() + i, stride_}; }
  std::span<Real> axis(std::size_t a) { return {data_.data() + a * stride_, stride_}; }
  std::span<const Real> axis(std::size_t a) const { return {data_.data() + a * stride_, stride_}; }
  Vec3 get(std::size_t i) const { return {double{axis(0)[i]}, double{axis(1)[i]}, double{axis(2)[i]}}; }
  void set(std::size_t i, const Vec3& v) {
    for (std::size_t a = 0; a < 3; ++a) axis(a)[i] = static_cast<Real>(v[static_cast<int>(a)]);
  }

 private:
  std::size_t stride_ = 0;
  AlignedVector<Real> data_;
};

template <class Real>
class Engine final : public NetworkSolver {
 public:
  Engine(const SpringNetwork& network, const StepCoefficients& coefficients, std::span<const Vec3> rest_positions,
         const SolverSettings& settings);
  std::unique_ptr<NetworkSolver> clone() const override { return std::make_unique<Engine>(*this); }
  void reset() noexcept override;

  std::size_t node_count() const noexcept override { return layout_->node_of.size(); }
  Vec3 position(std::uint32_t node) const noexcept override;
  Vec3 velocity(std::uint32_t node) const noexcept override;
  void place(std::uint32_t node, const Vec3& position, const Vec3& velocity) noexcept override;
  std::span<const std::uint32_t> inside(const Vec3& low, const Vec3& high) noexcept override;
  std::span<const std::uint32_t> behind(const Plane& plane) noexcept override;

  void redefine(NetworkSolver& next) noexcept override;
  void set_external(VecView forces) noexcept override;
  void push(std::uint32_t node, const Vec3& force) noexcept override;
  void set_loose(const NodeGroups& groups) noexcept override;
  void set_share(std::uint32_t spring, double share) noexcept override;
  void set_frozen(std::uint32_t node, bool frozen) noexcept override;
  void solve(std::span<NodeConstraint> constraints) noexcept override;
  double holder_work() const noexcept override { return holder_work_; }
  std::span<const std::uint32_t> overlong() const noexcept override { return {overlong_.data(), overlong_count_}; }
  void find_overlong(double length_limit) noexcept override;
  std::optional<std::uint32_t> lost_node() const noexcept override;

  void read_forces(VecSpan forces) const override;
  void read_positions(std::uint32_t first, VecSpan positions) const noexcept override;
  void read_velocities(VecSpan velocities) const noexcept override;
  void read_nodes(std::span<const std::uint32_t> nodes, VecSpan positions, VecSpan velocities) const noexcept override;
  void add_to(Hash& hash) const noexcept override;
  void save(ByteWriter& out) const override;
  void load(ByteReader& in) override;
  LayoutReport layout() const noexcept override;
  const char* kernel() const noexcept override { return kernels_->name; }

 private:
  struct Held {
    Vec3 position, velocity;
    Vec3 unreported = Vec3::Zero();  // friction that a reaction does not hold, N
  };
  static constexpr bool kHasRest = sizeof(Real) == 4;

  /// Eqs (3) and (4), by slot; all 0 for a node that does not move.
  struct Gains {
    AlignedVector<Real> drift, force, decay, velocity;
  };

  // what never changes, shared by copies
  struct Fixed {
    Vector<Edge> springs;                      // node numbers
    Vector<double> stiffnesses, rest_lengths;  // by spring
    Vector<Vec3> rest_positions;               // by slot
    StepCoefficients coefficients;             // by node
    Vector<double> masses;                     // by node
    double spring_damping = 0;                 // N s/m
    Vector<double> damped;                     // by node: e^(-spring_damping tau / m), 1 for fixed ones
    Gains gains;
    Vector<Way<Real>> ways;
    Vector<std::uint8_t> present;  // by block of lanes
    Vector<std::uint8_t> plain;    // by way, of the unbroken body
    Vector<std::uint32_t> way_of_block;
    Real cut_share = 0;
    Real give = 0;  // 1 - 1 / l_p
  };
  static std::shared_ptr<const Fixed> make_fixed(const SpringNetwork& network, const StepCoefficients& coefficients,
                                                 std::span<const Vec3> rest_positions, const SolverSettings& settings,
                                                 const Layout& layout);
  static void set_ways(const SpringNetwork& network, const Layout& layout, Fixed& fixed);

  Vec3 load(std::size_t slot) const noexcept;
  void store(std::size_t slot, const Vec3& position, const Vec3& velocity) noexcept;
  void mend() noexcept;
  void start_forces() noexcept;
  void refresh() noexcept;
  void widen(std::size_t slot) noexcept;
  void place_slot(std::uint32_t slot, const Vec3& position, const Vec3& velocity) noexcept;
  std::span<const std::uint32_t> nodes_of_found(std::size_t count) noexcept;

  void in_partitions(void (Engine::*task)(std::uint32_t) noexcept) noexcept;
  void sum_forces(std::uint32_t partition) noexcept;
  void join_forces(std::uint32_t partition) noexcept;
  void move(std::uint32_t partition) noexcept;
  void join_and_move(std::uint32_t partition) noexcept;
  std::uint32_t partition_of(std::uint32_t slot) const noexcept;
  void hold(NodeConstraint& held, Held& next) noexcept;
  void hold_loose(NodeConstraint& held, const Vec3& force, Held& next) noexcept;
  bool is_loose(std::uint32_t node) const noexcept { return frames_.place_of(node) != RigidFrames::kNoPlace; }
  void damp_springs(std::span<const NodeConstraint> constraints) noexcept;
  void read_frames() noexcept;
  void find_frames() noexcept;
  void keep_in_world() noexcept;
  void enter_frames() noexcept;
  void leave_frames() noexcept;
  void slide_along(const NodeConstraint& held, Held& next) noexcept;
  Vec3 force_at(std::uint32_t slot) const noexcept;
  std::size_t first_overlong(std::uint32_t partition) const noexcept;
  void collect_overlong() noexcept;

  std::shared_ptr<const Layout> layout_;
  std::shared_ptr<const Fixed> fixed_;
  const KernelSet* kernels_;
  std::shared_ptr<Team> team_;

  SlotArray<Real> at_, rest_of_at_, velocity_, external_;
  SlotArray<Real> force_;                       // partitions shifted apart by their halos
  Gains gains_;                                 // now: frozen nodes have none
  AlignedVector<Real> packed_, packed_force_;   // x y z 0 by slot; forces shifted as above
  AlignedVector<Real> stiffness_, rest_force_;  // by lane
  Vector<std::uint8_t> whole_;                  // by lane, see ForcePass
  Vector<std::uint8_t> plain_;                  // by way, see ForcePass
  Vector<Bounds<Real>> bounds_;                 // by block
  Vector<std::uint32_t> found_;                 // of the last search: slots, then nodes
  Vector<std::uint32_t> overlong_;              // lanes by partition, then springs
  Vector<std::size_t> overlong_of_;             // count by partition
  std::size_t overlong_count_ = 0;
  Vector<std::uint32_t> lost_of_;  // by partition
  Vector<Held> held_;
  RigidFrames frames_;
  Vector<std::uint32_t> loose_slots_, loose_forces_;  // by place: slot, and where its force is
  double holder_work_ = 0;
  Vector<std::uint8_t> is_held_;           // by node, for damp_springs()
  std::uint32_t lost_from_frame_ = kNone;  // slot
};

}  // namespace crumble
