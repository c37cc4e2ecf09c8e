// Every spring has one lane that joins its two nodes, and nothing that a kernel touches lies outside its arrays.
#include "network/layout.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "crumble/base/memory.hpp"
#include "crumble/network/solver.hpp"
#include "network/violence.hpp"

namespace crumble {
namespace {

SpringNetwork network_of(const TetMesh& mesh) {
  return make_network(mesh, {}, MassRule::lumped, {});
}

struct Lane {
  std::uint32_t lower, upper;  // slots
};

// Walks segments and batches as a kernel does, partition by partition.
void visit_lanes(const Layout& layout,
                 const std::function<void(std::size_t partition, std::uint32_t lane, Lane)>& see) {
  for (std::size_t p = 0; p < layout.partitions.size(); ++p) {
    const Partition& part = layout.partitions[p];
    for (std::uint32_t s = part.first_segment; s < part.end_segment; ++s) {
      const Segment& segment = layout.segments[s];
      std::uint32_t lane = segment.lane;
      for (std::uint32_t way = 0; way < segment.ways; ++way) {
        for (std::uint32_t i = 0; i < segment.blocks * kLanes; ++i, ++lane) {
          const std::uint32_t lower = segment.first + i;
          see(p, lane, {lower, lower + layout.offsets[segment.first_way + way]});
        }
      }
    }
    for (std::uint32_t b = part.first_batch; b < part.end_batch; ++b) {
      for (std::uint32_t l = 0; l < kLanes; ++l) {
        see(p, layout.batch_lanes + b * kLanes + l, {layout.batches[b].lower[l], layout.batches[b].upper[l]});
      }
    }
  }
}

void expect_each_spring_once(const SpringNetwork& network, const Layout& layout) {
  Vector<int> lanes_seen(layout.lane_count(), 0), springs_seen(network.spring_count(), 0);
  visit_lanes(layout, [&](std::size_t, std::uint32_t lane, Lane ends) {
    ASSERT_LT(lane, layout.lane_count());
    ++lanes_seen[lane];
    const std::uint32_t spring = layout.spring_of_lane[lane];
    if (spring == kNone) return;
    ++springs_seen[spring];
    EXPECT_EQ(layout.lane_of_spring[spring], lane);
    const auto [a, b] = network.springs[spring];
    EXPECT_EQ(std::minmax(layout.slot_of[a], layout.slot_of[b]), std::minmax(ends.lower, ends.upper));
  });
  EXPECT_EQ(std::count(lanes_seen.begin(), lanes_seen.end(), 1), static_cast<long>(lanes_seen.size()));
  EXPECT_EQ(std::count(springs_seen.begin(), springs_seen.end(), 1), static_cast<long>(springs_seen.size()));
}

void expect_permutation(const Layout& layout) {
  for (std::uint32_t slot = 0; slot < layout.node_count(); ++slot) {
    ASSERT_EQ(layout.slot_of[layout.node_of[slot]], slot);
  }
}

// A kernel reads and writes all lanes of a block, filled or not; a store of 8 nodes for a batch would lose a force if
// two of its slots were the same.
void expect_room(const Layout& layout) {
  const std::uint32_t nodes = layout.node_count();
  visit_lanes(layout, [&](std::size_t p, std::uint32_t, Lane ends) {
    const bool last = p + 1 == layout.partitions.size();
    const Partition& part = layout.partitions[p];
    ASSERT_GE(ends.lower, part.first);
    ASSERT_LT(std::max(ends.lower, ends.upper), last ? nodes + kPadding : part.end + layout.halo);
  });
  for (const Segment& segment : layout.segments) {
    ASSERT_GE(segment.blocks, 1u);
    ASSERT_LE(segment.blocks, kMostBlocks);
    const auto ways = std::span(layout.offsets).subspan(segment.first_way, segment.ways);
    ASSERT_EQ(std::set<std::uint32_t>(ways.begin(), ways.end()).size(), ways.size());
    ASSERT_TRUE(std::ranges::find(ways, 0u) == ways.end());
  }
  for (const Batch& batch : layout.batches) {
    std::set<std::uint32_t> slots(batch.lower.begin(), batch.lower.end());
    slots.insert(batch.upper.begin(), batch.upper.end());
    ASSERT_EQ(slots.size(), 2 * kLanes);
  }
}

// Partitions follow each other, end where boxes of nodes end, and no halo reaches past the next one.
void expect_partitions(const Layout& layout) {
  std::uint32_t slot = 0, segment = 0, batch = 0;
  for (const Partition& p : layout.partitions) {
    EXPECT_EQ(p.first, slot);
    EXPECT_EQ(p.first_segment, segment);
    EXPECT_EQ(p.first_batch, batch);
    EXPECT_EQ(p.first % kPadding, 0u);
    EXPECT_GE(p.end - p.first, layout.halo);
    slot = p.end, segment = p.end_segment, batch = p.end_batch;
  }
  EXPECT_EQ(slot, layout.node_count());
  EXPECT_EQ(segment, layout.segments.size());
  EXPECT_EQ(batch, layout.batches.size());
  EXPECT_EQ(layout.halo % kLanes, 0u);
}

// What batches add is taken over for each group of slots that they touch, once, by the partition that owns the slot.
void expect_groups(const Layout& layout) {
  Vector<std::set<std::uint32_t>> own(layout.partitions.size()), halo(layout.partitions.size());
  visit_lanes(layout, [&](std::size_t p, std::uint32_t lane, Lane ends) {
    if (lane < layout.batch_lanes) return;
    for (const std::uint32_t slot : {ends.lower, ends.upper}) {
      if (slot < layout.partitions[p].end || p + 1 == layout.partitions.size()) {
        own[p].insert(slot / kLanes);
      } else {
        halo[p].insert(slot / kLanes), own[p + 1].insert(slot / kLanes);
      }
    }
  });
  for (std::size_t p = 0; p < layout.partitions.size(); ++p) {
    const Partition& part = layout.partitions[p];
    EXPECT_EQ(part.own_groups, Vector<std::uint32_t>(own[p].begin(), own[p].end()));
    EXPECT_EQ(part.halo_groups, Vector<std::uint32_t>(halo[p].begin(), halo[p].end()));
  }
}

void expect_sound(const SpringNetwork& network, const Layout& layout) {
  expect_permutation(layout);
  expect_each_spring_once(network, layout);
  expect_room(layout);
  expect_partitions(layout);
  expect_groups(layout);
}

TEST(Layout, EverySpringHasOneLaneThatJoinsItsNodes) {
  Random random(3);
  for (const Body& body : small_bodies()) {
    SCOPED_TRACE(body.name);
    SpringNetwork network = network_of(body.mesh);
    expect_sound(network, make_layout(network, body.mesh.positions));
    shuffle_springs(network, random);
    expect_sound(network, make_layout(network, body.mesh.positions));
  }
}

TEST(Layout, LargeBodiesAreDivided) {
  Random random(5);
  const TetMesh rows = make_lattice_box({0.09, 0.03, 0.03}, 0.03 / 14.5), points = random_mesh(9000, random);
  const TetMesh mixed = shuffled(rows, random), bubbles = bubble_cube(0.03, 0.00155, Structure::lattice);
  for (const TetMesh* mesh : {&rows, &points, &mixed, &bubbles}) {
    const SpringNetwork network = network_of(*mesh);
    ASSERT_GT(network.spring_count(), 50'000u);
    const Layout layout = make_layout(network, mesh->positions);
    EXPECT_GE(layout.partitions.size(), 2u);
    expect_sound(network, layout);
  }
}

// Rows of many lengths and with gaps, so that segments meet the ends of partitions in many ways.
TEST(Layout, HalosAreLongEnoughForBoxesOfEverySize) {
  Random random(13);
  for (int cells = 9; cells < 29; ++cells) {
    const double across = std::floor(9500.0 / cells / 20 + 1);
    const TetMesh mesh = make_lattice_box({0.001 * cells, 0.02, 0.001 * across}, 0.001);
    const SpringNetwork whole = network_of(mesh);
    SpringNetwork network = whole;
    network.springs.clear(), network.rest_lengths.clear();
    for (std::size_t s = 0; s < whole.spring_count(); ++s) {
      if (random.uniform() < 0.2) continue;
      network.springs.push_back(whole.springs[s]);
      network.rest_lengths.push_back(whole.rest_lengths[s]);
    }
    const Layout layout = make_layout(network, mesh.positions);
    ASSERT_GE(layout.partitions.size(), 2u);
    expect_room(layout);
    expect_partitions(layout);
  }
}

// The partition a spring falls to and the order of sums are the body's alone: the spring list says nothing.
TEST(Layout, TheOrderOfSpringsChangesNothing) {
  Random random(7);
  for (const Body& body : small_bodies()) {
    const SpringNetwork network = network_of(body.mesh);
    SpringNetwork other = network;
    const auto order = random_order(network.spring_count(), random);
    for (std::size_t s = 0; s < order.size(); ++s) {
      other.springs[s] = network.springs[order[s]];
      other.rest_lengths[s] = network.rest_lengths[order[s]];
    }
    const Layout a = make_layout(network, body.mesh.positions), b = make_layout(other, body.mesh.positions);
    EXPECT_EQ(a.node_of, b.node_of);
    EXPECT_EQ(a.offsets, b.offsets);
    EXPECT_EQ(a.segments.size(), b.segments.size());
    EXPECT_EQ(a.batches.size(), b.batches.size());
    ASSERT_EQ(a.lane_count(), b.lane_count());
    for (std::size_t lane = 0; lane < a.lane_count(); ++lane) {
      ASSERT_EQ(a.spring_of_lane[lane] == kNone, b.spring_of_lane[lane] == kNone);
      if (b.spring_of_lane[lane] != kNone) {
        ASSERT_EQ(a.spring_of_lane[lane], order[b.spring_of_lane[lane]]);
      }
    }
  }
}

LayoutReport report_of(const TetMesh& mesh) {
  const SpringNetwork network = network_of(mesh);
  const auto c = make_coefficients(network, 1e-3, TimeStepPolicy::guard);
  return NetworkSolver::make(network, c, mesh.positions, {})->layout();
}

double in_segments(const TetMesh& mesh) {
  return static_cast<double>(report_of(mesh).springs_in_segments) / static_cast<double>(mesh.springs.size());
}

TEST(Layout, ShuffledBodiesAreSortedAndFindTheirRowsAgain) {
  Random random(11);
  const TetMesh lattice = bubble_cube(0.03, 0.0025, Structure::lattice);
  const TetMesh relaxed = bubble_cube(0.03, 0.003, Structure::relaxed);
  for (const TetMesh* mesh : {&lattice, &relaxed}) {
    EXPECT_FALSE(report_of(*mesh).sorted);
    const TetMesh mixed = shuffled(*mesh, random);
    EXPECT_TRUE(report_of(mixed).sorted);
    EXPECT_GE(in_segments(mixed), 0.97 * in_segments(*mesh));
  }
  EXPECT_GT(in_segments(lattice), 0.8);
}

TEST(Layout, ReportCountsWhatIsThere) {
  for (const Body& body : small_bodies()) {
    const SpringNetwork network = network_of(body.mesh);
    const Layout layout = make_layout(network, body.mesh.positions);
    const LayoutReport report = report_of(body.mesh);
    EXPECT_EQ(report.lanes, layout.lane_count());
    EXPECT_EQ(report.segments, layout.segments.size());
    EXPECT_EQ(report.batches, layout.batches.size());
    EXPECT_EQ(report.partitions, layout.partitions.size());
    EXPECT_LE(report.springs_in_segments, network.spring_count());
    EXPECT_GE(report.springs_in_segments + report.batches * kLanes, network.spring_count());
  }
}

}  // namespace
}  // namespace crumble
