// What the command line refuses: exit code not 0, a message that names field and value, and nothing half-written.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "crumble/base/file.hpp"
#include "crumble/base/memory.hpp"
#include "render/temporary_folder.hpp"

namespace crumble::cli {
namespace {

using render::TemporaryFolder;

struct Refusal {
  Vector<std::string> arguments;
  Vector<std::string> message;  // parts
};

void expect_refused(const Refusal& refusal) {
  std::string line;
  for (const std::string& word : refusal.arguments) line += word.substr(0, 80) + " ";
  SCOPED_TRACE(line);
  const Outcome outcome = crumble(refusal.arguments);
  EXPECT_GT(outcome.code, 0);
  EXPECT_LT(outcome.code, 127) << "killed or not started";
  EXPECT_EQ(outcome.out, "");
  for (const std::string& part : refusal.message) {
    EXPECT_NE(outcome.err.find(part), std::string::npos) << "'" << part << "' is not in: " << outcome.err;
  }
}

std::string bytes_of(const std::filesystem::path& path, std::size_t size) {
  return read_text(path).substr(0, size);
}

TEST(Refusals, NameTheOptionAndTheValue) {
  const Vector<Refusal> refusals{
      {{"run", "tofu_cube", "--change", "0.5"}, {"--change '0.5'", "TIME:FIELD=VALUE"}},
      {{"run", "tofu_cube", "--change", "0.5:taste=3"}, {"'taste'", "stiffness damping_ratio"}},
      {{"run", "tofu_cube", "--change", "-1:stiffness=60"}, {"--change TIME", "-1"}},
      {{"run", "tofu_cube", "--change", "0.01:stiffness=-60", "--seconds", "0.1"}, {"stiffness", "-60"}},
      {{"run", "tofu_pyramid"}, {"'tofu_pyramid'", "tofu_cube_upright"}},
      {{"run", "tofu_cube", "--dt", "0"}, {"--dt must be positive, is 0"}},
      {{"run", "tofu_cube", "--dt", "-0.001"}, {"--dt must be positive, is -0.001"}},
      {{"run", "tofu_cube", "--dt", "nan"}, {"--dt must be finite, is nan"}},
      {{"run", "tofu_cube", "--dt", "1"}, {"--dt must lie in", "is 1"}},
      {{"run", "tofu_cube", "--dt", "soon"}, {"--dt", "soon"}},
      {{"run", "tofu_cube", "--seconds", "0"}, {"--seconds must be positive, is 0"}},
      {{"run", "tofu_cube", "--seconds", "nan"}, {"--seconds must be finite, is nan"}},
      {{"run", "tofu_cube", "--seconds", "1e300"}, {"1e+300 s"}},
      {{"run", "tofu_cube", "--precision", "float16"}, {"--precision 'float16'", "there are: float32 float64"}},
      {{"run", "tofu_cube", "--kernel", "abacus"}, {"--kernel 'abacus'", "there are: scalar"}},
      {{"run", "tofu_cube", "--threads", "0"}, {"--threads must lie in [1, 64], is 0"}},
      {{"run", "tofu_cube", "--threads", "65"}, {"--threads must lie in [1, 64], is 65"}},
      {{"run", "tofu_cube", "--threads", "-1"}, {"--threads must lie in [1, 64], is -1"}},
      {{"run", "tofu_cube", "--threads", "many"}, {"--threads", "many"}},
      {{"replay", "none.crec", "--kernel", "abacus"}, {"--kernel 'abacus'", "there are: scalar"}},
      {{"replay", "none.crec", "--threads", "65"}, {"--threads must lie in [1, 64], is 65"}},
      {{"run", "tofu_cube", "--preset", "papre"}, {"--preset 'papre'", "default paper"}},
      {{"run", "tofu_cube", "--device", "nonsense"}, {"--device 'nonsense'", "press:MM_PER_S", "replay:FILE"}},
      {{"run", "tofu_cube", "--device", "press:0"}, {"--device press:MM_PER_S must be positive, is 0"}},
      {{"run", "tofu_cube", "--device", "press:-1"}, {"--device press:MM_PER_S must be positive, is -1"}},
      {{"run", "tofu_cube", "--device", "press:abc"}, {"--device 'press:abc'"}},
      {{"run", "tofu_cube", "--device", "press:inf"}, {"--device press:MM_PER_S must be finite, is inf"}},
      {{"run", "tofu_cube", "--device", "press:1e-9"}, {"s of motion are more than"}},
      {{"run", "tofu_cube", "--device", "replay:no_such.ctraj"}, {"'no_such.ctraj'"}},
      {{"run"}, {"scene"}},
      {{"walk"}, {"subcommand"}},
      {{}, {"subcommand"}},
  };
  for (const Refusal& refusal : refusals) expect_refused(refusal);
}

TEST(Refusals, OfMeshes) {
  const Vector<Refusal> refusals{
      {{"mesh", "cone", "0.1"}, {"mesh 'cone'", "cylinder"}},
      {{"mesh", "cube", "0.03"}, {"mesh cube takes no sizes"}},
      {{"mesh", "box", "0.03", "0.03", "--spacing", "0.005"}, {"mesh box takes X Y Z", "2"}},
      {{"mesh", "box", "0.03", "-0.03", "0.03", "--spacing", "0.005"}, {"mesh box Y must be positive, is -0.03"}},
      {{"mesh", "box", "0.03", "0.03", "0.03"}, {"--spacing is missing"}},
      {{"mesh", "sphere", "nan", "--spacing", "0.005"}, {"mesh sphere RADIUS must be finite, is nan"}},
      {{"mesh", "cylinder", "0.02", "0", "--spacing", "0.005"}, {"mesh cylinder HEIGHT must be positive, is 0"}},
      {{"mesh", "cube", "--spacing", "0"}, {"--spacing must be positive, is 0"}},
      {{"mesh", "cube", "--spacing", "-0.004"}, {"--spacing must be positive, is -0.004"}},
      {{"mesh", "cube", "--spacing", "nan"}, {"--spacing must be finite, is nan"}},
      {{"mesh", "cube", "--spacing", "0.1"}, {"spacing 0.1 m is too coarse"}},
      {{"mesh", "sphere", "0.02", "--spacing", "0.1"}, {"spacing 0.1 m is too coarse"}},
      {{"mesh", "cube", "--spacing", "1e-7"}, {"spacing 1e-07 m"}},
      {{"mesh", "cube", "--surface-nodes", "-5"}, {"--surface-nodes", "-5"}},
      {{"mesh", "cube", "--surface-nodes", "5000"}, {"surface_nodes must lie in", "is 5000"}},
      {{"mesh", "cube", "--lattice", "bcc"}, {"--lattice 'bcc'", "hcp fcc"}},
      {{"mesh", "cube", "--structure", "random"}, {"--structure 'random'", "relaxed lattice"}},
      {{"mesh", "cube", "--offset", "nan", "0", "0"}, {"offset.x", "nan"}},
  };
  for (const Refusal& refusal : refusals) expect_refused(refusal);
}

TEST(Refusals, OfPatterns) {
  const TemporaryFolder folder;
  const std::string png = folder.file("patterns.png").string(), svg = folder.file("patterns.svg").string();
  expect_refused({{"patterns", "--mode", "fancy", "--out", png}, {"--mode 'fancy'", "cracks paper"}});
  expect_refused({{"patterns", "--out", svg}, {"--out '" + svg + "' must end in .png"}});
  expect_refused({{"patterns", "--out", folder.file("none/patterns.png").string()}, {"none/patterns.png"}});
  expect_refused({{"patterns"}, {"--out"}});
  EXPECT_EQ(folder.size(), 0u);
}

TEST(Refusals, OfFilesThatAreNotWhole) {
  const TemporaryFolder folder;
  const std::string scene = folder.file("scene.json").string(), motion = folder.file("motion.ctraj").string();
  const std::string whole = read_text(CRUMBLE_SOURCE_DIR "/examples/scenes/tofu_cube.json");
  write_text(scene, whole.substr(0, whole.size() / 2));
  expect_refused({{"run", scene}, {"scene.json", "parse error"}});
  std::string broken = whole;
  broken.replace(broken.find("0.008"), 5, "-1e-3");
  write_text(scene, broken);
  expect_refused({{"run", scene}, {"scene.json", "tool.round_stick.diameter must be positive, is -0.001"}});
  expect_refused({{"run", folder.file("none.json").string()}, {"none.json", "No such file"}});
  expect_refused({{"run", folder.file("").string()}, {"cannot read"}});

  const std::string device = "replay:" + motion;
  write_text(motion, bytes_of(CRUMBLE_SOURCE_DIR "/examples/trajectories/touch_motion.ctraj", 9000));
  expect_refused({{"run", "tofu_cube", "--device", device}, {"motion.ctraj", "line "}});
  write_text(motion, "# crumble-traj 1\nt,px,py,pz\n0,0,0,0\n1,0,nan,0\n# end rows=2\n");
  expect_refused({{"run", "tofu_cube", "--device", device}, {"motion.ctraj: line 4", "py", "nan"}});
  write_text(motion, "# crumble-traj 1\nt,px,py,pz\n0,0,0,0\n1,0,0,0\n");
  expect_refused({{"run", "tofu_cube", "--device", device}, {"motion.ctraj", "truncated", "# end rows=2"}});
  write_text(motion, "");
  expect_refused({{"run", "tofu_cube", "--device", device}, {"motion.ctraj", "is empty"}});
}

TEST(Refusals, LeaveNothingBehind) {
  const TemporaryFolder folder;
  const std::string out = (folder.file("new") / "deep").string();
  expect_refused({{"run", "tofu_pyramid", "--out", out}, {"tofu_pyramid"}});
  expect_refused({{"run", "tofu_cube", "--device", "press:0", "--out", out}, {"press"}});
  expect_refused({{"run", "tofu_cube", "--device", "replay:none", "--out", out}, {"none"}});
  EXPECT_EQ(folder.size(), 0u);

  // a folder that was there stays, with what was in it
  const std::filesystem::path there = folder.file("there");
  std::filesystem::create_directory(there);
  write_text(there / "notes.txt", "mine");
  expect_refused({{"run", "tofu_cube", "--device", "press:0", "--out", there.string()}, {"press"}});
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(there), {}), 1);
  // all files are drawn before the first is moved into place, and here the last of them cannot be
  std::filesystem::create_directories(there / "phases.png" / "x");
  const Outcome outcome = crumble({"run", "tofu_cube", "--seconds", "0.01", "--out", there.string()});
  EXPECT_GT(outcome.code, 0);
  EXPECT_NE(outcome.err.find("phases.png"), std::string::npos) << outcome.err;
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(there), {}), 2);

  const std::string mesh = folder.file("mesh.xyz").string();
  expect_refused({{"mesh", "cube", "--out", mesh}, {"mesh.xyz", ".vtk .glb .obj .ply .stl"}});
  expect_refused({{"mesh", "cube", "--spacing", "-1", "--out", folder.file("mesh.vtk").string()}, {"--spacing"}});
  EXPECT_EQ(folder.size(), 1u);
}

TEST(Refusals, OfPlacesThatCannotBeWritten) {
  const TemporaryFolder folder;
  const std::string file = folder.file("file").string();
  write_text(file, "a file");
  expect_refused({{"run", "tofu_cube", "--seconds", "0.01", "--out", file}, {"--out '" + file + "'"}});
  expect_refused(
      {{"run", "tofu_cube", "--seconds", "0.01", "--out", file + "/deeper"}, {"--out '" + file + "/deeper'"}});
  expect_refused({{"mesh", "cube", "--out", file + "/mesh.vtk"}, {file + "/mesh.vtk"}});
  expect_refused({{"mesh", "cube", "--out", folder.file("none/mesh.ply").string()}, {"none/mesh.ply"}});
  EXPECT_EQ(folder.size(), 1u);
  EXPECT_EQ(read_text(file), "a file");
}

}  // namespace
}  // namespace crumble::cli
