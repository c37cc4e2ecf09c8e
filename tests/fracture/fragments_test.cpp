#include "crumble/fracture/fragments.hpp"

#include <gtest/gtest.h>

#include "states.hpp"

namespace crumble {
namespace {

using namespace fracture_test;

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
  std::vector<Edge> springs;
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
  std::vector<double> masses;
  VecArray positions(mesh.node_count());
  for (std::size_t i = 0; i < mesh.node_count(); ++i) {
    masses.push_back(random.uniform(1e-5, 3e-5));
    positions.set(i, mesh.positions[i] + Vec3(random.uniform(), 0, 0) * 1e-3);
  }
  for (const double share : {0.0, 0.3, 0.6, 0.8, 0.9, 1.0}) {
    const Flags intact = random_flags(mesh.springs.size(), share, random);
    FragmentLabeler labeler(mesh.node_count(), mesh.springs);
    std::vector<Fragment> fragments(labeler.label(intact));
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
  std::vector<Fragment> fragments(labeler.label(intact));
  ASSERT_EQ(fragments.size(), 2u);
  measure_fragments(mesh, labeler.labels(), std::vector<double>{1, 1, 1, 1}, VecArray(mesh.positions), fragments);
  EXPECT_NEAR(fragments[0].rest_volume, 1.0 / 24, 1e-15);
  EXPECT_NEAR(fragments[1].rest_volume, 3.0 / 24, 1e-15);
  EXPECT_EQ(fragments[0].tetrahedron_count + fragments[1].tetrahedron_count, 0u);
  EXPECT_NEAR(norm(fragments[1].center - Vec3(1, 1, 1) / 3), 0, 1e-15);
}

}  // namespace
}  // namespace crumble
