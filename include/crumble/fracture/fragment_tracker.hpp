// Fragments with ids that last: what falls apart is found in the step, near the cuts that caused it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "crumble/base/bytes.hpp"
#include "crumble/base/hash.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/reserved_vector.hpp"
#include "crumble/fracture/fragments.hpp"
#include "crumble/tetmesh/tet_mesh.hpp"

namespace crumble {

struct FragmentGraph;
struct SpringGraph;

/// One fragment's line in the family book. A fragment's nodes become fewer as others come off it.
struct FragmentRecord {
  std::uint32_t parent = kNoFragment;  // kNoFragment: there from the start
  std::uint32_t node_count = 0;        // 0: removed
  std::uint64_t born = 0;              // step in which it was found; 0 for those there from the start
};

/// A fragment that came off another.
struct FragmentSplit {
  std::uint32_t fragment;    // the new one
  std::uint32_t parent;      // what it came off
  std::uint32_t node;        // its least node then
  std::uint32_t node_count;  // when it came off
};

/// Keeps the fragments of one body while its springs are cut. Ids are dense and never used again. When a fragment falls
/// apart, the part with most nodes (of equals the one with the least node) keeps the id; the others get new ids, in the
/// order of their least nodes. A body made of several parts starts with several ids, in that order too.
///
/// A call expands no more than kVisitsPerCall nodes (reads their springs); a search that needs more goes on in the next
/// call, and the cuts that come meanwhile wait for the search after it. So ids are exact after every call for bodies of
/// up to kVisitsPerCall nodes, and may lag a few calls behind for larger ones: then parts that are apart still share an
/// id, never the other way round. That lag is state: it is hashed, saved and restored.
///
/// Lives in the step: after construction nothing allocates but save(), load() and copying. Copies are independent. One
/// thread at a time.
class FragmentTracker {
 public:
  static constexpr std::uint32_t kVisitsPerCall = 4096;

  /// `springs` are copied. Throws Error: out_of_range (a spring's node), too_large (2^32 - 1 nodes, 2^31 springs).
  FragmentTracker(std::size_t node_count, std::span<const Edge> springs);

  /// Takes note of the springs that step `step` has cut, and finds what they have parted. To be called in every step,
  /// also when nothing was cut. `step` must not descend; a spring that was cut before is ignored.
  void cut(std::span<const std::uint32_t> springs, std::uint64_t step) noexcept;

  /// Fragment of each node (node_count); kNoFragment where the fragment was removed.
  std::span<const std::uint32_t> labels() const noexcept { return labels_; }
  /// Ids given so far: all below count() are, those of removed fragments too. At most node_count.
  std::size_t count() const noexcept { return records_.size(); }
  const FragmentRecord& record(std::uint32_t fragment) const noexcept { return records_[fragment]; }
  /// What the last cut() found, in the order of the ids. Empty after load().
  std::span<const FragmentSplit> splits() const noexcept { return splits_; }
  /// Whether every cut so far has been looked into: the labels are exact.
  bool settled() const noexcept { return settled_end_ == log_.size(); }

  /// The host has taken a fragment away: its nodes belong to none from now on, and its id stays unused. With a search
  /// under way that means all that still has the id. Nothing happens to an id that is not there. Scans all nodes.
  void remove(std::uint32_t fragment) noexcept;

  /// Back to the whole body.
  void reset() noexcept;

  /// The springs of the unbroken body. Valid as long as this tracker or a copy of it.
  const SpringGraph& graph() const noexcept;

  /// load() throws Error(corrupt) for what save() cannot have written for this body, and then changes nothing.
  void save(ByteWriter& out) const;
  void load(ByteReader& in);
  void add_to(Hash& hash) const noexcept;

 private:
  // A seed and all that the search has reached from it. Groups that meet are joined in a tree whose root speaks for
  // all.
  struct Group {
    std::uint32_t parent;      // in the tree; a root is its own
    std::uint32_t pending;     // nodes that wait in the queue
    std::uint32_t node_count;  // nodes reached
    std::uint32_t least_node;  // of those
    std::uint32_t label;       // of its nodes, now and after the search; kNoFragment: removed
  };
  // How far the search has come in one fragment.
  struct Search {
    std::uint32_t open = 0;            // groups with nodes that wait
    std::uint32_t finished_nodes = 0;  // in the groups without
    std::uint32_t largest = kNoGroup;  // of those: the one with most nodes
    std::uint32_t expanded = 0;        // nodes
    bool done = false;
  };
  static constexpr std::uint32_t kNoGroup = 0xffffffffu;

  bool searching() const noexcept { return search_end_ > settled_end_; }
  void note_cut(std::uint32_t spring) noexcept;
  void seed_search() noexcept;
  void add_seed(std::uint32_t node) noexcept;
  std::uint32_t expand(std::uint32_t budget) noexcept;
  void expand_node(std::uint32_t node, std::uint32_t label) noexcept;
  std::uint32_t find_root(std::uint32_t group) noexcept;
  std::uint32_t join(std::uint32_t a, std::uint32_t b) noexcept;
  bool is_larger(std::uint32_t group, std::uint32_t than) const noexcept;
  void close(std::uint32_t group, Search& search) noexcept;
  bool resolve(std::uint32_t label) noexcept;
  void finish_search(std::uint64_t step) noexcept;
  void relabel() noexcept;
  void forget_search() noexcept;
  void load_log(ByteReader& in);
  void load_records(ByteReader& in);
  void load_labels(ByteReader& in);
  void resume_search(std::uint64_t search_end, std::uint32_t expanded);

  std::shared_ptr<const FragmentGraph> graph_;  // immutable

  // What is saved and hashed.
  ReservedVector<std::uint32_t> log_;  // springs in the order of their cuts
  Vector<std::uint32_t> labels_;
  ReservedVector<FragmentRecord> records_;
  std::size_t settled_end_ = 0;  // the labels are exact for the log up to here
  std::size_t search_end_ = 0;   // the search looks into the cuts from there to here; equal: none is under way
  std::uint32_t expanded_ = 0;   // nodes that it has expanded, without those of removed fragments

  // What follows from that, and room to work.
  ReservedVector<FragmentSplit> splits_;
  Vector<bool> cut_, gone_;               // springs: cut so far, and of those up to search_end_ (spring_count)
  Vector<std::uint32_t> groups_by_node_;  // or kNoGroup
  Vector<std::uint32_t> queue_;           // nodes reached, each once (node_count)
  std::size_t queue_begin_ = 0, queue_end_ = 0;
  ReservedVector<Group> groups_;
  Vector<Search> searches_;       // by fragment; stale for those that have no group
  std::uint32_t unresolved_ = 0;  // fragments whose search is not done
};

}  // namespace crumble
