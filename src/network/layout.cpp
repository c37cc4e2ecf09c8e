#include "network/layout.hpp"

#include <algorithm>
#include <functional>
#include <memory>
#include <numeric>

#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

struct Link {  // a spring between slots
  std::uint32_t lower = 0, offset = 0, spring = 0;
};

constexpr std::uint32_t kLeastInBlock = 4;  // springs that make a way of a block cheaper than a batch
constexpr double kLeastUse = 0.7;           // of the lanes, for a segment to go on by another block
constexpr std::size_t kPartitionSprings = 50'000;
constexpr std::uint32_t kMostPartitions = 8;

// By lower slot, those with the greatest offset first.
Vector<Link> sorted_links(const SpringNetwork& network, const Vector<std::uint32_t>& slot_of) {
  Vector<std::uint32_t> begin(slot_of.size() + 1, 0);
  const auto ends = [&](std::uint32_t s) {
    return std::minmax(slot_of[network.springs[s][0]], slot_of[network.springs[s][1]]);
  };
  for (std::uint32_t s = 0; s < network.spring_count(); ++s) ++begin[ends(s).first + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  Vector<Link> links(network.spring_count());
  Vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
  for (std::uint32_t s = 0; s < network.spring_count(); ++s) {
    const auto [lower, upper] = ends(s);
    links[next[lower]++] = {lower, upper - lower, s};
  }
  for (std::size_t slot = 0; slot < slot_of.size(); ++slot) {
    std::sort(links.begin() + begin[slot], links.begin() + begin[slot + 1],
              [](const Link& a, const Link& b) { return a.offset > b.offset; });
  }
  return links;
}

// Takes springs into segments, slot by slot upwards.
class SegmentFinder {
 public:
  SegmentFinder(std::span<const Link> links, std::uint32_t node_count, std::span<const std::uint32_t> partition_ends)
      : links_(links),
        begin_(node_count + kLanes * (kMostBlocks + 2), 0),
        taken_(links.size(), 0),
        ends_(partition_ends) {
    for (const Link& link : links) ++begin_[link.lower + 1];
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  }

  struct Found {
    Vector<Segment> segments;
    Vector<std::uint32_t> offsets;
    Vector<std::uint32_t> spring_of_lane;
    Vector<Link> others;
  };

  Found find() {
    for (std::uint32_t slot = 0; slot < node_count(); ++slot) {
      while (add_segment(slot)) {
      }
      for (std::size_t l = begin_[slot]; l < begin_[slot + 1]; ++l) {
        if (!taken_[l]) found_.others.push_back(links_[l]);
      }
    }
    return std::move(found_);
  }

 private:
  std::uint32_t node_count() const { return links_.empty() ? 0 : links_.back().lower + 1; }

  // Offsets, descending, that at least `least` free springs of the slots [first, first + blocks * kLanes) have; none
  // when no spring of `first` itself has one of them.
  Vector<std::uint32_t> common_ways(std::uint32_t first, std::uint32_t blocks, std::size_t least) {
    Vector<std::uint32_t> ways;
    bool starts_here = false;
    tally_.clear();
    for (std::size_t l = begin_[first]; l < begin_[first + blocks * kLanes]; ++l) {
      if (!taken_[l]) tally_.push_back(links_[l].offset);
    }
    std::sort(tally_.begin(), tally_.end(), std::greater<>());
    for (auto it = tally_.begin(); it != tally_.end();) {
      const auto end = std::find_if(it, tally_.end(), [&](std::uint32_t o) { return o != *it; });
      if (static_cast<std::size_t>(end - it) >= least) {
        ways.push_back(*it);
        starts_here = starts_here || has_free(first, *it);
      }
      it = end;
    }
    if (!starts_here) ways.clear();
    return ways;
  }

  // Ways next to each other in order often differ by 1: their stores and loads, all but a lane the same, would wait for
  // each other.
  static Vector<std::uint32_t> every_other(const Vector<std::uint32_t>& ways) {
    Vector<std::uint32_t> order;
    for (const std::size_t first : {0u, 1u}) {
      for (std::size_t w = first; w < ways.size(); w += 2) order.push_back(ways[w]);
    }
    return order;
  }

  bool has_free(std::uint32_t slot, std::uint32_t offset) const {
    for (std::size_t l = begin_[slot]; l < begin_[slot + 1]; ++l) {
      if (!taken_[l] && links_[l].offset == offset) return true;
    }
    return false;
  }

  std::size_t count_free(std::uint32_t slot, const Vector<std::uint32_t>& ways) const {
    std::size_t count = 0;
    for (std::size_t l = begin_[slot]; l < begin_[slot + kLanes]; ++l) {
      count += !taken_[l] && std::ranges::find(ways, links_[l].offset) != ways.end();
    }
    return count;
  }

  // As many blocks as are filled well with the ways of the first, then all ways that fill these well.
  bool add_segment(std::uint32_t first) {
    Vector<std::uint32_t> ways = common_ways(first, 1, kLeastInBlock);
    if (ways.empty()) return false;
    const std::uint32_t end = *std::ranges::upper_bound(ends_, first);
    std::uint32_t blocks = 1;
    while (blocks < kMostBlocks && first + blocks * kLanes < end &&
           static_cast<double>(count_free(first + blocks * kLanes, ways)) >=
               kLeastUse * kLanes * static_cast<double>(ways.size()))
      ++blocks;
    Vector<std::uint32_t> all_ways = common_ways(first, blocks, blocks * kLeastInBlock);
    if (all_ways.empty()) {
      blocks = 1;
    } else {
      ways = std::move(all_ways);
    }
    take(first, blocks, every_other(ways));
    return true;
  }

  void take(std::uint32_t first, std::uint32_t blocks, const Vector<std::uint32_t>& ways) {
    const auto lane = static_cast<std::uint32_t>(found_.spring_of_lane.size());
    found_.segments.push_back({first, blocks, static_cast<std::uint32_t>(found_.offsets.size()),
                               static_cast<std::uint32_t>(ways.size()), lane});
    found_.offsets.insert(found_.offsets.end(), ways.begin(), ways.end());
    found_.spring_of_lane.resize(lane + ways.size() * blocks * kLanes, kNone);
    for (std::size_t l = begin_[first]; l < begin_[first + blocks * kLanes]; ++l) {
      const auto way = std::ranges::find(ways, links_[l].offset);
      if (taken_[l] || way == ways.end()) continue;
      taken_[l] = 1;
      const auto way_lanes = static_cast<std::size_t>(way - ways.begin()) * blocks * kLanes;
      found_.spring_of_lane[lane + way_lanes + (links_[l].lower - first)] = links_[l].spring;
    }
  }

  std::span<const Link> links_;
  Vector<std::size_t> begin_;  // of the links of each slot
  Vector<std::uint8_t> taken_;
  std::span<const std::uint32_t> ends_;
  Vector<std::uint32_t> tally_;
  Found found_;
};

std::size_t springs_in_segments(const SpringNetwork& network, const Vector<std::uint32_t>& slot_of) {
  const Vector<Link> links = sorted_links(network, slot_of);
  const std::uint32_t end = kNone;
  return links.size() -
         SegmentFinder(links, static_cast<std::uint32_t>(slot_of.size()), {&end, 1}).find().others.size();
}

Vector<std::uint32_t> inverse(std::span<const std::uint32_t> order) {
  Vector<std::uint32_t> place(order.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) place[order[i]] = i;
  return place;
}

// The order given, or rows found from the positions when they put more springs into runs.
void order_nodes(const SpringNetwork& network, std::span<const Vec3> positions, Layout& layout) {
  layout.node_of.resize(network.node_count());
  std::iota(layout.node_of.begin(), layout.node_of.end(), 0u);
  layout.slot_of = layout.node_of;
  Vector<std::uint32_t> by_rows = row_order(network, positions);
  Vector<std::uint32_t> slot_of = inverse(by_rows);
  const auto reach = [&](const Vector<std::uint32_t>& slots) {
    std::uint64_t sum = 0;
    for (const auto& [a, b] : network.springs) sum += std::max(slots[a], slots[b]) - std::min(slots[a], slots[b]);
    return sum;
  };
  const std::size_t given = springs_in_segments(network, layout.slot_of),
                    sorted = springs_in_segments(network, slot_of);
  layout.sorted = sorted > given + network.spring_count() / 50 || reach(slot_of) < reach(layout.slot_of) / 2;
  if (!layout.sorted) return;
  layout.node_of = std::move(by_rows);
  layout.slot_of = std::move(slot_of);
}

std::uint32_t round_up(std::uint32_t n, std::uint32_t multiple) {
  return (n + multiple - 1) / multiple * multiple;
}

// Slots where a partition ends: equal numbers of springs, multiples of kPadding, none shorter than the halo.
Vector<std::uint32_t> partition_ends(std::span<const Link> links, std::uint32_t node_count, std::uint32_t halo) {
  const auto wanted =
      static_cast<std::uint32_t>(std::min<std::size_t>(kMostPartitions, links.size() / (kPartitionSprings / 2)));
  Vector<std::uint32_t> lower_ends(node_count + 1, 0);
  for (const Link& link : links) ++lower_ends[link.lower];
  Vector<std::uint32_t> ends;
  std::uint64_t sum = 0;
  for (std::uint32_t slot = 0; slot < node_count && wanted > 1 && links.size() >= kPartitionSprings; ++slot) {
    sum += lower_ends[slot];
    const std::uint32_t begin = ends.empty() ? 0 : ends.back();
    const std::uint32_t end = slot + 1;
    if (end % kPadding == 0 && sum * wanted >= links.size() * (ends.size() + 1) && end - begin >= halo &&
        node_count - end >= std::max(halo, kPadding)) {
      ends.push_back(end);
    }
  }
  ends.push_back(node_count);
  return ends;
}

// Fills batches with springs in order, passing over those that share a node with the batch; a small window of springs
// waits for the next one. Places left over take springs of no stiffness between nodes that the batch does not use.
class BatchMaker {
 public:
  BatchMaker(Layout& layout, std::uint32_t first, std::uint32_t slot_count)
      : layout_(layout), first_(first), last_use_(slot_count + kPadding, 0) {}

  void make(std::span<const Link> links) {
    std::size_t next = 0;
    Vector<Link> window;
    while (next < links.size() || !window.empty()) {
      while (next < links.size() && window.size() < kWindow) window.push_back(links[next++]);
      begin_batch();
      std::erase_if(window, [&](const Link& link) { return take(link); });
      end_batch();
    }
  }

 private:
  static constexpr std::size_t kWindow = 96;

  bool is_free(std::uint32_t slot) const { return last_use_[slot] != batch_number_; }
  void begin_batch() {
    ++batch_number_;
    filled_ = 0;
    layout_.batches.emplace_back();
  }
  void put(std::uint32_t lower, std::uint32_t upper, std::uint32_t spring) {
    layout_.batches.back().lower[filled_] = lower;
    layout_.batches.back().upper[filled_] = upper;
    last_use_[lower] = last_use_[upper] = batch_number_;
    layout_.spring_of_lane.push_back(spring);
    ++filled_;
  }
  bool take(const Link& link) {
    if (filled_ == kLanes || !is_free(link.lower) || !is_free(link.lower + link.offset)) return false;
    put(link.lower, link.lower + link.offset, link.spring);
    return true;
  }
  void end_batch() {
    std::uint32_t slot = first_;
    const auto next_free = [&] {
      while (!is_free(slot)) ++slot;
      return slot++;
    };
    while (filled_ < kLanes) {
      const std::uint32_t lower = next_free();
      put(lower, next_free(), kNone);
    }
  }

  Layout& layout_;
  std::uint32_t first_, batch_number_ = 0, filled_ = 0;
  Vector<std::uint32_t> last_use_;
};

void add_groups(const Layout& layout, std::span<const std::uint32_t> ends, Vector<Partition>& partitions) {
  for (std::size_t p = 0; p < partitions.size(); ++p) {
    for (std::uint32_t b = partitions[p].first_batch; b < partitions[p].end_batch; ++b) {
      for (std::uint32_t l = 0; l < kLanes; ++l) {
        for (const std::uint32_t slot : {layout.batches[b].lower[l], layout.batches[b].upper[l]}) {
          if (slot < ends[p] || p + 1 == partitions.size()) {
            partitions[p].own_groups.push_back(slot / kLanes);
          } else {
            partitions[p].halo_groups.push_back(slot / kLanes);
            partitions[p + 1].own_groups.push_back(slot / kLanes);
          }
        }
      }
    }
  }
  for (Partition& p : partitions) {
    for (auto* groups : {&p.own_groups, &p.halo_groups}) {
      std::ranges::sort(*groups);
      groups->erase(std::unique(groups->begin(), groups->end()), groups->end());
    }
  }
}

}  // namespace

Layout make_layout(const SpringNetwork& network, std::span<const Vec3> positions) {
  Layout layout;
  order_nodes(network, positions, layout);
  const Vector<Link> links = sorted_links(network, layout.slot_of);
  std::uint32_t farthest = 0;
  for (const Link& link : links) farthest = std::max(farthest, link.offset);
  // a block reaches up to kLanes - 1 slots past its last spring
  const std::uint32_t reach = round_up(farthest + 2 * kLanes, kLanes);
  const Vector<std::uint32_t> ends = partition_ends(links, layout.node_count(), reach);
  layout.halo = ends.size() > 1 ? reach : 0;

  SegmentFinder::Found found = SegmentFinder(links, layout.node_count(), ends).find();
  layout.segments = std::move(found.segments);
  layout.offsets = std::move(found.offsets);
  layout.spring_of_lane = std::move(found.spring_of_lane);
  layout.batch_lanes = static_cast<std::uint32_t>(layout.spring_of_lane.size());
  auto segment = layout.segments.begin();
  auto other = found.others.begin();
  for (const std::uint32_t end : ends) {
    Partition p{};
    p.first = layout.partitions.empty() ? 0 : layout.partitions.back().end;
    p.end = end;
    p.first_segment = static_cast<std::uint32_t>(segment - layout.segments.begin());
    while (segment != layout.segments.end() && segment->first < end) ++segment;
    p.end_segment = static_cast<std::uint32_t>(segment - layout.segments.begin());
    p.first_batch = static_cast<std::uint32_t>(layout.batches.size());
    const auto first_other = other;
    while (other != found.others.end() && other->lower < end) ++other;
    BatchMaker(layout, p.first, layout.node_count())
        .make({std::to_address(first_other), static_cast<std::size_t>(other - first_other)});
    p.end_batch = static_cast<std::uint32_t>(layout.batches.size());
    layout.partitions.push_back(std::move(p));
  }
  add_groups(layout, ends, layout.partitions);

  layout.lane_of_spring.resize(network.spring_count());
  for (std::uint32_t lane = 0; lane < layout.lane_count(); ++lane) {
    if (layout.spring_of_lane[lane] != kNone) layout.lane_of_spring[layout.spring_of_lane[lane]] = lane;
  }
  return layout;
}

}  // namespace crumble
