// `crumble run`: what it prints, what it writes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/command.hpp"
#include "crumble/base/file.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/network/solver.hpp"
#include "render/temporary_folder.hpp"
#include "support/mesh_files.hpp"

namespace crumble::cli {
namespace {

using nlohmann::json;
using render::TemporaryFolder;

json run_json(Vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "run");
  arguments.push_back("--json");
  const Outcome outcome = crumble(arguments);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  return json::parse(outcome.out);
}

double size_of(const json& vector) {
  return std::sqrt(std::pow(vector[0].get<double>(), 2) + std::pow(vector[1].get<double>(), 2) +
                   std::pow(vector[2].get<double>(), 2));
}

TEST(Run, PrintsOneJsonObject) {
  // fast, so that springs are cut within a second
  const json result = run_json({"tofu_cube", "--device", "press:20", "--seconds", "1"});
  EXPECT_EQ(result.at("nodes"), 600);
  EXPECT_EQ(result.at("surface_nodes"), 306);
  EXPECT_GT(result.at("springs"), 3000);
  EXPECT_GT(result.at("tetrahedra"), 2000);
  // Euler: nodes - springs + faces - tetrahedra = 1, faces = 2 tetrahedra + half of the surface's 2 (surface nodes - 2)
  const int springs = result.at("springs"), tetrahedra = result.at("tetrahedra");
  EXPECT_EQ(600 - springs + (2 * tetrahedra + 306 - 2) - tetrahedra, 1);
  EXPECT_EQ(result.at("steps"), 1001);
  EXPECT_GT(result.at("cuts"), 10);
  EXPECT_LT(result.at("cuts"), springs);
  EXPECT_GE(result.at("fragments"), 1);
  EXPECT_EQ(result.at("precision"), "float64");
  const Vector<std::string> kernels = kernel_names();
  EXPECT_EQ(std::count(kernels.begin(), kernels.end(), result.at("kernel").get<std::string>()), 1);
  EXPECT_EQ(result.at("threads"), 1);
  const json& layout = result.at("layout");
  EXPECT_GT(layout.at("lane_use"), 0.25);
  EXPECT_LE(layout.at("lane_use"), 1);
  EXPECT_GT(layout.at("share_in_segments"), 0.25);
  EXPECT_LE(layout.at("share_in_segments"), 1);
  EXPECT_EQ(layout.at("partitions"), 1) << "too small to be shared";
  EXPECT_EQ(result.at("state_hash").get<std::string>().size(), 16u);

  const json& force = result.at("force");
  ASSERT_EQ(force.size(), 1001u);
  double peak = 0;
  for (std::size_t i = 0; i < force.size(); ++i) {
    ASSERT_EQ(force[i].at("torque_nm").size(), 3u);
    EXPECT_NEAR(force[i].at("depth_mm").get<double>(), 20e-3 * static_cast<double>(i), 1e-9);
    peak = std::max(peak, size_of(force[i].at("force_n")));
  }
  EXPECT_GT(force.back().at("force_n")[1], 0) << "the body pushes the stick up";
  EXPECT_EQ(result.at("peak_force_n").get<double>(), peak);
  EXPECT_GT(peak, 0.5);
  EXPECT_LT(peak, 50);

  const json& cost = result.at("step_cpu_us");
  EXPECT_GT(cost.at("p50"), 0);
  EXPECT_LE(cost.at("p50"), cost.at("p99"));
  EXPECT_LE(cost.at("p99"), cost.at("p99_9"));
  EXPECT_LE(cost.at("p99_9"), cost.at("max"));
  EXPECT_NEAR(result.at("rate_multiple_of_300hz").get<double>(), 1e6 / 300 / cost.at("p99").get<double>(), 1e-6);
  EXPECT_LE(result.at("energy_gain_max_relative"), 1e-12);
  for (const char* key : {"guarded_nodes", "clamped", "truncated", "dropped", "bad_poses", "suspended_steps"}) {
    EXPECT_EQ(result.at("counters").at(key), 0) << key;
  }
}

TEST(Run, GivesTheSameHashTwice) {
  const Vector<std::string> arguments{"tofu_cube", "--device", "press:40", "--seconds", "0.4"};
  json first = run_json(arguments), second = run_json(arguments);
  EXPECT_GT(first.at("cuts"), 0);
  for (json* result : {&first, &second}) {  // all is the same but the time it took
    result->erase("step_cpu_us");
    result->erase("rate_multiple_of_300hz");
  }
  EXPECT_EQ(first, second);
}

TEST(Run, GivesTheSameHashWithEveryKernelAndNumberOfThreads) {
  for (const char* precision : {"float64", "float32"}) {
    const Vector<std::string> press{"tofu_cube", "--device", "press:40", "--seconds", "0.4", "--precision", precision};
    const json chosen = run_json(press);
    EXPECT_EQ(chosen.at("precision"), precision);
    EXPECT_GT(chosen.at("cuts"), 0);
    for (const std::string& kernel : kernel_names()) {
      SCOPED_TRACE(kernel + " " + precision);
      Vector<std::string> arguments = press;
      arguments.insert(arguments.end(), {"--kernel", kernel, "--threads", "2"});
      const json result = run_json(arguments);
      EXPECT_EQ(result.at("kernel"), kernel);
      EXPECT_EQ(result.at("threads"), 2);
      EXPECT_EQ(result.at("state_hash"), chosen.at("state_hash"));
    }
  }
}

// Before the first crack, which would grow from the last bit.
TEST(Run, SinglePrecisionDiffersByLittle) {
  const Vector<std::string> press{"tofu_cube", "--device", "press:10", "--seconds", "0.2"};
  Vector<std::string> single = press;
  single.insert(single.end(), {"--precision", "float32"});
  const json exact = run_json(press), rough = run_json(single);
  ASSERT_EQ(exact.at("cuts"), 0);
  EXPECT_NE(rough.at("state_hash"), exact.at("state_hash"));
  const double force = exact.at("peak_force_n"), rough_force = rough.at("peak_force_n");
  EXPECT_NE(rough_force, force);
  EXPECT_NEAR(rough_force, force, 5e-3 * force);
  EXPECT_LE(rough.at("energy_gain_max_relative"), 1e-6) << "rounding";
}

TEST(Run, TakesEveryScene) {
  for (const char* scene : {"tofu_cube", "tofu_cube_upright", "tofu_slab", "tofu_globe", "tofu_globe_literal"}) {
    for (const char* preset : {"default", "paper"}) {
      SCOPED_TRACE(std::string(scene) + " " + preset);
      const json result = run_json({scene, "--device", "press:10", "--seconds", "0.2", "--preset", preset});
      const bool paper = std::string(preset) == "paper";
      EXPECT_EQ(result.at("tau_s"), paper ? 2.9e-3 : 1e-3);
      EXPECT_EQ(result.at("steps"), paper ? 70 : 201);
      EXPECT_NEAR(result.at("force").back().at("depth_mm").get<double>(), paper ? 2.001 : 2, 1e-9);
      EXPECT_GT(result.at("peak_force_n"), 0.01);
      EXPECT_EQ(result.at("counters").at("suspended_steps"), 0);
    }
  }
}

TEST(Run, PlaysTheRecordedHand) {
  const json result = run_json({"tofu_cube_touch"});
  EXPECT_EQ(result.at("steps"), 5301);
  EXPECT_TRUE(result.at("resampled"));
  EXPECT_LT(result.at("force").front().at("depth_mm"), 0) << "it comes from above";
  EXPECT_GT(result.at("cuts"), 0);
  EXPECT_GT(result.at("peak_force_n"), 0.1);
}

// The file says what the script does, so the forces differ by rounding only, as long as nothing breaks.
TEST(Run, ReplaysAPressAsThePressItself) {
  const json press = run_json({"tofu_cube", "--device", "press:1", "--seconds", "3"});
  for (const char* file : {"press_1mm_s", CRUMBLE_SOURCE_DIR "/examples/trajectories/press_1mm_s.ctraj"}) {
    const json replay = run_json({"tofu_cube", "--device", std::string("replay:") + file, "--seconds", "3"});
    ASSERT_EQ(replay.at("force").size(), press.at("force").size());
    for (std::size_t i = 0; i < press.at("force").size(); ++i) {
      const json &a = press.at("force")[i], &b = replay.at("force")[i];
      ASSERT_NEAR(a.at("depth_mm").get<double>(), b.at("depth_mm").get<double>(), 1e-12);
      for (int axis = 0; axis < 3; ++axis) {
        ASSERT_NEAR(a.at("force_n")[axis].get<double>(), b.at("force_n")[axis].get<double>(), 1e-11) << "step " << i;
      }
    }
  }
}

TEST(Run, TakesTheTimeStepItIsGiven) {
  const json result = run_json({"tofu_slab", "--device", "press:10", "--seconds", "0.1", "--dt", "0.002"});
  EXPECT_EQ(result.at("tau_s"), 0.002);
  EXPECT_EQ(result.at("steps"), 51);
}

TEST(Run, WritesEveryFileIntoAFolderItMakes) {
  const TemporaryFolder folder;
  const std::filesystem::path out = folder.file("a") / "b";
  const Outcome outcome =
      crumble({"run", "tofu_cube", "--device", "press:20", "--seconds", "1", "--out", out.string()});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("times the 300 Hz"), std::string::npos);
  EXPECT_NE(outcome.out.find(" kernel, 1 thread: CPU p50"), std::string::npos);
  EXPECT_NE(outcome.out.find("of the springs in segments"), std::string::npos);
  EXPECT_NE(outcome.out.find((out / "phases.png").string()), std::string::npos);

  std::set<std::string> names;
  for (const auto& file : std::filesystem::directory_iterator(out)) names.insert(file.path().filename());
  EXPECT_EQ(names, (std::set<std::string>{"experiment.crec", "events.csv", "force.csv", "force.svg", "phases.png",
                                          "phases_bare.png", "surface_0.ply", "surface_1.ply", "surface_2.ply",
                                          "surface_3.ply"}));
  const std::string table = read_text(out / "force.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 1 + 1001);
  EXPECT_EQ(table.find("time_s,depth_mm,fx_n,fy_n,fz_n,tx_nm,ty_nm,tz_nm,cuts\n"), 0u);
  EXPECT_NE(read_text(out / "force.svg").find("<svg"), std::string::npos);
  EXPECT_EQ(read_text(out / "phases.png").substr(1, 3), "PNG");
  for (int i = 0; i < 4; ++i) {
    SCOPED_TRACE(i);
    const TriangleMesh surface = read_ply(out / ("surface_" + std::to_string(i) + ".ply")).mesh;
    EXPECT_EQ(find_surface_defects(surface).total(), 0u) << "closed";
    for (const Vec3& v : surface.vertices) ASSERT_LT(v.cwiseAbs().maxCoeff(), 0.1) << "metres";
    if (i == 0) {
      EXPECT_NEAR(volume(surface), 27e-6, 1e-9) << "a cube of 30 mm at rest";
      EXPECT_EQ(surface.vertices.size(), 306u);
    }
    if (i == 3) {
      EXPECT_GT(surface.vertices.size(), 306u) << "cut faces, at the deepest";
    }
  }
  EXPECT_EQ(crumble({"replay", (out / "experiment.crec").string()}).code, 0);
  // again into the same folder
  EXPECT_EQ(crumble({"run", "tofu_cube", "--seconds", "0.05", "--out", out.string()}).code, 0);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(out), {}), 10);
}

// A run runs its own recording again, and fails if that reaches other states.
TEST(Run, ChangesTheBodyInMidRunAndRecordsIt) {
  const json as_is = run_json({"tofu_slab", "--device", "press:20", "--seconds", "0.12"});
  const json stiffer = run_json({"tofu_slab", "--device", "press:20", "--seconds", "0.12", "--change",
                                 "0.1:stiffness=60", "--change", "0.1:length_limit=1.5"});
  EXPECT_NEAR(stiffer.at("peak_force_n").get<double>() / as_is.at("peak_force_n").get<double>(), 2, 0.4);
}

TEST(Run, TellsTheForceOnEachTool) {
  const TemporaryFolder folder;
  const std::filesystem::path out = folder.file("out");
  const json result = run_json({"tofu_two_tools", "--seconds", "1", "--out", out.string()});
  EXPECT_EQ(result.at("device"), "scripted path, scripted path");
  ASSERT_EQ(result.at("other_tools").size(), 1u);
  const json& other = result.at("other_tools")[0];
  ASSERT_EQ(other.at("force").size(), 1001u);
  EXPECT_LT(result.at("force").back().at("force_n")[0], -0.05) << "the left one is pushed back";
  EXPECT_GT(other.at("force").back().at("force_n")[0], 0.05) << "the right one too";
  EXPECT_NEAR(other.at("peak_force_n").get<double>(), result.at("peak_force_n").get<double>(), 0.05);
  EXPECT_TRUE(run_json({"tofu_cube", "--seconds", "0.1"}).at("other_tools").empty());
  const std::string table = read_text(out / "force.csv");
  EXPECT_EQ(table.find("time_s,depth_mm,fx_n,fy_n,fz_n,tx_nm,ty_nm,tz_nm,depth_2_mm,fx_2_n,fy_2_n,fz_2_n,tx_2_nm,"
                       "ty_2_nm,tz_2_nm,cuts\n"),
            0u);
  EXPECT_TRUE(std::filesystem::exists(out / "force_2.svg"));
  EXPECT_EQ(crumble({"replay", (out / "experiment.crec").string()}).code, 0);
}

TEST(Run, FollowsPathsAndTakesEveryOtherScene) {
  for (const char* scene : {"tofu_drop", "tofu_crush", "tofu_knife", "tofu_needle"}) {
    SCOPED_TRACE(scene);
    const json result = run_json({scene, "--seconds", "0.3"});
    EXPECT_EQ(result.at("steps"), 301);
    EXPECT_EQ(result.at("counters").at("suspended_steps"), 0);
    EXPECT_LE(result.at("energy_gain_max_relative"), 1e-8);
  }
  // down by 24 mm in 2.7 s, from 1 mm above
  const json crush = run_json({"tofu_crush", "--seconds", "0.27"});
  EXPECT_GT(crush.at("force").back().at("depth_mm"), 1.4);
}

TEST(Run, ReadsSceneFiles) {
  const TemporaryFolder folder;
  write_text(folder.file("box.json"), R"({
    "description": "a box under a bar", "body": {"box": [0.02, 0.01, 0.02], "spacing": 0.004},
    "tool": {"bar": [0.006, 0.006, 0.05]}, "start": {}, "precision": "float32", "motion": {"press": {"speed": 0.02, "depth": 0.004}}})");
  const json result = run_json({folder.file("box.json").string()});
  EXPECT_EQ(result.at("scene"), "box");
  EXPECT_EQ(result.at("precision"), "float32");
  EXPECT_EQ(run_json({folder.file("box.json").string(), "--precision", "float64"}).at("precision"), "float64");
  EXPECT_EQ(result.at("steps"), 201);
  EXPECT_NEAR(result.at("force").back().at("depth_mm").get<double>(), 4, 1e-9);
  EXPECT_GT(result.at("peak_force_n"), 0.01);
}

TEST(Version, SaysWhatIsInTheBuild) {
  const Outcome outcome = crumble({"--version"});
  EXPECT_EQ(outcome.code, 0);
  for (const char* part : {"crumble " CRUMBLE_VERSION, "float64 float32", "press replay", "tofu_globe_literal"}) {
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part;
  }
  std::string kernels = "kernels:";
  for (const std::string& name : kernel_names()) kernels += " " + name;
  EXPECT_NE(outcome.out.find(kernels + "\n"), std::string::npos) << outcome.out;
}

}  // namespace
}  // namespace crumble::cli
