// Which balls take part, which two of them may touch, and which could already in the step before.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "crumble/base/bytes.hpp"
#include "crumble/base/hash.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/reserved_vector.hpp"
#include "crumble/contact/ball_contacts.hpp"
#include "crumble/tetmesh/spring_graph.hpp"

namespace crumble {

class BallRoster {
 public:
  static constexpr std::uint32_t kRemoved = 0xffffffffu;

  explicit BallRoster(const BallSetup& setup);

  void update(std::span<const std::uint32_t> cuts, std::span<const std::uint32_t> labels,
              std::span<const BallFragment> fragments) noexcept;
  /// Since the last settle() somebody came, went or changed sides.
  bool changed() const noexcept { return changed_; }
  /// What is now becomes what was before.
  void settle() noexcept;

  std::span<const std::uint32_t> nodes() const noexcept { return nodes_; }
  std::uint32_t fragment_of(std::uint32_t node) const noexcept { return labels_[node]; }
  const BallFragment& fragment(std::uint32_t id) const noexcept { return fragments_[id]; }
  std::span<const BallFragment> fragments() const noexcept { return fragments_; }
  bool moves(std::uint32_t node) const noexcept { return !fixed_[node] && !fragments_[labels_[node]].asleep; }

  /// Of two in nodes().
  bool may_touch(std::uint32_t a, std::uint32_t b) const noexcept {
    if (labels_[a] != labels_[b]) return true;
    return exposures_[a] != kCovered && exposures_[b] != kCovered && joint(a, b) != kIntact;
  }
  /// Two such in one fragment never touch.
  bool is_covered(std::uint32_t node) const noexcept { return exposures_[node] == kCovered; }
  /// At the last settle().
  bool could_touch(std::uint32_t a, std::uint32_t b) const noexcept;

  void reset() noexcept;
  /// Which nodes are fixed: as in `next`.
  void redefine(BallRoster& next) noexcept { fixed_.swap(next.fixed_); }
  void save(ByteWriter& out) const;
  void load(ByteReader& in);
  void add_to(Hash& hash) const noexcept;

 private:
  enum Exposure : std::uint8_t { kCovered = 0, kFresh = 1, kExposed = 2 };  // fresh: since the last settle()
  enum Joint : std::uint8_t { kIntact = 0, kFreshCut = 1, kCut = 2 };       // kCut: also where no spring ever was

  Joint joint(std::uint32_t a, std::uint32_t b) const noexcept;
  void cut(std::uint32_t spring) noexcept;
  void expose(std::uint32_t node) noexcept;
  void admit_newcomers() noexcept;
  void gather_nodes() noexcept;
  void load_joints(ByteReader& in);

  std::shared_ptr<const SpringGraph> graph_;  // immutable, as are the next two
  Vector<std::uint8_t> on_surface_, fixed_;

  // State. Labels are those of members.
  Vector<Joint> joints_;  // (spring_count)
  Vector<std::uint32_t> labels_, labels_before_;
  ReservedVector<BallFragment> fragments_;

  // What follows from it.
  ReservedVector<std::uint32_t> members_;  // on the surface or exposed, ascending
  ReservedVector<std::uint32_t> newcomers_;
  ReservedVector<std::uint32_t> fresh_cuts_;
  Vector<Exposure> exposures_;
  ReservedVector<std::uint32_t> nodes_;
  bool changed_ = false;
};

}  // namespace crumble
