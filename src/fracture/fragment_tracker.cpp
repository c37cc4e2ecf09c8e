// A cut hardly ever parts anything, and when it does, one part is usually small. So the search starts at both ends of
// each new cut and grows around all of them at the same pace, breadth first, with one queue. Where two growths meet
// they are one group from then on (union-find). A group with no node left in the queue has found all of its part. In a
// fragment that was whole, every part of it now has the end of a cut, so every part has a group: as soon as a single
// group is left growing it must own all nodes that no finished part has, whether it has reached them or not, and the
// search of that fragment is done. The two ends of a first cut meet at a common neighbour, after one or two nodes; a
// plane of 500 cuts costs about as much as labelling the body afresh; a crumb that breaks off a large body costs what
// the crumb costs.
//
// While a search is under way the body goes on breaking. So a search sees the body as it was when it began, at one
// place in the log of cuts: gone_ are the springs cut up to there, cut_ those cut up to now.
//
// All of this is a function of log, labels, settled_end_, search_end_ and the number of nodes expanded. That is what
// load() relies on: it begins the search again and expands that many nodes. remove() therefore takes the expansions in
// the removed fragment out of the number; what is left of the queue is in the order that it would have without it.
#include "crumble/fracture/fragment_tracker.hpp"

#include <algorithm>

#include "fragment_graph.hpp"

namespace crumble {

FragmentTracker::FragmentTracker(std::size_t node_count, std::span<const Edge> springs)
    : graph_(share_new<FragmentGraph>(node_count, springs)),
      labels_(node_count),
      cut_(springs.size()),
      gone_(springs.size()),
      groups_by_node_(node_count),
      queue_(node_count),
      searches_(node_count) {
  log_.reserve(springs.size());
  records_.reserve(node_count);
  splits_.reserve(node_count);
  groups_.reserve(node_count);
  reset();
}

const SpringGraph& FragmentTracker::graph() const noexcept {
  return *graph_;
}

void FragmentTracker::reset() noexcept {
  log_.clear();
  labels_.assign(graph_->parts.begin(), graph_->parts.end());
  records_.clear();
  for (const std::uint32_t size : graph_->part_sizes) records_.push_back({kNoFragment, size, 0});
  settled_end_ = 0;
  splits_.clear();
  cut_.assign(cut_.size(), false);
  gone_.assign(gone_.size(), false);
  forget_search();
}

void FragmentTracker::forget_search() noexcept {
  search_end_ = settled_end_;
  expanded_ = 0;
  std::fill(groups_by_node_.begin(), groups_by_node_.end(), kNoGroup);
  queue_begin_ = queue_end_ = 0;
  groups_.clear();
  unresolved_ = 0;
}

void FragmentTracker::cut(std::span<const std::uint32_t> springs, std::uint64_t step) noexcept {
  for (const std::uint32_t spring : springs) {
    if (!cut_[spring]) note_cut(spring);
  }
  splits_.clear();
  // twice at most: the search under way, and one that looks into all the rest
  for (std::uint32_t budget = kVisitsPerCall; !settled() && budget > 0;) {
    if (!searching()) {
      search_end_ = log_.size();
      seed_search();
    }
    budget -= expand(budget);
    if (unresolved_ == 0) finish_search(step);
  }
}

void FragmentTracker::note_cut(std::uint32_t spring) noexcept {
  cut_[spring] = true;
  log_.push_back(spring);
}

void FragmentTracker::seed_search() noexcept {
  const auto cuts = std::span<const std::uint32_t>(log_).subspan(settled_end_, search_end_ - settled_end_);
  for (const std::uint32_t spring : cuts) {
    const std::uint32_t label = labels_[graph_->springs[spring][0]];  // that of both ends
    if (label != kNoFragment) searches_[label] = {};
    gone_[spring] = true;
  }
  for (const std::uint32_t spring : cuts) {
    for (const std::uint32_t node : graph_->springs[spring]) {
      if (labels_[node] != kNoFragment && groups_by_node_[node] == kNoGroup) add_seed(node);
    }
  }
}

void FragmentTracker::add_seed(std::uint32_t node) noexcept {
  const auto group = static_cast<std::uint32_t>(groups_.size());
  groups_.push_back({group, 1, 1, node, labels_[node]});
  groups_by_node_[node] = group;
  queue_[queue_end_++] = node;
  if (searches_[labels_[node]].open++ == 0) ++unresolved_;
}

// Expands up to `budget` nodes, fewer only when all fragments are done; returns how many.
std::uint32_t FragmentTracker::expand(std::uint32_t budget) noexcept {
  std::uint32_t count = 0;
  while (count < budget && unresolved_ > 0) {
    const std::uint32_t node = queue_[queue_begin_++];
    const std::uint32_t label = labels_[node];
    if (label == kNoFragment || searches_[label].done) continue;
    ++searches_[label].expanded;
    ++count;
    expand_node(node, label);
  }
  expanded_ += count;
  return count;
}

void FragmentTracker::expand_node(std::uint32_t node, std::uint32_t label) noexcept {
  std::uint32_t group = find_root(groups_by_node_[node]);
  const auto neighbors = graph_->neighbors_of(node);
  const std::uint32_t* const springs = graph_->springs_of(node);
  const std::size_t first_new = queue_end_;
  std::size_t end = first_new;
  bool resolved = false;
  for (std::size_t k = 0; k < neighbors.size(); ++k) {
    const std::uint32_t met = groups_by_node_[neighbors[k]];
    if (met == group || gone_[springs[k]]) continue;
    if (met == kNoGroup) {
      groups_by_node_[neighbors[k]] = group;
      queue_[end++] = neighbors[k];
    } else if (const std::uint32_t root = find_root(met); root != group) {
      group = join(group, root);
      if ((resolved = resolve(label))) break;
    }
  }
  queue_end_ = end;
  Group& reached = groups_[group];
  for (std::size_t i = first_new; i < end; ++i) reached.least_node = std::min(reached.least_node, queue_[i]);
  const auto new_count = static_cast<std::uint32_t>(end - first_new);
  reached.node_count += new_count;
  reached.pending += new_count;
  if (resolved || --reached.pending > 0) return;
  close(group, searches_[label]);
  resolve(label);
}

std::uint32_t FragmentTracker::find_root(std::uint32_t group) noexcept {
  while (groups_[group].parent != group) {
    groups_[group].parent = groups_[groups_[group].parent].parent;
    group = groups_[group].parent;
  }
  return group;
}

// Of two roots; returns the one that is left.
std::uint32_t FragmentTracker::join(std::uint32_t a, std::uint32_t b) noexcept {
  Group &root = groups_[std::min(a, b)], &other = groups_[std::max(a, b)];
  other.parent = root.parent;
  root.pending += other.pending;
  root.node_count += other.node_count;
  root.least_node = std::min(root.least_node, other.least_node);
  --searches_[root.label].open;
  return root.parent;
}

bool FragmentTracker::is_larger(std::uint32_t group, std::uint32_t than) const noexcept {
  if (than == kNoGroup) return true;
  const Group &a = groups_[group], &b = groups_[than];
  return a.node_count != b.node_count ? a.node_count > b.node_count : a.least_node < b.least_node;
}

void FragmentTracker::close(std::uint32_t group, Search& search) noexcept {
  --search.open;
  search.finished_nodes += groups_[group].node_count;
  if (is_larger(group, search.largest)) search.largest = group;
}

// Whether it is known which part keeps the id: the last open one, if it is larger than all others, or the largest of
// all when none is open. An open part as large as a finished one goes on until its least node is known.
bool FragmentTracker::resolve(std::uint32_t label) noexcept {
  Search& search = searches_[label];
  if (search.open > 1) return false;
  if (search.open == 1 && search.largest != kNoGroup &&
      records_[label].node_count - search.finished_nodes <= groups_[search.largest].node_count) {
    return false;
  }
  search.done = true;
  --unresolved_;
  return true;
}

void FragmentTracker::finish_search(std::uint64_t step) noexcept {
  const auto first = static_cast<std::ptrdiff_t>(splits_.size());
  for (std::uint32_t g = 0; g < groups_.size(); ++g) {
    const Group& group = groups_[g];
    if (group.parent != g || group.pending > 0 || group.label == kNoFragment) continue;
    const Search& search = searches_[group.label];
    if (search.open == 0 && search.largest == g) continue;
    splits_.push_back({g, group.label, group.least_node, group.node_count});  // the group, until the ids are given
  }
  std::sort(splits_.begin() + first, splits_.end(),
            [](const FragmentSplit& a, const FragmentSplit& b) { return a.node < b.node; });
  for (FragmentSplit& split : std::span(splits_).subspan(static_cast<std::size_t>(first))) {
    const auto id = static_cast<std::uint32_t>(records_.size());
    groups_[split.fragment].label = id;
    split.fragment = id;
    records_[split.parent].node_count -= split.node_count;
    records_.push_back({split.parent, split.node_count, step});
  }
  relabel();
}

// Writes the groups' labels to the nodes reached, and clears the search.
void FragmentTracker::relabel() noexcept {
  for (std::size_t i = 0; i < queue_end_; ++i) {
    const std::uint32_t node = queue_[i];
    labels_[node] = groups_[find_root(groups_by_node_[node])].label;
    groups_by_node_[node] = kNoGroup;
  }
  groups_.clear();
  queue_begin_ = queue_end_ = 0;
  expanded_ = 0;
  settled_end_ = search_end_;
}

void FragmentTracker::remove(std::uint32_t fragment) noexcept {
  if (fragment >= count() || records_[fragment].node_count == 0) return;
  std::replace(labels_.begin(), labels_.end(), fragment, kNoFragment);
  records_[fragment].node_count = 0;
  bool searched = false;
  for (Group& group : groups_) {
    if (group.label != fragment) continue;
    group.label = kNoFragment;
    searched = true;
  }
  if (!searched) return;
  expanded_ -= searches_[fragment].expanded;
  if (!searches_[fragment].done) --unresolved_;
}

}  // namespace crumble
