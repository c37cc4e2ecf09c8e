// Where every node and spring of a network stands in the solver's arrays. Worked out once, from the finished springs.
//
// A node's place is its slot. When nodes are numbered along the rows of a crystal, the neighbour of slot i in one
// direction is slot i + o with the same o all along a row. So 8 nodes and their 8 neighbours in each direction are
// contiguous loads, and no index is read. A segment is a stretch of slots with the offsets (the "ways") that its
// springs share; a lane without a spring (there is none, or it is cut) has stiffness 0. What fits no segment goes into
// batches of 8 springs that share no node, which are loaded and stored node by node.
//
//   segment   first = 3, ways = {5, 1}      slots  3  4  5  6  7 [8  9 10]...
//                                                  |  |  |     |  upper ends of way 5: 8 9 10 12
//                                                  3--4--5     7  upper ends of way 1: 4 5
//
// The order of sums is part of the result, and no vector width may show in it. Within a segment the ways follow each
// other; each takes its pulls from the upper ends of all the segment's slots, so every slot gets one at most, and adds
// them up for the lower ends; these sums are added when all ways are done. Segments follow each other in their order,
// then the batches in theirs. A body is divided into partitions, pieces of consecutive slots, by its
// size alone, so that any number of threads adds in the same order: a spring belongs to the partition of its lower end,
// and what it adds beyond the partition's end goes to a halo that the next one adds after its own.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "crumble/base/memory.hpp"
#include "crumble/base/vec.hpp"
#include "crumble/network/spring_network.hpp"

namespace crumble {

inline constexpr std::uint32_t kLanes = 8;       // logical width: of a run's block and of a batch
inline constexpr std::uint32_t kMostBlocks = 8;  // of kLanes slots, in a segment
inline constexpr std::uint32_t kPadding = 64;    // slots and lanes behind the last that kernels may read
inline constexpr std::uint32_t kNone = 0xffffffffu;

struct Segment {
  std::uint32_t first;      // slot
  std::uint32_t blocks;     // of kLanes slots
  std::uint32_t first_way;  // of `offsets`
  std::uint32_t ways;
  std::uint32_t lane;  // of its first way's first spring; each way has blocks * kLanes
};

struct Batch {
  std::array<std::uint32_t, kLanes> lower, upper;  // slots, all 16 different; its lanes follow those of the segments
};

struct Partition {
  std::uint32_t first, end;  // slots
  std::uint32_t first_segment, end_segment;
  std::uint32_t first_batch, end_batch;
  Vector<std::uint32_t> own_groups;   // groups of kLanes slots of this partition that some batch touches
  Vector<std::uint32_t> halo_groups;  // groups beyond its end that its own batches touch
};

struct Layout {
  Vector<std::uint32_t> slot_of;         // (node_count)
  Vector<std::uint32_t> node_of;         // (node_count)
  std::uint32_t halo = 0;                // slots beyond a partition's end that its springs reach; multiple of kLanes
  Vector<Segment> segments;              // by partition, then by first slot
  Vector<std::uint32_t> offsets;         // of the ways: upper slot - lower slot
  Vector<Batch> batches;                 // by partition
  std::uint32_t batch_lanes = 0;         // lane of the first batch's first spring
  Vector<std::uint32_t> spring_of_lane;  // kNone where there is none (lane_count)
  Vector<std::uint32_t> lane_of_spring;  // (spring_count)
  Vector<Partition> partitions;
  bool sorted = false;  // slots are not the node numbers

  std::uint32_t node_count() const { return static_cast<std::uint32_t>(node_of.size()); }
  std::size_t lane_count() const { return spring_of_lane.size(); }
  /// A partition's forces stand `shift` places behind the slot's number, so that halos do not meet.
  std::uint32_t shift(std::size_t partition) const { return static_cast<std::uint32_t>(partition) * halo; }
};

Layout make_layout(const SpringNetwork& network, std::span<const Vec3> positions);

/// Nodes by layer (y), row (z) and place (x): new order as node numbers. A layer ends where y has risen by 0.6 mean
/// spring lengths, so that the layers of a crystal are found as they are.
Vector<std::uint32_t> row_order(const SpringNetwork& network, std::span<const Vec3> positions);

}  // namespace crumble
