#include "crumble/fracture/fragment_tracker.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <utility>

#include "crumble/base/memory.hpp"
#include "support/allocation_counter.hpp"
#include "tracked.hpp"

namespace crumble {
namespace {

using namespace fracture_test;

constexpr std::size_t kMaxLag = 2 * (9261 / FragmentTracker::kVisitsPerCall + 1);  // a search, and one for the rest

/// The rule in words, done by flooding the whole body after every step.
class Reference {
 public:
  explicit Reference(const TetMesh& body) : body_(&body), intact_(body.springs.size(), 1) {
    labels = flood_labels(body, intact_);
    records.resize(label_count(labels));
    for (const std::uint32_t label : labels) ++records[label].node_count;
  }

  void cut(const Ids& springs, std::uint64_t step) {
    for (const std::uint32_t spring : springs) intact_[spring] = 0;
    const Ids parts = flood_labels(*body_, intact_);
    Ids sizes(label_count(parts)), least(sizes.size()), old(sizes.size());
    for (std::uint32_t node = 0; node < parts.size(); ++node) {
      if (sizes[parts[node]]++ == 0) least[parts[node]] = node, old[parts[node]] = labels[node];
    }
    std::map<std::uint32_t, std::uint32_t> heirs;  // of the id; parts ascend by least node
    for (std::uint32_t part = 0; part < sizes.size(); ++part) {
      const auto [heir, first] = heirs.try_emplace(old[part], part);
      if (!first && sizes[part] > sizes[heir->second]) heir->second = part;
    }
    splits.clear();
    for (std::uint32_t part = 0; part < sizes.size(); ++part) {
      if (heirs[old[part]] == part) continue;
      splits.push_back({static_cast<std::uint32_t>(records.size()), old[part], least[part], sizes[part]});
      records.push_back({old[part], sizes[part], step});
      records[old[part]].node_count -= sizes[part];
      for (std::uint32_t node = 0; node < parts.size(); ++node) {
        if (parts[node] == part) labels[node] = splits.back().fragment;
      }
    }
  }

  Ids labels;
  Vector<FragmentRecord> records;
  Vector<FragmentSplit> splits;

 private:
  const TetMesh* body_;
  Flags intact_;
};

void expect_same(const FragmentTracker& tracker, const Reference& reference) {
  ASSERT_TRUE(tracker.settled());
  ASSERT_EQ(Ids(tracker.labels().begin(), tracker.labels().end()), reference.labels);
  ASSERT_EQ(tracker.count(), reference.records.size());
  for (std::uint32_t id = 0; id < tracker.count(); ++id) {
    ASSERT_EQ(tracker.record(id).parent, reference.records[id].parent) << id;
    ASSERT_EQ(tracker.record(id).node_count, reference.records[id].node_count) << id;
    ASSERT_EQ(tracker.record(id).born, reference.records[id].born) << id;
  }
  ASSERT_EQ(tracker.splits().size(), reference.splits.size());
  for (std::size_t i = 0; i < reference.splits.size(); ++i) {
    const FragmentSplit &found = tracker.splits()[i], &expected = reference.splits[i];
    ASSERT_EQ(found.fragment, expected.fragment);
    ASSERT_EQ(found.parent, expected.parent);
    ASSERT_EQ(found.node, expected.node);
    ASSERT_EQ(found.node_count, expected.node_count);
  }
}

void expect_follows_rule(const TetMesh& body, const Vector<Ids>& steps) {
  FragmentTracker tracker(body.node_count(), body.springs);
  Reference reference(body);
  ASSERT_NO_FATAL_FAILURE(expect_same(tracker, reference));
  for (std::size_t step = 0; step < steps.size(); ++step) {
    tracker.cut(steps[step], step + 7);
    reference.cut(steps[step], step + 7);
    ASSERT_NO_FATAL_FAILURE(expect_same(tracker, reference)) << step;
  }
}

/// Whether nodes that share a part share a label and, when `exact`, the other way round.
bool is_coarsening(std::span<const std::uint32_t> labels, const Ids& parts, bool exact) {
  Ids label_of(label_count(parts), kNoFragment);
  for (std::size_t node = 0; node < parts.size(); ++node) {
    std::uint32_t& label = label_of[parts[node]];
    if (label == kNoFragment) label = labels[node];
    if (label != labels[node]) return false;
  }
  return !exact || std::set<std::uint32_t>(label_of.begin(), label_of.end()).size() == label_of.size();
}

TEST(FragmentTracker, FollowsTheRuleInEveryStepOfRandomCuts) {
  Random random(51);
  for (const std::size_t most : {1u, 3u, 12u, 60u, 400u}) {
    ASSERT_NO_FATAL_FAILURE(expect_follows_rule(small_box(), random_steps(small_box(), most, random))) << most;
  }
}

TEST(FragmentTracker, FollowsTheRuleOnPlanes) {
  // thirds and halves, also of what is already apart; equal halves are decided by the least node
  Vector<Ids> steps;
  for (const auto& [axis, place] : {std::pair(0, 0.005), {0, -0.006}, {1, 0.016}, {2, 0.0}, {1, 0.004}}) {
    steps.push_back(springs_across(small_box(), axis, place));
  }
  ASSERT_NO_FATAL_FAILURE(expect_follows_rule(small_box(), steps));
  Ids both = steps[0];
  both.insert(both.end(), steps[3].begin(), steps[3].end());
  ASSERT_NO_FATAL_FAILURE(expect_follows_rule(small_box(), {both}));
  Ids all(small_box().springs.size());
  std::iota(all.begin(), all.end(), 0u);
  ASSERT_NO_FATAL_FAILURE(expect_follows_rule(small_box(), {all}));
}

TEST(FragmentTracker, FollowsTheRuleOnChainsAndSeveralBodies) {
  Random random(52);
  for (int run = 0; run < 20; ++run) {
    const TetMesh forest = make_joint({make_chain(40), make_chain(1), small_box(), make_chain(75)});
    const Ids order = random_order(forest.node_count(), random);
    Vector<Edge> springs;
    for (const auto& [a, b] : forest.springs) {
      springs.push_back({std::min(order[a], order[b]), std::max(order[a], order[b])});
    }
    const TetMesh mixed = make_graph(forest.node_count(), springs);
    ASSERT_NO_FATAL_FAILURE(expect_follows_rule(mixed, random_steps(mixed, 1 + 5u * run, random))) << run;
  }
}

TEST(FragmentTracker, SaysWhatCameOffWhat) {
  const TetMesh chain = make_chain(10);
  FragmentTracker tracker(10, chain.springs);
  tracker.cut(Ids{2}, 5);  // 0 1 2 | 3 ... 9
  ASSERT_EQ(tracker.splits().size(), 1u);
  EXPECT_EQ(tracker.splits()[0].fragment, 1u);
  EXPECT_EQ(tracker.splits()[0].parent, 0u);
  EXPECT_EQ(tracker.splits()[0].node, 0u);
  EXPECT_EQ(tracker.splits()[0].node_count, 3u);
  EXPECT_EQ(tracker.labels()[9], 0u);
  EXPECT_EQ(tracker.record(0).node_count, 7u);
  EXPECT_EQ(tracker.record(1).born, 5u);
  tracker.cut(Ids{2}, 6);  // cut before
  EXPECT_EQ(tracker.count(), 2u);
  EXPECT_TRUE(tracker.splits().empty());
  tracker.cut(Ids{0}, 7);  // 0 | 1 2
  EXPECT_EQ(tracker.record(2).parent, 1u);
  EXPECT_EQ(tracker.labels()[0], 2u);
  tracker.reset();
  EXPECT_EQ(hash_of(tracker), hash_of(FragmentTracker(10, chain.springs)));
}

// Too large for one call: never finer than the truth, and equal to it after a bounded number of calls.
TEST(FragmentTracker, LargeBodiesLagButSettle) {
  Random random(53);
  const TetMesh& body = large_box();
  for (int run = 0; run < 3; ++run) {
    FragmentTracker tracker(body.node_count(), body.springs);
    Flags intact(body.springs.size(), 1);
    std::size_t lag = 0, longest_lag = 0;
    const auto step = [&](const Ids& cuts, std::uint64_t number) {
      for (const std::uint32_t spring : cuts) intact[spring] = 0;
      const std::size_t count = tracker.count();
      tracker.cut(cuts, number);
      const Ids parts = flood_labels(body, intact);
      ASSERT_TRUE(is_coarsening(tracker.labels(), parts, tracker.settled()));
      ASSERT_TRUE(counts_fit(tracker));
      ASSERT_EQ(tracker.count(), count + tracker.splits().size());
      for (const FragmentSplit& split : tracker.splits()) {
        // two searches may end in one call: the node may be in what came off this fragment
        std::uint32_t owner = tracker.labels()[split.node];
        while (owner > split.fragment) owner = tracker.record(owner).parent;
        ASSERT_EQ(owner, split.fragment);
        ASSERT_EQ(tracker.record(split.fragment).parent, split.parent);
      }
      lag = tracker.settled() ? 0 : lag + 1;
      longest_lag = std::max(longest_lag, lag);
    };
    for (std::uint64_t number = 0; number < 40; ++number) {
      Ids cuts;
      if (number % 8 < 5) {
        const double place = random.uniform(-0.029, 0.029);
        cuts = springs_across(body, static_cast<int>(random.below(3)), place);
        if (number % 2 == 0) cuts.resize(cuts.size() / 2);
      } else if (number % 8 == 5) {
        for (int i = 0; i < 3000; ++i) cuts.push_back(static_cast<std::uint32_t>(random.below(body.springs.size())));
      }
      ASSERT_NO_FATAL_FAILURE(step(cuts, number)) << run << " " << number;
    }
    for (std::uint64_t number = 40; !tracker.settled(); ++number) {
      ASSERT_LT(number, 40 + kMaxLag);
      ASSERT_NO_FATAL_FAILURE(step({}, number));
    }
    EXPECT_GE(longest_lag, 2u);
    EXPECT_GT(tracker.count(), 10u);
  }
}

TEST(FragmentTracker, BeginsTheNextSearchInTheSameCall) {
  const TetMesh chain = make_chain(FragmentTracker::kVisitsPerCall + 200);
  FragmentTracker tracker(chain.node_count(), chain.springs);
  tracker.cut(Ids{2149}, 0);
  EXPECT_FALSE(tracker.settled());
  tracker.cut(Ids{5}, 1);
  EXPECT_TRUE(tracker.settled());
  EXPECT_EQ(tracker.splits().size(), 2u);
}

// One box of two is removed while both are being searched: nothing changes for the other.
TEST(FragmentTracker, RemovedInMidSearch) {
  const TetMesh two = make_joint({large_box(), large_box()});
  const std::size_t half = large_box().node_count();
  for (const std::uint32_t removed : {0u, 1u}) {
    FragmentTracker tracker(two.node_count(), two.springs);
    tracker.cut(springs_across(two, 0, 0.005), 1);
    tracker.cut({}, 2);
    ASSERT_FALSE(tracker.settled());
    const std::uint32_t kept = 1 - removed;
    tracker.remove(removed);
    tracker.remove(removed);  // a second time
    tracker.remove(17);       // not there
    EXPECT_EQ(tracker.record(removed).node_count, 0u);
    FragmentTracker twin = loaded(two, saved(tracker));
    ASSERT_EQ(hash_of(twin), hash_of(tracker));
    const Ids more = springs_across(two, 1, 0.04);
    for (std::uint64_t step = 3; step < 3 + 2 * kMaxLag; ++step) {
      tracker.cut(step == 4 ? more : Ids{}, step);
      twin.cut(step == 4 ? more : Ids{}, step);
      ASSERT_EQ(hash_of(twin), hash_of(tracker)) << step;
    }
    ASSERT_TRUE(tracker.settled());
    ASSERT_TRUE(counts_fit(tracker));

    Flags intact(two.springs.size(), 1);
    for (const std::uint32_t spring : springs_across(two, 0, 0.005)) intact[spring] = 0;
    for (const std::uint32_t spring : more) intact[spring] = 0;
    const Ids parts = flood_labels(two, intact);
    const Ids parts_kept(parts.begin() + static_cast<std::ptrdiff_t>(kept * half),
                         parts.begin() + static_cast<std::ptrdiff_t>((kept + 1) * half));
    EXPECT_TRUE(is_coarsening(tracker.labels().subspan(kept * half, half), parts_kept, false));
    EXPECT_EQ(tracker.count(), 5u);  // two boxes, and three quarters that came off the one that is left
    for (const std::uint32_t label : tracker.labels().subspan(removed * half, half)) ASSERT_EQ(label, kNoFragment);
    for (const std::uint32_t label : tracker.labels().subspan(kept * half, half)) ASSERT_NE(label, kNoFragment);
  }
}

TEST(FragmentTracker, AllThatIsSearchedMayBeRemoved) {
  const TetMesh& body = large_box();
  FragmentTracker tracker(body.node_count(), body.springs);
  tracker.cut(springs_across(body, 0, 0.005), 1);
  ASSERT_FALSE(tracker.settled());
  tracker.remove(0);
  FragmentTracker twin = loaded(body, saved(tracker));
  for (FragmentTracker* each : {&tracker, &twin}) {
    each->cut(springs_across(body, 1, 0.02), 2);
    EXPECT_TRUE(each->settled());
    EXPECT_TRUE(each->splits().empty());
    EXPECT_EQ(each->count(), 1u);
  }
  EXPECT_EQ(hash_of(twin), hash_of(tracker));
}

TEST(FragmentTracker, RemovedFragmentsStayAway) {
  const TetMesh chain = make_chain(10);
  FragmentTracker tracker(10, chain.springs);
  tracker.cut(Ids{3}, 0);
  tracker.remove(1);
  tracker.cut(Ids{1, 7}, 1);  // one in what is gone
  EXPECT_EQ(tracker.count(), 3u);
  EXPECT_EQ(tracker.record(2).parent, 0u);
  EXPECT_EQ(Ids(tracker.labels().begin(), tracker.labels().end()),
            (Ids{kNoFragment, kNoFragment, kNoFragment, kNoFragment, 0, 0, 0, 0, 2, 2}));
  const FragmentTracker twin = loaded(chain, saved(tracker));
  EXPECT_EQ(hash_of(twin), hash_of(tracker));
}

TEST(FragmentTracker, TakesNoMemoryInTheStep) {
  if (!AllocationCounter::available()) GTEST_SKIP() << "allocations are not counted in this build";
  Random random(55);
  const Vector<Ids> steps = random_steps(small_box(), 20, random);
  const FragmentTracker original(small_box().node_count(), small_box().springs);
  FragmentTracker tracker = original;  // keeps the room
  std::size_t allocations = 0;
  {
    AllocationCounter counter;
    for (int run = 0; run < 2; ++run, tracker.reset()) {
      for (std::size_t step = 0; step < steps.size(); ++step) {
        tracker.cut(steps[step], step);
        if (step % 50 == 49) tracker.remove(tracker.labels()[step % 200]);
      }
    }
    allocations = counter.count();
  }
  EXPECT_EQ(allocations, 0u);
}

TEST(FragmentTracker, RefusesBadSprings) {
  const Vector<Edge> springs{{0, 1}, {1, 5}};
  try {
    const FragmentTracker tracker(5, springs);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Code::out_of_range);
    EXPECT_NE(std::string(error.what()).find("springs[1] ends at node 5"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace crumble
