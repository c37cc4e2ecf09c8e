// `crumble export`: what it writes is what the simulation holds.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <set>

#include "cli/command.hpp"
#include "cli/recorded_press.hpp"
#include "crumble/base/file.hpp"
#include "crumble/base/memory.hpp"
#include "render/temporary_folder.hpp"
#include "support/mesh_files.hpp"

namespace crumble::cli {
namespace {

using nlohmann::json;
using render::TemporaryFolder;

class ExportTest : public testing::Test {
 protected:
  std::string file(const std::string& name) const { return folder.file(name).string(); }
  Outcome run_export(Vector<std::string> options) const {
    options.insert(options.begin(), {"export", recording});
    return crumble(options);
  }
  // At the end of the recording, which is where `sim` is.
  std::string at_end(const std::string& name, Vector<std::string> options = {}) const {
    options.insert(options.end(), {"--at", "0.501", "--out", file(name)});
    const Outcome outcome = run_export(options);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return file(name);
  }
  std::set<double> fragments_of(const Vector<double>& ids) const { return {ids.begin(), ids.end()}; }
  std::set<double> fragment_ids() const { return {sim.node_fragments().begin(), sim.node_fragments().end()}; }

  TemporaryFolder folder;
  const std::string recording = folder.file("good.crec").string();
  const Simulation sim = record_press("tofu_globe", 0.1, recording);
};

TEST_F(ExportTest, GivesTheSurfaceAtAnyTime) {
  for (const char* name : {"rest.ply", "late.ply"}) {
    const bool rest = std::string(name) == "rest.ply";
    const Outcome outcome = run_export({"--at", rest ? "0" : "0.5", "--out", file(name)});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const TriangleMesh surface = read_ply(file(name)).mesh;
    EXPECT_EQ(find_surface_defects(surface).total(), 0u);
    EXPECT_EQ(surface.vertices.size() == sim.mesh().surface_node_count(), rest)
        << "cut faces have vertices of their own";
    EXPECT_NEAR(volume(surface), volume(sim.mesh()), (rest ? 1e-4 : 0.3) * volume(sim.mesh()));
  }
}

TEST_F(ExportTest, GivesTheSameSurfaceInEveryFormat) {
  const PlyFile ply = read_ply(at_end("a.ply"));
  const VtuFile vtu = read_vtu(at_end("a.vtu"));
  EXPECT_EQ(vtu.time, sim.info().time);
  EXPECT_EQ(vtu.mesh().triangles, ply.mesh.triangles);
  EXPECT_NEAR(volume(vtu.mesh()), volume(ply.mesh), 1e-6 * volume(ply.mesh));
  for (const char* column : {"fragment", "material"}) EXPECT_EQ(vtu.cell_data.at(column), ply.face.at(column));
  EXPECT_EQ(fragments_of(ply.face.at("fragment")), fragment_ids());
  double sum = 0;
  for (const double id : fragment_ids()) {
    const TriangleMesh part = select(vtu.mesh(), vtu.cell_data.at("fragment"), id);
    EXPECT_EQ(find_surface_defects(part).total(), 0u) << id;
    sum += volume(part);
  }
  EXPECT_NEAR(sum, volume(vtu.mesh()), 1e-12 * sum);
  TriangleMesh rest = ply.mesh;
  for (std::size_t i = 0; i < rest.vertices.size(); ++i) rest.vertices[i] = Vec3(&vtu.point_data.at("rest")[3 * i]);
  EXPECT_NEAR(volume(rest), volume(sim.mesh()), 1e-9 * volume(sim.mesh())) << "places at rest";
  for (const char* extension : {".obj", ".stl", ".glb"}) {
    EXPECT_GT(std::filesystem::file_size(at_end(std::string("a") + extension)), 1000u);
  }
  EXPECT_TRUE(std::filesystem::exists(file("a.mtl")));
}

TEST_F(ExportTest, DrawsCutsInTheModeAskedFor) {
  const PlyFile cracks = read_ply(at_end("a.ply", {"--mode", "cracks"}));
  const PlyFile fragments = read_ply(at_end("b.ply", {"--mode", "fragments"}));
  const PlyFile paper = read_ply(at_end("c.ply", {"--mode", "paper"}));
  EXPECT_LT(fragments.mesh.triangles.size(), cracks.mesh.triangles.size()) << "notches are not shown";
  EXPECT_NE(paper.mesh.triangles.size(), cracks.mesh.triangles.size());
  EXPECT_EQ(find_surface_defects(fragments.mesh).total(), 0u);
}

TEST_F(ExportTest, GivesTheSprings) {
  const VtuFile file = read_vtu(at_end("springs.vtu", {"--what", "springs"}));
  EXPECT_EQ(file.cell_type, 3);
  ASSERT_EQ(file.cells.size(), sim.mesh().springs.size());
  for (std::size_t i = 0; i < file.points.size(); ++i) {
    ASSERT_EQ(file.points[i], sim.positions()[i]);
    ASSERT_EQ(Vec3(&file.point_data.at("velocity")[3 * i]), sim.velocities()[i]);
    ASSERT_EQ(file.point_data.at("fragment")[i], sim.node_fragments()[i]);
  }
  std::size_t cuts = 0;
  for (std::size_t s = 0; s < file.cells.size(); ++s) {
    const auto [a, b] = sim.mesh().springs[s];
    ASSERT_EQ(file.cells[s], (Vector<std::uint32_t>{a, b}));
    ASSERT_EQ(file.cell_data.at("spring")[s], static_cast<double>(s));
    const Vec3 now = file.points[b] - file.points[a], rest = sim.mesh().positions[b] - sim.mesh().positions[a];
    ASSERT_NEAR(file.cell_data.at("stretch")[s], std::sqrt(now.dot(now) / rest.dot(rest)), 1e-12);
    const bool is_intact = file.cell_data.at("intact")[s] == 1;
    cuts += !is_intact;
    const bool is_within = sim.node_fragments()[a] == sim.node_fragments()[b];
    ASSERT_EQ(file.cell_data.at("fragment")[s], is_within ? sim.node_fragments()[a] : -1.0);
    ASSERT_TRUE(is_within || !is_intact);
  }
  EXPECT_EQ(cuts, sim.counters().cuts);
}

TEST_F(ExportTest, GivesTheBody) {
  const VtuFile file = read_vtu(at_end("body.vtu", {"--what", "body"}));
  EXPECT_EQ(file.cell_type, 10);
  ASSERT_EQ(file.cells.size(), sim.mesh().tetrahedra.size());
  std::size_t cut_ends = 0, wanted = 0;
  for (std::size_t t = 0; t < file.cells.size(); ++t) {
    const auto mask = static_cast<unsigned>(file.cell_data.at("cut_mask")[t]);
    for (std::size_t s = 0; s < 6; ++s) {
      cut_ends += mask >> s & 1;
      wanted += sim.intact()[sim.mesh().tet_springs[t][s]] == 0;
    }
    std::set<double> fragments;
    for (const std::uint32_t node : file.cells[t]) fragments.insert(file.point_data.at("fragment")[node]);
    ASSERT_EQ(file.cell_data.at("fragment")[t], fragments.size() == 1 ? *fragments.begin() : -1);
  }
  EXPECT_EQ(cut_ends, wanted);
  EXPECT_GT(wanted, 0u);
  EXPECT_EQ(Vec3(&file.point_data.at("rest")[300]), sim.mesh().positions[100]);
}

TEST_F(ExportTest, GivesTheFragments) {
  const json table = json::parse(read_text(at_end("fragments.json", {"--what", "fragments"})));
  const VtuFile grid = read_vtu(at_end("fragments.vtu", {"--what", "fragments"}));
  EXPECT_EQ(table.at("step"), kSteps);
  EXPECT_EQ(table.at("time_s"), sim.info().time);
  std::set<double> ids;
  double mass = 0, rest_volume = 0;
  std::size_t nodes = 0;
  for (std::size_t i = 0; i < table.at("fragments").size(); ++i) {
    const json& fragment = table.at("fragments")[i];
    ids.insert(fragment.at("id").get<double>());
    mass += fragment.at("mass_kg").get<double>();
    rest_volume += fragment.at("rest_volume_m3").get<double>();
    nodes += fragment.at("nodes").get<std::size_t>();
    const FragmentRecord record = sim.fragments().record(fragment.at("id").get<std::uint32_t>());
    const bool is_first = record.parent == kNoFragment;
    EXPECT_EQ(fragment.at("parent"), is_first ? json() : json(record.parent));
    EXPECT_EQ(fragment.at("born_step"), record.born);
    EXPECT_GT(fragment.at("inertia_kg_m2")[0][0], -1e-18);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_LE(fragment.at("low_m")[axis], fragment.at("high_m")[axis]);
      EXPECT_EQ(grid.points.at(i)[static_cast<int>(axis)], fragment.at("center_m")[axis].get<double>());
    }
    EXPECT_EQ(grid.point_data.at("fragment").at(i), fragment.at("id"));
    EXPECT_EQ(grid.point_data.at("mass").at(i), fragment.at("mass_kg"));
    EXPECT_EQ(grid.point_data.at("parent").at(i), is_first ? -1.0 : record.parent);
    EXPECT_EQ(grid.point_data.at("born").at(i), static_cast<double>(record.born));
  }
  EXPECT_EQ(ids, fragment_ids());
  EXPECT_GT(ids.size(), 2u) << "something to tell apart";
  EXPECT_NEAR(mass, sim.definition().material.mass, 1e-12);
  EXPECT_NEAR(rest_volume, volume(sim.mesh()), 1e-15);
  EXPECT_EQ(nodes, sim.mesh().node_count());
}

TEST_F(ExportTest, GivesASeries) {
  const Outcome outcome = run_export({"--every", "0.1", "--out", file("globe.pvd"), "--what", "springs"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  pugi::xml_document document;
  ASSERT_TRUE(document.load_file(file("globe.pvd").c_str()));
  std::size_t frame = 0, last_cuts = 0;
  for (const auto& row : document.child("VTKFile").child("Collection").children("DataSet")) {
    const VtuFile springs = read_vtu(folder.file(row.attribute("file").value()));
    EXPECT_EQ(springs.time, row.attribute("timestep").as_double());
    EXPECT_NEAR(springs.time, frame == 0 ? 0.001 : 0.1 * static_cast<double>(frame), 1e-9);
    const Vector<double>& intact = springs.cell_data.at("intact");
    const auto cuts = static_cast<std::size_t>(std::count(intact.begin(), intact.end(), 0));
    EXPECT_GE(cuts, last_cuts);
    last_cuts = cuts;
    ++frame;
  }
  EXPECT_EQ(frame, 6u);
  EXPECT_GT(last_cuts, 0u);
  EXPECT_EQ(run_export({"--every", "0.2", "--out", file("globe.obj")}).code, 0);
  for (const char* name : {"globe_0000.obj", "globe_0000.mtl", "globe_0002.obj"}) {
    EXPECT_TRUE(std::filesystem::exists(file(name))) << name;
  }
  EXPECT_EQ(folder.size(), 3u + 6u);
}

TEST_F(ExportTest, RefusesWhatItCannotGive) {
  const std::string ply = file("surface.ply");
  const Vector<Vector<std::string>> refused{
      {"--at must lie in [0, 0.501], is 0.6", "--at", "0.6", "--out", ply},
      {"--at must lie in [0, 0.501], is -0.1", "--at", "-0.1", "--out", ply},
      {"--at must be finite, is nan", "--at", "nan", "--out", ply},
      {"--every must lie in [0.001, 0.501], is 0", "--every", "0", "--out", file("a.pvd")},
      {"--every must be finite, is nan", "--every", "nan", "--out", file("a.pvd")},
      {"a.pvd' holds a series and needs --every", "--at", "0.1", "--out", file("a.pvd")},
      {"surface.xyz' must end in one of .glb .obj .ply .stl .vtu .pvd", "--at", "0.1", "--out", file("surface.xyz")},
      {"must end in one of", "--at", "0.1", "--out", file("surface")},
      {"must end in one of .vtu .pvd", "--at", "0.1", "--what", "springs", "--out", ply},
      {"must end in one of .json .vtu .pvd", "--at", "0.1", "--what", "fragments", "--out", ply},
      {"--what 'nodes' is not known; there are: surface springs body fragments", "--at", "0.1", "--what", "nodes",
       "--out", ply},
      {"--mode 'none' is not known; there are: cracks fragments paper", "--at", "0.1", "--mode", "none", "--out", ply},
      {"--mode 'paper' is for --what surface", "--at", "0.1", "--mode", "paper", "--what", "body", "--out",
       file("a.vtu")},
      {"none/surface.ply'", "--at", "0.1", "--out", file("none/surface.ply")},
      {"none/surface'", "--every", "0.1", "--out", file("none/surface.pvd")},
  };
  for (const Vector<std::string>& row : refused) {
    const Outcome outcome = run_export({row.begin() + 1, row.end()});
    EXPECT_EQ(outcome.code, 1) << row[0];
    EXPECT_NE(outcome.err.find(row[0]), std::string::npos) << outcome.err;
  }
  EXPECT_GE(run_export({"--out", ply}).code, 100);
  EXPECT_GE(run_export({"--at", "0.1", "--every", "0.1", "--out", ply}).code, 100);
  const Outcome missing = crumble({"export", file("none.crec"), "--at", "0.1", "--out", ply});
  EXPECT_EQ(missing.code, 1);
  EXPECT_NE(missing.err.find("none.crec"), std::string::npos);
  EXPECT_EQ(folder.size(), 1u) << "nothing half-written";
}

// The recording says something else of its last step, which is seen when all frames but the last have been written.
TEST_F(ExportTest, LeavesNothingOfASeriesThatFails) {
  Recording wrong = Recording::load(recording);
  wrong.add(wrong.poses(kSteps - 1), 0);
  wrong.save(file("wrong.crec"));
  const Outcome outcome = crumble({"export", file("wrong.crec"), "--every", "0.1", "--out", file("a.pvd")});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.err.find("differs from the recorded one at step 501"), std::string::npos) << outcome.err;
  EXPECT_EQ(folder.size(), 2u);
}

}  // namespace
}  // namespace crumble::cli
