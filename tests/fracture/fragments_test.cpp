#include "crumble/fracture/fragments.hpp"

#include <gtest/gtest.h>

#include "crumble/base/memory.hpp"
#include "states.hpp"
#include "support/allocation_counter.hpp"

namespace crumble {
namespace {

using namespace fracture_test;

/// Inertia of a point mass.
Mat3 point_inertia(double mass, const Vec3& arm) {
  Mat3 inertia;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) inertia(i, j) = mass * ((i == j ? dot(arm, arm) : 0) - arm[i] * arm[j]);
  }
  return inertia;
}

/// Of a box of equal point masses, `counts` along the axes, `spacing` apart, about its middle.
Mat3 box_inertia(double mass, const Vec3& counts, double spacing) {
  const double all = mass * counts.x() * counts.y() * counts.z();
  Vec3 squares;  // mean square distance along each axis
  for (int axis = 0; axis < 3; ++axis) squares[axis] = spacing * spacing * (counts[axis] * counts[axis] - 1) / 12;
  Mat3 inertia = Mat3::Zero();
  for (int axis = 0; axis < 3; ++axis) inertia(axis, axis) = all * (squares[(axis + 1) % 3] + squares[(axis + 2) % 3]);
  return inertia;
}

/// A body with the labels of a random state; some fragments removed.
struct Labelled {
  explicit Labelled(double cut_share, bool remove) : mesh(make_lattice_box({0.03, 0.025, 0.02}, 0.005)) {
    Random random(24);
    FragmentLabeler labeler(mesh.node_count(), mesh.springs);
    count = labeler.label(random_flags(mesh.springs.size(), cut_share, random));
    labels.assign(labeler.labels().begin(), labeler.labels().end());
    if (!remove) return;
    for (std::uint32_t& label : labels) label = label % 3 == 1 ? kNoFragment : label;
  }
  TetMesh mesh;
  Vector<std::uint32_t> labels;
  std::size_t count;
};

TEST(Fragments, EqualFloodingAfterEveryStepOfRandomCuts) {
  Random random(21);
  const TetMesh mesh = make_lattice_box({0.03, 0.03, 0.03}, 0.006);
  for (int run = 0; run < 5; ++run) {
    FragmentLabeler labeler(mesh.node_count(), mesh.springs);
    Flags intact(mesh.springs.size(), 1);
    const auto order = random_order(mesh.springs.size(), random);
    for (std::size_t next = 0; next < order.size();) {
      const std::size_t burst = std::min<std::size_t>(1 + random.below(12), order.size() - next);
      for (const std::size_t end = next + burst; next < end; ++next) intact[order[next]] = 0;
      const auto expected = flood_labels(mesh, intact);
      ASSERT_EQ(labeler.label(intact), label_count(expected));
      ASSERT_TRUE(std::equal(expected.begin(), expected.end(), labeler.labels().begin(), labeler.labels().end()));
      ASSERT_EQ(labeler.count(), label_count(expected));
    }
    EXPECT_EQ(labeler.count(), mesh.node_count());
  }
}

TEST(Fragments, LongChainsInAnyOrder) {
  // Paths in random numbering: the deepest trees a union-find can meet.
  Random random(22);
  const std::size_t count = 2000;
  const auto order = random_order(count, random);
  Vector<Edge> springs;
  for (std::size_t i = 0; i + 1 < count; ++i) {
    springs.push_back({std::min(order[i], order[i + 1]), std::max(order[i], order[i + 1])});
  }
  FragmentLabeler labeler(count, springs);
  Flags intact(springs.size(), 1);
  EXPECT_EQ(labeler.label(intact), 1u);
  intact[999] = 0;
  EXPECT_EQ(labeler.label(intact), 2u);
  for (std::size_t i = 0; i < count; ++i) {
    EXPECT_EQ(labeler.labels()[order[i]] == labeler.labels()[order[0]], i < 1000) << i;
  }
}

TEST(Fragments, MeasuresAddUpToTheBody) {
  Random random(23);
  const TetMesh mesh = make_lattice_box({0.03, 0.03, 0.03}, 0.005);
  Vector<double> masses;
  VecArray positions(mesh.node_count());
  for (std::size_t i = 0; i < mesh.node_count(); ++i) {
    masses.push_back(random.uniform(1e-5, 3e-5));
    positions.set(i, mesh.positions[i] + Vec3(random.uniform(), 0, 0) * 1e-3);
  }
  for (const double share : {0.0, 0.3, 0.6, 0.8, 0.9, 1.0}) {
    const Flags intact = random_flags(mesh.springs.size(), share, random);
    FragmentLabeler labeler(mesh.node_count(), mesh.springs);
    Vector<Fragment> fragments(labeler.label(intact));
    measure_fragments(mesh, labeler.labels(), masses, positions, fragments);
    Fragment sum;
    for (std::uint32_t f = 0; f < fragments.size(); ++f) {
      const Fragment& fragment = fragments[f];
      EXPECT_TRUE(f == 0 || fragment.least_node > fragments[f - 1].least_node);
      EXPECT_EQ(labeler.labels()[fragment.least_node], f);
      sum.node_count += fragment.node_count;
      sum.rest_volume += fragment.rest_volume;
      sum.mass += fragment.mass;
      sum.center += fragment.mass * fragment.center;
    }
    EXPECT_EQ(sum.node_count, mesh.node_count());
    EXPECT_NEAR(sum.rest_volume, volume(mesh), 1e-12 * volume(mesh));
    double mass = 0;
    Vec3 moment = Vec3::Zero();
    for (std::size_t i = 0; i < masses.size(); ++i) mass += masses[i], moment += masses[i] * positions[i];
    EXPECT_NEAR(sum.mass, mass, 1e-12 * mass);
    EXPECT_NEAR(norm(sum.center - moment), 0, 1e-12 * norm(moment));
    if (share == 0.0) {
      EXPECT_EQ(fragments[0].tetrahedron_count, mesh.tetrahedra.size());
    }
    if (share == 1.0) {
      EXPECT_EQ(fragments[0].tetrahedron_count, 0u);
    }
  }
}

// A freed corner owns a quarter of its only tetrahedron, which then is whole in no fragment.
TEST(Fragments, BrokenTetrahedronIsSharedByCorners) {
  const TetMesh mesh = make_tet_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}});
  Flags intact(6, 1);
  for (std::size_t s = 0; s < 6; ++s) intact[s] = mesh.springs[s][0] != 0;
  FragmentLabeler labeler(4, mesh.springs);
  Vector<Fragment> fragments(labeler.label(intact));
  ASSERT_EQ(fragments.size(), 2u);
  measure_fragments(mesh, labeler.labels(), Vector<double>{1, 1, 1, 1}, VecArray(mesh.positions), fragments);
  EXPECT_NEAR(fragments[0].rest_volume, 1.0 / 24, 1e-15);
  EXPECT_NEAR(fragments[1].rest_volume, 3.0 / 24, 1e-15);
  EXPECT_EQ(fragments[0].tetrahedron_count + fragments[1].tetrahedron_count, 0u);
  EXPECT_NEAR(norm(fragments[1].center - Vec3(1, 1, 1) / 3), 0, 1e-15);
}

TEST(Fragments, InertiaOfABoxOfEqualMasses) {
  // 7 x 5 x 6 nodes, moved away from the origin; whole, and in two with 3 and 4 layers along x
  TetMesh mesh = make_lattice_box({0.03, 0.02, 0.025}, 0.005);
  const Vec3 offset(0.3, -0.2, 0.7);
  const double mass = 2e-5;
  const Vector<double> masses(mesh.node_count(), mass);
  VecArray positions(mesh.node_count());
  Vector<std::uint32_t> one(mesh.node_count()), two(mesh.node_count());
  for (std::size_t i = 0; i < mesh.node_count(); ++i) {
    positions.set(i, mesh.positions[i] + offset);
    two[i] = mesh.positions[i].x() > -0.0025;
  }
  Vector<Fragment> whole(1), halves(2);
  measure_fragments(mesh, one, masses, positions, whole);
  measure_fragments(mesh, two, masses, positions, halves);

  const auto expect_inertia = [](const Mat3& inertia, const Mat3& expected) {
    EXPECT_LT((inertia - expected).cwiseAbs().maxCoeff(), 1e-12 * expected.trace()) << inertia << "\n" << expected;
  };
  expect_inertia(whole[0].inertia, box_inertia(mass, {7, 5, 6}, 0.005));
  expect_inertia(halves[0].inertia, box_inertia(mass, {3, 5, 6}, 0.005));
  expect_inertia(halves[1].inertia, box_inertia(mass, {4, 5, 6}, 0.005));
  Mat3 joined = Mat3::Zero();  // parallel axes
  for (const Fragment& half : halves) {
    joined += half.inertia + point_inertia(half.mass, half.center - whole[0].center);
  }
  expect_inertia(joined, whole[0].inertia);
  EXPECT_NEAR(norm(whole[0].low - (offset + Vec3(-0.015, 0, -0.0125))), 0, 1e-15);
  EXPECT_NEAR(norm(whole[0].high - (offset + Vec3(0.015, 0.02, 0.0125))), 0, 1e-15);
  EXPECT_NEAR(halves[0].high.x(), offset.x() - 0.005, 1e-15);
  EXPECT_NEAR(halves[1].low.x(), offset.x(), 1e-15);
}

TEST(Fragments, MeasuresEqualSumsOverTheirNodes) {
  Random random(25);
  const Labelled body(0.8, true);
  const std::size_t node_count = body.mesh.node_count();
  Vector<double> masses;
  VecArray positions(node_count), velocities(node_count);
  for (std::size_t i = 0; i < node_count; ++i) {
    masses.push_back(random.uniform(1e-5, 3e-5));
    positions.set(i, body.mesh.positions[i] + Vec3(random.uniform(), random.uniform(), 1) * 1e-2);
    velocities.set(i, {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
  }
  Vector<Fragment> fragments(body.count), resting(body.count);
  measure_fragments(body.mesh, body.labels, masses, positions, fragments, velocities);
  measure_fragments(body.mesh, body.labels, masses, positions, resting);
  ASSERT_GT(body.count, 6u);
  for (std::uint32_t id = 0; id < body.count; ++id) {
    std::uint32_t count = 0, least = 0;
    double mass = 0, rest_volume = 0;
    Vec3 moment = Vec3::Zero(), momentum = Vec3::Zero(), low = Vec3::Zero(), high = Vec3::Zero();
    Mat3 about_origin = Mat3::Zero();
    for (std::uint32_t i = 0; i < node_count; ++i) {
      if (body.labels[i] != id) continue;
      if (count++ == 0) least = i, low = high = positions[i];
      mass += masses[i], rest_volume += body.mesh.node_volumes[i];
      moment += masses[i] * positions[i], momentum += masses[i] * velocities[i];
      about_origin += point_inertia(masses[i], positions[i]);
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], positions[i][axis]), high[axis] = std::max(high[axis], positions[i][axis]);
      }
    }
    const Fragment& fragment = fragments[id];
    ASSERT_EQ(fragment.node_count, count);
    ASSERT_EQ(count == 0, id % 3 == 1);
    EXPECT_EQ(fragment.least_node, least);
    EXPECT_EQ(fragment.low, low);
    EXPECT_EQ(fragment.high, high);
    EXPECT_NEAR(fragment.mass, mass, 1e-12 * mass);
    EXPECT_NEAR(fragment.rest_volume, rest_volume, 1e-12 * rest_volume);
    EXPECT_NEAR(norm(fragment.mass * fragment.center - moment), 0, 1e-12 * norm(moment));
    EXPECT_NEAR(norm(fragment.mass * fragment.velocity - momentum), 0, 1e-12 * mass);
    const Mat3 expected = about_origin - point_inertia(fragment.mass, fragment.center);
    EXPECT_LT((fragment.inertia - expected).cwiseAbs().maxCoeff(), 1e-12 * (1e-20 + about_origin.trace()));
    EXPECT_EQ(resting[id].velocity, Vec3(Vec3::Zero()));
    EXPECT_EQ(resting[id].inertia, fragment.inertia);
  }
}

TEST(FragmentLists, EqualASearchThroughTheBody) {
  for (const double share : {0.0, 0.5, 0.8, 0.9, 1.0}) {
    for (const bool remove : {false, true}) {
      const Labelled body(share, remove);
      FragmentLists lists(body.mesh);
      EXPECT_TRUE(lists.nodes(0).empty());
      // before, another state with more fragments: nothing of it may be left
      Vector<std::uint32_t> alone(body.mesh.node_count());
      std::iota(alone.begin(), alone.end(), 0u);
      lists.update(alone, alone.size());
      EXPECT_EQ(lists.nodes(17).front(), 17u);
      lists.update(body.labels, body.count);
      Vector<Fragment> fragments(body.count);
      measure_fragments(body.mesh, body.labels, Vector<double>(alone.size(), 1), VecArray(body.mesh.positions),
                        fragments);
      for (std::uint32_t id = 0; id < body.count; ++id) {
        Vector<std::uint32_t> nodes, tetrahedra;
        for (std::uint32_t i = 0; i < body.labels.size(); ++i) {
          if (body.labels[i] == id) nodes.push_back(i);
        }
        for (std::uint32_t t = 0; t < body.mesh.tetrahedra.size(); ++t) {
          const auto& corners = body.mesh.tetrahedra[t];
          if (std::count_if(corners.begin(), corners.end(), [&](auto c) { return body.labels[c] == id; }) == 4) {
            tetrahedra.push_back(t);
          }
        }
        ASSERT_TRUE(std::equal(nodes.begin(), nodes.end(), lists.nodes(id).begin(), lists.nodes(id).end())) << id;
        ASSERT_TRUE(
            std::equal(tetrahedra.begin(), tetrahedra.end(), lists.tetrahedra(id).begin(), lists.tetrahedra(id).end()))
            << id;
        ASSERT_EQ(fragments[id].tetrahedron_count, tetrahedra.size());
      }
      EXPECT_TRUE(lists.nodes(static_cast<std::uint32_t>(body.count)).empty());
      EXPECT_TRUE(lists.tetrahedra(kNoFragment).empty());
    }
  }
}

TEST(FragmentLists, TakesNoMemory) {
  if (!AllocationCounter::available()) GTEST_SKIP() << "allocations are not counted in this build";
  const Labelled body(0.8, true);
  const Vector<double> masses(body.mesh.node_count(), 1e-5);
  const VecArray positions(body.mesh.positions);
  Vector<Fragment> fragments(body.count);
  FragmentLists lists(body.mesh);
  std::size_t allocations = 0;
  {
    AllocationCounter counter;
    lists.update(body.labels, body.count);
    measure_fragments(body.mesh, body.labels, masses, positions, fragments, positions);
    allocations = counter.count();
  }
  EXPECT_EQ(allocations, 0u);
}

}  // namespace
}  // namespace crumble
