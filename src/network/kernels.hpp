// The loops that a step spends its time in, each written twice: kernels_scalar.cpp says what is computed, in the order
// that counts; kernels_simd.cpp computes the same for 4 to 16 lanes at a time, for every instruction set from one
// source. Root and division are correctly rounded, nothing is fused, and no sum depends on the width, so all kernels
// give the same bits (tests/network/kernels_test.cpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

#include "network/layout.hpp"

namespace crumble {

inline constexpr std::uint32_t kBlockSlots = 64;  // nodes that share one bounding box

template <class Real>
struct Bounds {
  Real low[3], high[3];
};

/// x, y and z of one quantity, by slot: x first, y `stride` numbers behind, z behind y. (Three pointers would take
/// three of the processor's few registers.)
template <class Real>
struct Triple {
  Real* x;
  std::size_t stride;
  Real* axis(std::size_t a) const { return x + a * stride; }
  Real& at(std::size_t slot, std::size_t a) const { return x[slot + a * stride]; }
};

/// Springs below this squared length pull nowhere.
template <class Real>
inline constexpr Real kLeastSquare = std::numeric_limits<Real>::min();

/// Velocities that only matter as slow denormal arithmetic become 0: there is no flush-to-zero mode to rely on
/// everywhere. A decay (e^-gamma) below the other bound is taken as 0, so that no product with it is denormal either.
template <class Real>
inline constexpr Real kLeastVelocity = sizeof(Real) == 4 ? Real(1e-30) : Real(1e-100);
template <class Real>
inline constexpr Real kLeastDecay = sizeof(Real) == 4 ? Real(1e-8) : Real(1e-200);

/// Coordinates (m) and velocities (m/s) beyond this are out of the world.
inline constexpr double kWorld = 1e3;

/// In the bulk of a crystal all springs of a way are alike: their k and k l0 are read here and not lane by lane.
/// Until one of them is cut.
template <class Real>
struct Way {
  Real stiffness, rest_force;
};

/// Eq (5) for the springs of one partition. A spring pulls its lower end by (k - k l0 / length) (upper - lower). It is
/// too long when k - k l0 / length > give k, with give = 1 - 1 / l_p; a whole one is then reported, and pulls by
/// cut_share of its force.
template <class Real>
struct ForcePass {
  std::span<const Segment> segments;
  const std::uint32_t* offsets;  // of the ways
  const Way<Real>* ways;
  const std::uint8_t* plain;    // by way: 1 when all its springs are alike
  const std::uint8_t* present;  // by block of kLanes lanes of the segments: which lanes have a spring
  std::span<const Batch> batches;
  const Real* stiffness;     // k, by lane
  const Real* rest_force;    // k l0, by lane
  std::uint32_t batch_lane;  // of the first of `batches`
  Triple<const Real> at;     // positions
  const Real* at_packed;     // x y z 0 by slot, for batches
  Triple<Real> force;        // added to; shifted to the partition
  Real* force_packed;        // x y z 0, for batches; shifted
  Real give, cut_share;
  const std::uint8_t* whole;  // by lane: 1 when the spring is neither cut nor fading
  std::uint32_t* overlong;    // lanes found are appended
};

/// Eqs (3) and (4) for the slots [first, end) of one partition.
template <class Real>
struct MovePass {
  std::uint32_t first, end;     // multiples of kBlockSlots, but the last end
  Triple<Real> at, rest_of_at;  // positions: high part and, float32 only, low part
  Triple<Real> velocity;
  Triple<Real> force;  // shifted; left as the external force, where the next step's sum begins
  Triple<const Real> external;
  const Real *drift, *force_gain, *decay, *velocity_gain;  // by slot
  Bounds<Real>* bounds;                                    // by block of kBlockSlots: of the new positions
};

/// Nodes with low <= position <= high.
template <class Real>
struct SearchPass {
  std::uint32_t end;  // slots
  Triple<const Real> at;
  const Bounds<Real>* bounds;
  Bounds<Real> box;
  std::uint32_t* found;  // slots, ascending; room for kPadding more than there are nodes
};

template <class Real>
struct Kernel {
  /// Number of lanes appended to overlong.
  std::size_t (*sum_segments)(const ForcePass<Real>&);
  std::size_t (*sum_batches)(const ForcePass<Real>&);
  /// force += packed, which becomes 0, for each group of kLanes slots.
  void (*unpack)(std::span<const std::uint32_t> groups, Real* packed, const Triple<Real>& force);
  /// packed = positions, for each group.
  void (*pack)(std::span<const std::uint32_t> groups, const Triple<const Real>& at, Real* packed);
  /// The first slot that would have left the world and was kept where it was, without velocity; kNone.
  std::uint32_t (*move)(const MovePass<Real>&);
  std::size_t (*search)(const SearchPass<Real>&);
};

/// One per instruction set.
struct KernelSet {
  const char* name;
  Kernel<float> float32;
  Kernel<double> float64;
};
template <class Real>
const Kernel<Real>& kernel_of(const KernelSet& set) {
  if constexpr (sizeof(Real) == 4) {
    return set.float32;
  } else {
    return set.float64;
  }
}

const KernelSet& scalar_kernels();
/// What kernels_simd.cpp holds and this processor runs, slowest first.
std::span<const KernelSet* const> simd_kernels();

/// Throws Error(unsupported) naming those that there are. An empty name: $CRUMBLE_KERNEL, else the fastest.
const KernelSet& find_kernels(std::string_view name);

}  // namespace crumble
