// The tracker's state: saved, restored, hashed, copied, damaged.
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include "crumble/base/memory.hpp"
#include "tracked.hpp"

namespace crumble {
namespace {

using namespace fracture_test;

TEST(FragmentTrackerState, GoesOnFromASnapshotBitForBit) {
  Random random(54);
  const TetMesh& body = large_box();
  FragmentTracker tracker(body.node_count(), body.springs);
  Vector<FragmentTracker> twins;
  for (std::uint64_t step = 0; step < 24; ++step) {
    Ids cuts;
    if (step % 4 < 3) cuts = springs_across(body, static_cast<int>(step % 3), random.uniform(-0.029, 0.029));
    tracker.cut(cuts, step);
    for (FragmentTracker& twin : twins) {
      twin.cut(cuts, step);
      ASSERT_EQ(hash_of(twin), hash_of(tracker)) << step;
      ASSERT_EQ(saved(twin), saved(tracker));
    }
    twins.push_back(loaded(body, saved(tracker)));
    ASSERT_EQ(hash_of(twins.back()), hash_of(tracker)) << step;
  }
}

TEST(FragmentTrackerState, HashTellsStatesApart) {
  const TetMesh& body = large_box();
  const Ids plane = springs_across(body, 0, 0.0001);
  FragmentTracker tracker(body.node_count(), body.springs);
  std::set<std::uint64_t> hashes{hash_of(tracker)};
  std::size_t steps = 0;
  for (; steps == 0 || !tracker.settled(); ++steps) {
    tracker.cut(steps == 0 ? plane : Ids{}, steps);
    hashes.insert(hash_of(tracker));
  }
  EXPECT_GE(steps, 3u);
  tracker.remove(1);
  hashes.insert(hash_of(tracker));
  EXPECT_EQ(hashes.size(), steps + 2);
}

TEST(FragmentTrackerState, CopiesAreIndependent) {
  const TetMesh& body = large_box();
  const auto original = std::make_unique<FragmentTracker>(body.node_count(), body.springs);
  original->cut(springs_across(body, 0, 0.005), 1);
  ASSERT_FALSE(original->settled());
  const std::uint64_t before = hash_of(*original);
  FragmentTracker copy = *original;
  while (!copy.settled()) copy.cut({}, 2);
  EXPECT_EQ(copy.count(), 2u);
  EXPECT_EQ(hash_of(*original), before);
  FragmentTracker moved = std::move(*original);
  while (!moved.settled()) moved.cut({}, 2);
  EXPECT_EQ(hash_of(moved), hash_of(copy));
}

// What load() accepts must be as good as a tracker that was never saved.
void expect_refused_or_sound(const TetMesh& body, const Vector<std::uint8_t>& bytes) {
  FragmentTracker tracker(body.node_count(), body.springs);
  ByteReader in(bytes, "snapshot");
  try {
    tracker.load(in);
  } catch (const Error& error) {
    ASSERT_EQ(error.code(), Code::corrupt);
    ASSERT_EQ(hash_of(tracker), hash_of(FragmentTracker(body.node_count(), body.springs)));
    return;
  }
  ASSERT_TRUE(counts_fit(tracker));
  Ids all(body.springs.size());
  std::iota(all.begin(), all.end(), 0u);
  for (std::size_t step = 0; step < 10; ++step) tracker.cut(step == 0 ? all : Ids{}, ~std::uint64_t{0});
  ASSERT_TRUE(tracker.settled());
  ASSERT_TRUE(counts_fit(tracker));
  for (std::uint32_t id = 0; id < tracker.count(); ++id) ASSERT_LE(tracker.record(id).node_count, 1u);
}

// Every byte of the head, of the rest every `stride`th.
void expect_damage_is_found(const TetMesh& body, const FragmentTracker& tracker, std::size_t stride) {
  Random random(56);
  const Vector<std::uint8_t> good = saved(tracker);
  for (std::size_t i = 0; i < good.size(); i += i < 128 ? 1 : stride) {
    Vector<std::uint8_t> bad = good;
    bad[i] = static_cast<std::uint8_t>(bad[i] ^ (1 + random.below(255)));
    ASSERT_NO_FATAL_FAILURE(expect_refused_or_sound(body, bad)) << "byte " << i;
  }
  for (std::size_t size = 0; size < good.size(); size += 1 + random.below(good.size() / 300)) {
    const Vector<std::uint8_t> bad(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size));
    FragmentTracker other(body.node_count(), body.springs);
    ByteReader in(bad, "snapshot");
    ASSERT_THROW(other.load(in), Error) << "first " << size << " bytes";
  }
}

TEST(FragmentTrackerState, RefusesDamagedBytes) {
  Random random(57);
  FragmentTracker tracker(small_box().node_count(), small_box().springs);
  const Vector<Ids> steps = random_steps(small_box(), 60, random);
  for (std::size_t step = 0; step < steps.size() * 9 / 10; ++step) tracker.cut(steps[step], step);
  tracker.remove(2);
  expect_damage_is_found(small_box(), tracker, 1);

  const TetMesh chain = make_chain(FragmentTracker::kVisitsPerCall + 200);
  FragmentTracker busy(chain.node_count(), chain.springs);
  busy.cut(Ids{50, 7}, 2);
  busy.cut(Ids{2149}, 3);
  ASSERT_FALSE(busy.settled());
  expect_damage_is_found(chain, busy, 7);
}

// As save() writes it; this is a chain of six nodes that is cut in the middle.
struct SavedState {
  Ids log{2};
  std::uint64_t settled_end = 1, search_end = 1;
  std::uint32_t expanded = 0;
  Vector<FragmentRecord> records{{kNoFragment, 3, 0}, {0, 3, 4}};
  Ids labels{0, 0, 0, 1, 1, 1};

  Vector<std::uint8_t> bytes() const {
    ByteWriter out;
    out.put(log), out.put(settled_end), out.put(search_end), out.put(expanded);
    out.put(std::uint64_t{records.size()});
    for (const FragmentRecord& record : records) {
      out.put(record.parent), out.put(record.node_count), out.put(record.born);
    }
    out.put(labels);
    return out.bytes();
  }
};

TEST(FragmentTrackerState, RefusesWhatCannotBe) {
  const TetMesh chain = make_chain(6);
  FragmentTracker tracker(6, chain.springs);
  tracker.cut(Ids{2}, 4);
  ASSERT_EQ(saved(tracker), SavedState{}.bytes());

  constexpr std::uint32_t kNone = kNoFragment;
  const std::map<std::string, SavedState> bad{
      {"unknown spring", {.log = {5}}},
      {"spring cut twice", {.log = {2, 2}, .settled_end = 2, .search_end = 2}},
      {"settled beyond the log", {.settled_end = 2, .search_end = 2}},
      {"search before the settled", {.search_end = 0}},
      {"search beyond the log", {.search_end = 2}},
      {"expanded without a search", {.expanded = 1}},
      {"expanded too far", {.log = {2, 4}, .search_end = 2, .expanded = 5}},
      {"no fragment", {.records = {}}},
      {"too many", {.records = {7, {kNone, 0, 0}}}},
      {"a first one with a parent", {.records = {{0, 3, 0}, {0, 3, 4}}}},
      {"a later one without", {.records = {{kNone, 3, 0}, {kNone, 3, 4}}}},
      {"its own parent", {.records = {{kNone, 3, 0}, {1, 3, 4}}}},
      {"a first one born later", {.records = {{kNone, 3, 1}, {0, 3, 4}}}},
      {"born before an older one",
       {.log = {2, 4},
        .settled_end = 2,
        .search_end = 2,
        .records = {{kNone, 3, 0}, {0, 2, 4}, {1, 1, 3}},
        .labels = {0, 0, 0, 1, 1, 2}}},
      {"wrong node count", {.records = {{kNone, 4, 0}, {0, 2, 4}}}},
      {"unknown label", {.labels = {0, 0, 0, 1, 1, 2}}},
      {"missing label", {.labels = {0, 0, 0, 1, 1}}},
      {"labels swapped", {.labels = {0, 0, 1, 0, 1, 1}}},
      {"two parts under one id", {.records = {{kNone, 6, 0}}, .labels = {0, 0, 0, 0, 0, 0}}},
      {"half a part removed", {.records = {{kNone, 3, 0}, {0, 2, 4}}, .labels = {0, 0, 0, 1, 1, kNone}}},
      {"removed, but by no record", {.records = {{kNone, 3, 0}}, .labels = {0, 0, 0, kNone, kNone, kNone}}},
      {"removed by record alone", {.records = {{kNone, 3, 0}, {0, 3, 4}, {0, 0, 4}}}},
  };
  for (const auto& [what, state] : bad) {
    FragmentTracker other(6, chain.springs);
    const Vector<std::uint8_t> bytes = state.bytes();
    ByteReader in(bytes, "snapshot");
    try {
      other.load(in);
      ADD_FAILURE() << what << ": accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), Code::corrupt) << what;
    }
  }
}

}  // namespace
}  // namespace crumble
