// Fragments against each other, and the two lips of a crack: each node is a ball.
//
// A ball takes part once its node has lost a spring; those of the original surface do as soon as there is more than one
// fragment. Two balls may touch when they lie in different fragments, or when both nodes have lost springs and none
// joins the two any more. They push each other from the pair's contact distance inward: the sum of the radii, or the
// distance at which the two were when they first could touch, if that was less. It grows as they part and never
// shrinks, so a cut gives no kick. Forces: src/contact/ball_forces.cpp.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "crumble/base/bytes.hpp"
#include "crumble/base/hash.hpp"
#include "crumble/base/vec_array.hpp"
#include "crumble/contact/tool.hpp"
#include "crumble/tetmesh/tet_mesh.hpp"

namespace crumble {

/// All is copied.
struct BallSetup {
  std::span<const Edge> springs;
  std::span<const double> radii;                    // of the balls, metres; > 0 (node_count)
  std::span<const double> masses;                   // m_i, kg; > 0 (node_count)
  std::span<const double> stiffnesses;              // N/m: a pair has the mean of its two at most; >= 0 (node_count)
  std::span<const double> stiffness_sums;           // D_i of the unbroken body, N/m; >= 0 (node_count)
  std::span<const std::uint8_t> on_surface, fixed;  // 1: of the unbroken body; never moves (node_count)
  Friction friction;
  double tau = 0;  // from one find() to the next, seconds
};

/// What contact has to know of a fragment.
struct BallFragment {
  double mass = 0;  // kg; infinite with a fixed node in it, 0 once it is removed
  bool asleep = false;
};

/// Two balls that touch.
struct BallContact {
  std::uint32_t first, second;  // nodes, first < second
  Vec3 normal;                  // unit, from the second to the first
  Vec3 force;                   // on the first, N; the second gets the opposite
};

/// One thread at a time. After construction nothing allocates but save(), load() and copying; copies are independent.
class BallContacts {
 public:
  /// Throws Error naming the field: out_of_range, invalid_value, too_large.
  explicit BallContacts(const BallSetup& setup);
  ~BallContacts();
  BallContacts(const BallContacts& other);
  BallContacts(BallContacts&&) noexcept;
  BallContacts& operator=(const BallContacts& other);
  BallContacts& operator=(BallContacts&&) noexcept;

  /// At the beginning, after a step that cut springs, and when a fragment split, was removed, fell asleep or woke: the
  /// springs cut since the last call, the fragment of each node (node_count; 0xffffffff where removed), and all
  /// fragments by id. Reads no label of a node that takes no part.
  void update(std::span<const std::uint32_t> cuts, std::span<const std::uint32_t> labels,
              std::span<const BallFragment> fragments) noexcept;

  /// Nodes that take part, ascending; none while the body is whole. Changed by update(), load() and reset() only.
  std::span<const std::uint32_t> nodes() const noexcept;
  /// Works out who touches whom, and the forces for this step. Positions in metres and velocities in m/s of nodes(), in
  /// that order. Exactly once in every tau: friction remembers.
  void find(const VecView& positions, const VecView& velocities) noexcept;

  /// Pairs that touched in the last find(), ascending by nodes; none after load().
  std::size_t contact_count() const noexcept;
  BallContact contact(std::size_t index) const noexcept;
  /// Nodes that can move and are touched, each once, and the force on each, N.
  std::span<const std::uint32_t> pushed() const noexcept;
  std::span<const Vec3> forces() const noexcept;
  /// Sleeping fragments that were hit at more than kRouseSpeed, each once.
  std::span<const std::uint32_t> roused() const noexcept;
  /// Pairs within reach that there was no room for: they pass through each other.
  std::size_t dropped_pairs() const noexcept;

  /// How often the neighbors of all were searched for since construction: for measurements, not part of the state.
  std::uint64_t searches() const noexcept;

  /// Back to the whole body; to be followed by update().
  void reset() noexcept;
  /// Masses, stiffnesses, friction and time step of `next`, for the same nodes and springs; who takes part and who
  /// touches whom stays. Allocates nothing; update() has to follow.
  void redefine(BallContacts& next) noexcept;

  /// load() throws Error(corrupt) for what save() cannot have written for this body, and then changes nothing.
  void save(ByteWriter& out) const;
  void load(ByteReader& in);
  void add_to(Hash& hash) const noexcept;

  static constexpr double kRouseSpeed = 0.01;          // m/s
  static constexpr std::size_t kPairsPerNode = 16;     // room for so many within reach
  static constexpr std::size_t kMostPairs = 1u << 17;  // and never for more: they would take half a millisecond a step

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace crumble
