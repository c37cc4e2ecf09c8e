// `crumble mesh`.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "crumble/base/file.hpp"
#include "crumble/base/memory.hpp"
#include "render/temporary_folder.hpp"
#include "support/mesh_files.hpp"

namespace crumble::cli {
namespace {

using nlohmann::json;
using render::TemporaryFolder;

json mesh_json(Vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "mesh");
  arguments.push_back("--json");
  const Outcome outcome = crumble(arguments);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  return json::parse(outcome.out);
}

TEST(Mesh, PrintsOneJsonObject) {
  const json cube = mesh_json({"cube"});
  EXPECT_EQ(cube.at("nodes"), 600);
  EXPECT_EQ(cube.at("surface_nodes"), 306);
  EXPECT_EQ(cube.at("boundary_defects"), 0);
  EXPECT_EQ(cube.at("euler_defect"), 0);
  EXPECT_EQ(cube.at("slivers"), 0);
  EXPECT_NEAR(cube.at("volume_m3").get<double>(), 27e-6, 1e-12);
  EXPECT_GT(cube.at("dihedral_min_degrees"), 10);
  EXPECT_LT(cube.at("dihedral_max_degrees"), 170);
  EXPECT_NEAR(cube.at("edge_mean_m").get<double>(), 0.0044, 0.0006);
  EXPECT_TRUE(cube.at("warnings").is_array());
}

TEST(Mesh, MakesEveryShape) {
  EXPECT_EQ(mesh_json({"slab"}).at("nodes"), 382 + 314);
  EXPECT_EQ(mesh_json({"globe"}).at("surface_nodes"), 305);
  EXPECT_EQ(mesh_json({"globe_literal"}).at("surface_nodes"), 370);
  const double pi = 3.14159265358979;
  const json box = mesh_json({"box", "0.02", "0.03", "0.04", "--spacing", "0.006", "--lattice", "fcc"});
  EXPECT_NEAR(box.at("volume_m3").get<double>(), 24e-6, 1e-12);
  const json sphere = mesh_json({"sphere", "0.02", "--spacing", "0.005", "--offset", "0.1", "0.2", "0.3"});
  EXPECT_NEAR(sphere.at("volume_m3").get<double>(), 4 * pi / 3 * 8e-6, 3e-6);
  const json cylinder = mesh_json({"cylinder", "0.02", "0.03", "--spacing", "0.005"});
  EXPECT_NEAR(cylinder.at("volume_m3").get<double>(), pi * 4e-4 * 0.03, 3e-6);
}

TEST(Mesh, SaysHowMuchOfItIsLattice) {
  const json relaxed = mesh_json({"box", "0.03", "0.03", "0.03", "--spacing", "0.003"});
  EXPECT_EQ(relaxed.at("structure"), "relaxed");
  EXPECT_LT(relaxed.at("lattice_neighbour_share"), 0.2);
  EXPECT_GT(relaxed.at("share_in_runs_of_4"), 0.75);
  const json lattice = mesh_json({"box", "0.03", "0.03", "0.03", "--spacing", "0.003", "--structure", "lattice"});
  EXPECT_EQ(lattice.at("structure"), "lattice");
  EXPECT_EQ(lattice.at("rows"), 15 * 11);  // 30 mm / (3 mm / sqrt 2) = 14.1 layers high, ten squares and one more row
  EXPECT_GT(lattice.at("lattice_neighbour_share"), 0.97);
  EXPECT_LT(lattice.at("lattice_neighbour_share"), 1);
  EXPECT_GT(lattice.at("share_in_runs_of_4"), 0.99);
  EXPECT_EQ(mesh_json({"cube", "--structure", "lattice"}).at("structure"), "lattice");
}

TEST(Mesh, WritesMeshAndSurface) {
  const TemporaryFolder folder;
  const json cube = mesh_json({"cube", "--out", folder.file("cube.vtk").string()});
  const std::string vtk = read_text(folder.file("cube.vtk"));
  EXPECT_NE(vtk.find("POINTS 600 double"), std::string::npos);
  EXPECT_NE(vtk.find("CELLS " + cube.at("tetrahedra").dump()), std::string::npos);
  mesh_json({"cube", "--out", folder.file("cube.ply").string()});
  const TriangleMesh surface = read_ply(folder.file("cube.ply")).mesh;
  EXPECT_EQ(find_surface_defects(surface).total(), 0u);
  EXPECT_EQ(surface.triangles.size(), 2 * (306u - 2));
  EXPECT_NEAR(volume(surface), 27e-6, 1e-10);
  mesh_json({"cube", "--out", folder.file("cube.vtu").string()});
  const VtuFile body = read_vtu(folder.file("cube.vtu"));
  EXPECT_EQ(body.cell_type, 10);
  EXPECT_EQ(body.cells.size(), cube.at("tetrahedra"));
  double sum = 0;
  for (const auto& cell : body.cells) {
    const auto edge = [&](std::size_t k) -> Vec3 { return body.points[cell.at(k)] - body.points[cell.at(0)]; };
    sum += edge(1).cross(edge(2)).dot(edge(3)) / 6;
  }
  EXPECT_NEAR(sum, 27e-6, 1e-10);
  const Vector<double>& kinds = body.point_data.at("kind");
  EXPECT_EQ(std::count(kinds.begin(), kinds.end(), 0), 8) << "corners of a cube";
  EXPECT_EQ(std::count(kinds.begin(), kinds.end(), 3), 600 - 306) << "inside";
}

}  // namespace
}  // namespace crumble::cli
