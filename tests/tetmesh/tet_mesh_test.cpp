#include "crumble/tetmesh/tet_mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "crumble/base/error.hpp"
#include "crumble/base/file.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/random.hpp"
#include "crumble/tetmesh/lattice_box.hpp"
#include "crumble/tetmesh/vtk_file.hpp"

namespace crumble {
namespace {

TEST(TetMesh, LatticeBoxHasTheCountsOfItsCubes) {
  const TetMesh mesh = make_lattice_box({0.03, 0.02, 0.01}, 0.01);
  EXPECT_EQ(mesh.node_count(), 4u * 3 * 2);
  EXPECT_EQ(mesh.tetrahedra.size(), 6u * 6);
  EXPECT_EQ(mesh.boundary.size(), 2u * 2 * (6 + 3 + 2));
  EXPECT_NEAR(volume(mesh), 6e-6, 1e-18);
  EXPECT_NEAR(volume(TriangleMesh{mesh.positions, mesh.boundary}), 6e-6, 1e-18);
}

TEST(TetMesh, SpringsAreTheUniqueEdges) {
  const TetMesh mesh = make_lattice_box({0.03, 0.03, 0.03}, 0.01);
  std::set<std::set<std::uint32_t>> brute;
  for (const Tetrahedron& t : mesh.tetrahedra) {
    for (int i = 0; i < 4; ++i) {
      for (int j = i + 1; j < 4; ++j) brute.insert({t[i], t[j]});
    }
  }
  ASSERT_EQ(mesh.springs.size(), brute.size());
  for (const auto& [i, j] : mesh.springs) EXPECT_TRUE(i < j && brute.count({i, j}));
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    for (std::size_t e = 0; e < 6; ++e) {
      const std::set<std::uint32_t> ends{mesh.tetrahedra[t][kTetEdges[e][0]], mesh.tetrahedra[t][kTetEdges[e][1]]};
      const Edge& spring = mesh.springs[mesh.tet_springs[t][e]];
      EXPECT_EQ(ends, (std::set<std::uint32_t>{spring[0], spring[1]}));
    }
  }
}

TEST(TetMesh, BoundaryIsWhatOneTetrahedronHas) {
  TetMesh mesh = make_lattice_box({0.04, 0.03, 0.03}, 0.01);
  Random random(5);  // tetrahedra and their corners in any order
  Vector<Tetrahedron> tets = mesh.tetrahedra;
  for (std::size_t i = tets.size() - 1; i > 0; --i) std::swap(tets[i], tets[random.below(i + 1)]);
  for (Tetrahedron& t : tets) std::rotate(t.begin(), t.begin() + random.below(3), t.begin() + 3);
  mesh = make_tet_mesh(mesh.positions, tets);
  std::map<std::set<std::uint32_t>, int> count;
  for (const Tetrahedron& t : tets) {
    for (int skip = 0; skip < 4; ++skip) {
      std::set<std::uint32_t> face(t.begin(), t.end());
      face.erase(t[skip]);
      ++count[face];
    }
  }
  const auto single = std::ranges::count_if(count, [](const auto& face) { return face.second == 1; });
  EXPECT_EQ(mesh.boundary.size(), static_cast<std::size_t>(single));
  std::set<std::set<std::uint32_t>> seen;
  for (const Triangle& face : mesh.boundary) {
    const std::set<std::uint32_t> nodes(face.begin(), face.end());
    EXPECT_EQ(count.at(nodes), 1);
    EXPECT_TRUE(seen.insert(nodes).second);
  }
  EXPECT_EQ(find_surface_defects({mesh.positions, mesh.boundary}).total(), 0u);
}

TEST(TetMesh, NodeVolumesSumToTheBody) {
  const TetMesh mesh = make_lattice_box({0.03, 0.03, 0.03}, 0.004);
  double sum = 0;
  for (const double v : mesh.node_volumes) sum += v;
  EXPECT_NEAR(sum / 2.7e-5, 1, 1e-12);
}

Code code_of(Vector<Vec3> positions, Vector<Tetrahedron> tetrahedra) {
  try {
    make_tet_mesh(std::move(positions), std::move(tetrahedra));
  } catch (const Error& error) {
    return error.code();
  }
  return Code{0};
}

TEST(TetMesh, RefusesBadMeshesByName) {
  const Vector<Vec3> corner{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  EXPECT_EQ(code_of(corner, {{0, 1, 2, 3}}), Code{0});
  EXPECT_EQ(code_of({}, {{0, 1, 2, 3}}), Code::empty);
  EXPECT_EQ(code_of(corner, {}), Code::empty);
  EXPECT_EQ(code_of(corner, {{0, 1, 2, 4}}), Code::mesh);
  EXPECT_EQ(code_of(corner, {{0, 2, 1, 3}}), Code::mesh);  // inverted
  auto more = corner;
  more.push_back({2, 2, 2});
  EXPECT_EQ(code_of(more, {{0, 1, 2, 3}}), Code::isolated_node);
  more.back() = corner[1];
  EXPECT_EQ(code_of(more, {{0, 1, 2, 3}}), Code::duplicate_node);
  more.back() = {-0.0, 1, -0.0};  // the same place as (0, 1, 0)
  EXPECT_EQ(code_of(more, {{0, 1, 2, 3}, {0, 1, 4, 3}}), Code::duplicate_node);
  more.back() = {std::nan(""), 0, 0};
  EXPECT_EQ(code_of(more, {{0, 1, 2, 3}}), Code::invalid_value);
  more = corner;
  more.push_back({0, 0, -1}), more.push_back({0.1, 0.1, -2});
  EXPECT_EQ(code_of(more, {{0, 1, 2, 3}, {0, 2, 1, 4}, {0, 2, 1, 5}}), Code::mesh);  // three tetrahedra on a face
}

TEST(VtkFile, HoldsEveryNodeAndTetrahedron) {
  const TetMesh mesh = make_lattice_box({0.02, 0.02, 0.02}, 0.01);
  const auto path = std::filesystem::temp_directory_path() / "crumble_vtk_file_test.vtk";
  write_vtk(mesh, path);
  const std::string text = read_text(path);
  std::filesystem::remove(path);
  EXPECT_NE(text.find("POINTS 27 double\n-0.01 0 -0.01\n"), std::string::npos);
  EXPECT_NE(text.find("CELLS 48 240\n4 0 1 4 13\n"), std::string::npos);
  EXPECT_THROW(write_vtk(mesh, "/nonexistent/folder/mesh.vtk"), Error);
}

}  // namespace
}  // namespace crumble
