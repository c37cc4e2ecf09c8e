// What stands behind BallContacts: setting up and following the roster in ball_contacts.cpp, the list of pairs in
// ball_list.cpp, the step in ball_step.cpp, snapshots in ball_contacts_state.cpp.
#pragma once

#include <limits>

#include "ball_forces.hpp"
#include "ball_pairs.hpp"
#include "ball_roster.hpp"
#include "ball_search.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/contact/ball_contacts.hpp"

namespace crumble {

class BallContacts::Impl : public Allocated {
 public:
  explicit Impl(const BallSetup& setup);

  void update(std::span<const std::uint32_t> cuts, std::span<const std::uint32_t> labels,
              std::span<const BallFragment> fragments) noexcept;
  void find(const VecView& positions, const VecView& velocities) noexcept;
  void reset() noexcept;
  void redefine(Impl& next) noexcept;
  void save(ByteWriter& out) const;
  void load(ByteReader& in);
  void add_to(Hash& hash) const noexcept;

  std::size_t contact_count() const noexcept { return touching_pairs_.size(); }
  BallContact contact(std::size_t index) const noexcept;

  BallRoster roster;
  BallSearch search;
  ReservedVector<std::uint32_t> pushed, roused;
  ReservedVector<Vec3> forces;
  std::uint64_t searches = 0;

 private:
  static constexpr double kCannotMove = std::numeric_limits<double>::infinity();  // as stiffness: sets no limit

  struct Setting {  // of a node
    double radius, stiffness;
    double stiffness_by_springs, stiffness_by_mass;  // of all its pairs together, at most, N/m
  };

  struct ForceSum {  // padded: two of a processor's words
    double x = 0, y = 0, z = 0, none = 0;
  };

  double least_margin() const noexcept { return 0.25 * largest_radius_; }
  double most_margin() const noexcept { return largest_radius_; }
  void follow_roster() noexcept;
  auto admits() const noexcept {  // two places: for the search
    return [this, nodes = roster.nodes()](std::uint32_t a, std::uint32_t b) {
      return roster.may_touch(nodes[a], nodes[b]);
    };
  }
  void update_list(const VecView& positions, const VecView& velocities) noexcept;
  bool adapt_margin(bool many_strays) noexcept;
  void search_all(const VecView& positions, const VecView& velocities) noexcept;
  void renumber_pairs() noexcept;
  void merge_pairs(const VecView& positions) noexcept;
  void add_pair(std::uint64_t key, const VecView& positions) noexcept;
  Vec3 shear_of(std::size_t pair) const noexcept {
    return pairs_.touched_at[pair] == step_ ? pairs_.shear[pair] : Vec3(Vec3::Zero());
  }
  void find_touching(const VecView& positions) noexcept;
  void forget_contacts() noexcept;
  void count_contacts() noexcept;
  void share_stiffness() noexcept;
  void push_pairs(const VecView& positions, const VecView& velocities) noexcept;
  void fill_block(std::span<const std::uint32_t> pairs, const VecView& positions, const VecView& velocities) noexcept;
  void read_block(std::size_t begin, std::span<const std::uint32_t> pairs) noexcept;
  void rouse(std::uint32_t first, std::uint32_t second) noexcept;
  void collect_forces() noexcept;
  void clear_outcome() noexcept;
  void load_pairs(ByteReader& in);

  BallLaw law_;
  Friction friction_;
  double tau_;
  std::uint64_t step_ = 1;
  // Of the list of pairs: the margin of the next search of all, how long ago the last was, and how all move since.
  double largest_radius_, next_margin_;
  std::uint32_t steps_since_search_ = 0;
  Vec3 drift_ = Vec3::Zero();  // metres per step
  Vector<Setting> settings_;   // by node

  BallPairs pairs_, old_pairs_;
  ReservedVector<std::uint32_t> places_;                            // the nodes that the pairs' places stand for
  ReservedVector<std::uint32_t> touching_pairs_, touching_before_;  // ascending; in this step, in the last
  Vector<double> pair_stiffness_;                                   // of those, N/m
  VecArray contact_normals_, contact_forces_;                       // of those

  // By place in roster.nodes().
  ReservedVector<double> radii_;
  ReservedVector<std::uint8_t> idle_;  // covered, in the heaviest fragment
  Vector<std::uint32_t> fragments_;
  Vector<std::uint8_t> is_paired_;         // in the list
  Vector<double> own_stiffness_;           // mean of its springs', N/m
  Vector<double> most_stiffness_;          // of all its pairs together, N/m
  Vector<std::uint32_t> contacts_;         // kept, like the stiffness, while the same pairs touch
  Vector<double> stiffness_;               // of one pair at most
  Vector<ForceSum> force_sums_;            // 0 between steps
  ReservedVector<std::uint32_t> touched_;  // where contacts_ are not 0
  // By fragment.
  Vector<double> fragment_stiffness_;  // of all its pairs together: a share of M / tau^2
  Vector<std::uint32_t> fragment_contacts_;
  Vector<std::uint8_t> is_roused_;
  BallBlock block_;
};

}  // namespace crumble
