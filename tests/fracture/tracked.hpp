// Bodies, cuts and saved states for the tests of FragmentTracker.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <initializer_list>
#include <utility>

#include "crumble/base/memory.hpp"
#include "crumble/fracture/fragment_tracker.hpp"
#include "states.hpp"

namespace crumble::fracture_test {

using Ids = Vector<std::uint32_t>;

/// Nodes and springs, for bodies without tetrahedra.
inline TetMesh make_graph(std::size_t node_count, Vector<Edge> springs) {
  TetMesh graph;
  graph.positions.resize(node_count);
  graph.springs = std::move(springs);
  return graph;
}

inline TetMesh make_chain(std::uint32_t node_count) {
  Vector<Edge> springs;
  for (std::uint32_t i = 0; i + 1 < node_count; ++i) springs.push_back({i, i + 1});
  return make_graph(node_count, springs);
}

/// Several bodies as one, their nodes one after the other.
inline TetMesh make_joint(std::initializer_list<TetMesh> bodies) {
  TetMesh joint;
  for (const TetMesh& body : bodies) {
    const auto first = static_cast<std::uint32_t>(joint.node_count());
    for (const auto& [a, b] : body.springs) joint.springs.push_back({a + first, b + first});
    joint.positions.insert(joint.positions.end(), body.positions.begin(), body.positions.end());
  }
  return joint;
}

/// The springs from one side of a plane across `axis` to the other.
inline Ids springs_across(const TetMesh& mesh, int axis, double place) {
  Ids across;
  for (std::uint32_t s = 0; s < mesh.springs.size(); ++s) {
    const auto [a, b] = mesh.springs[s];
    if ((mesh.positions[a][axis] < place) != (mesh.positions[b][axis] < place)) across.push_back(s);
  }
  return across;
}

inline const TetMesh& small_box() {
  static const TetMesh mesh = make_lattice_box({0.03, 0.03, 0.03}, 0.006);  // 216 nodes
  return mesh;
}

inline const TetMesh& large_box() {
  static const TetMesh mesh = make_lattice_box({0.06, 0.06, 0.06}, 0.003);  // 9261 nodes
  return mesh;
}

/// All springs in random order, in bursts of 0 to `most`.
inline Vector<Ids> random_steps(const TetMesh& body, std::size_t most, Random& random) {
  Vector<Ids> steps;
  const Ids order = random_order(body.springs.size(), random);
  for (std::size_t next = 0; next < order.size();) {
    const std::size_t count = std::min<std::size_t>(random.below(most + 1), order.size() - next);
    steps.emplace_back(order.begin() + static_cast<std::ptrdiff_t>(next),
                       order.begin() + static_cast<std::ptrdiff_t>(next + count));
    next += count;
  }
  return steps;
}

inline std::uint64_t hash_of(const FragmentTracker& tracker) {
  Hash hash;
  tracker.add_to(hash);
  return hash.value();
}

inline Vector<std::uint8_t> saved(const FragmentTracker& tracker) {
  ByteWriter out;
  tracker.save(out);
  return out.bytes();
}

inline FragmentTracker loaded(const TetMesh& body, const Vector<std::uint8_t>& bytes) {
  FragmentTracker tracker(body.node_count(), body.springs);
  tracker.cut(Ids{0, 1}, 3);  // must leave no trace
  ByteReader in(bytes, "snapshot");
  tracker.load(in);
  EXPECT_EQ(in.left(), 0u);
  return tracker;
}

/// Whether records and labels tell the same.
inline bool counts_fit(const FragmentTracker& tracker) {
  Ids counts(tracker.count());
  for (const std::uint32_t label : tracker.labels()) {
    if (label != kNoFragment) ++counts[label];
  }
  for (std::uint32_t id = 0; id < counts.size(); ++id) {
    if (tracker.record(id).node_count != counts[id]) return false;
    if (tracker.record(id).parent != kNoFragment && tracker.record(id).parent >= id) return false;
  }
  return true;
}

}  // namespace crumble::fracture_test
