#include "crumble/tetmesh/quality.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "crumble/tetmesh/lattice_box.hpp"

namespace crumble {
namespace {

TEST(Quality, RegularTetrahedron) {
  const double angle = std::acos(1.0 / 3) * 180 / M_PI;
  for (const double a : dihedral_angles({1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1})) EXPECT_NEAR(a, angle, 1e-12);
  const TetMesh mesh = make_tet_mesh({{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}, {{0, 2, 1, 3}});
  const MeshQuality q = measure_quality(mesh);
  EXPECT_NEAR(q.volume_length_mean, 1, 1e-14);
  EXPECT_NEAR(q.edge_mean, std::sqrt(8.0), 1e-14);
  EXPECT_NEAR(q.edge_variation, 0, 1e-14);
  EXPECT_EQ(q.euler_defect, 0);
  EXPECT_EQ(q.slivers, 0u);
}

TEST(Quality, KuhnTetrahedraHaveKnownAngles) {
  const MeshQuality q = measure_quality(make_lattice_box({0.03, 0.03, 0.03}, 0.01));
  EXPECT_NEAR(q.dihedral_min, 45, 1e-9);
  EXPECT_NEAR(q.dihedral_max, 90, 1e-9);
  EXPECT_EQ(q.euler_defect, 0);
  EXPECT_EQ(q.boundary_defects.total(), 0u);
}

TEST(Quality, SeesAHoleAndAPinch) {
  TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  EXPECT_EQ(find_surface_defects(tetrahedron).total(), 0u);
  EXPECT_NEAR(volume(tetrahedron), 1.0 / 6, 1e-15);
  TriangleMesh open = tetrahedron;
  open.triangles.pop_back();
  EXPECT_EQ(find_surface_defects(open).open_edges, 3u);
  TriangleMesh flipped = tetrahedron;
  std::swap(flipped.triangles[0][0], flipped.triangles[0][1]);
  EXPECT_EQ(find_surface_defects(flipped).flipped_edges, 3u);
  // two tetrahedra that meet in vertex 0 only
  TriangleMesh pinched = tetrahedron;
  for (const Vec3& v : {Vec3(-1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, -1)}) pinched.vertices.push_back(v);
  for (const Triangle& t : {Triangle{0, 4, 5}, Triangle{0, 6, 4}, Triangle{4, 6, 5}, Triangle{5, 6, 0}})
    pinched.triangles.push_back(t);
  const SurfaceDefects defects = find_surface_defects(pinched);
  EXPECT_EQ(defects.split_vertices, 1u);
  EXPECT_EQ(defects.total(), 1u);
}

}  // namespace
}  // namespace crumble
