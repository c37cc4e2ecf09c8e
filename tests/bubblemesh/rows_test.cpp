// Rows, places and lattice neighbours of the relaxed structure, and runs of springs.
#include <gtest/gtest.h>

#include <cmath>

#include "bubblemesh/lattice.hpp"
#include "crumble/bubblemesh/generate.hpp"
#include "crumble/tetmesh/lattice_box.hpp"

namespace crumble {
namespace {

BubbleMesh relaxed(const Shape& shape, Lattice lattice) {
  BubbleMeshOptions options;
  options.spacing = 1;
  options.lattice = lattice;
  return generate(shape, options);
}

TEST(Rows, HoldEveryNodeOnceInOrder) {
  const BubbleMesh body = relaxed(*make_cylinder(4, 9), Lattice::hcp);
  std::uint32_t next = 0;
  for (std::size_t r = 0; r < body.rows.size(); ++r) {
    const LatticeRow& row = body.rows[r];
    EXPECT_EQ(row.first, next);
    EXPECT_GT(row.count, 0u);
    next += row.count;
    if (r > 0) {
      EXPECT_LT(std::pair(body.rows[r - 1].layer, body.rows[r - 1].row), std::pair(row.layer, row.row));
    }
    for (std::uint32_t k = 1; k < row.count; ++k) {
      EXPECT_LE(body.places[row.first + k - 1], body.places[row.first + k]);
    }
  }
  EXPECT_EQ(next, body.mesh.node_count());
  EXPECT_EQ(body.places.size(), body.mesh.node_count());
}

// Deep inside all octahedra are cut along one direction: nothing but lattice neighbours, at two distances.
TEST(Rows, DeepSpringsAllJoinLatticeNeighbours) {
  for (const Lattice lattice : {Lattice::hcp, Lattice::fcc}) {
    const auto box = make_box({15, 15, 15});
    const BubbleMesh body = relaxed(*box, lattice);
    std::size_t deep = 0, long_ones = 0;
    for (std::size_t s = 0; s < body.mesh.springs.size(); ++s) {
      const Vec3 &a = body.mesh.positions[body.mesh.springs[s][0]], &b = body.mesh.positions[body.mesh.springs[s][1]];
      const double depth = -std::max(box->signed_distance(a), box->signed_distance(b));
      if (depth < 3) {  // moved nodes never count, though some of their springs are as long as the lattice's
        EXPECT_EQ(body.lattice_neighbours[s], 0) << depth;
      }
      if (depth < 4.6) continue;
      EXPECT_EQ(body.lattice_neighbours[s], 1);
      const double length = norm(b - a);
      const bool diagonal = length > 1.2;
      EXPECT_NEAR(length, diagonal ? std::sqrt(2.0) : 1, 1e-12);
      if (diagonal) {
        EXPECT_NEAR(b.x(), a.x(), 1e-12);
        EXPECT_GT(std::abs(b.y() - a.y()), 0.5);
      }
      ++deep, long_ones += diagonal;
    }
    EXPECT_GT(deep, 700u);
    EXPECT_NEAR(static_cast<double>(long_ones) / static_cast<double>(deep), 1.0 / 7, 0.03);
  }
}

TEST(Rows, SpringsOfTheDefaultBodiesStandInRuns) {
  EXPECT_GE(share_in_runs(relaxed(*make_box({7, 7, 7}), Lattice::hcp).mesh, 4), 0.70);
  EXPECT_GE(share_in_runs(relaxed(*make_box({20, 20, 20}), Lattice::hcp).mesh, 4), 0.91);
}

TEST(Rows, RunsAreCountedByHand) {
  // one cube of six tetrahedra: offsets 1 from 0 2 4 6, 2 from 0 1 4 5, 3 from 0 and 4, 4 from 0 1 2 3, 5 from 0 and 2,
  // 6 from 0 and 1, 7 from 0
  const TetMesh cube = make_lattice_box({1, 1, 1}, 1);
  ASSERT_EQ(cube.springs.size(), 19u);
  EXPECT_DOUBLE_EQ(share_in_runs(cube, 1), 1);
  EXPECT_DOUBLE_EQ(share_in_runs(cube, 2), (2 + 2 + 4 + 2) / 19.0);
  EXPECT_DOUBLE_EQ(share_in_runs(cube, 4), 4 / 19.0);
  EXPECT_DOUBLE_EQ(share_in_runs(cube, 5), 0);
}

}  // namespace
}  // namespace crumble
