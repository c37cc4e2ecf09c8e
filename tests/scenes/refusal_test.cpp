// What a scene file can get wrong: each mistake gives its code, and a message with the key's whole path and the value.
#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>
#include <string>

#include "crumble/base/file.hpp"
#include "crumble/base/memory.hpp"
#include "render/temporary_folder.hpp"
#include "scenes/scene.hpp"

namespace crumble {
namespace {

using nlohmann::json;
using render::TemporaryFolder;

const json kGood = json::parse(R"({
  "description": "a small box",
  "body": {"box": [0.02, 0.016, 0.02], "spacing": 0.005},
  "material": {"stiffness": 20, "damping_ratio": 25, "length_limit": 1.2, "mass": 0.01},
  "fixed_below": 1e-6,
  "gravity": [0, -1, 0],
  "walls": [{"normal": [0, 2, 0], "offset": -0.1, "friction": {"static": 0.4, "dynamic": 0.3}}],
  "tool": {"bar": [0.004, 0.004, 0.03], "friction": {"static": 0.5, "dynamic": 0.4}},
  "precision": "float32",
  "start": {"clearance": 0.001, "x": 0.002, "z": -0.003},
  "motion": {"press": {"speed": 0.002, "depth": 0.01}}
})");

// Loads `text` as a scene file and makes the simulation; what is thrown comes back.
struct Outcome {
  Code code{};
  std::string message;
};
Outcome load(const std::string& text) {
  const TemporaryFolder folder;
  write_text(folder.file("scene.json"), text);
  try {
    Simulation sim(load_scene(folder.file("scene.json").string(), Preset::standard).def);
  } catch (const Error& error) {
    return {error.code(), error.what()};
  }
  return {};
}

struct Mistake {
  const char* pointer;  // of the key
  const char* value;    // as JSON; nothing: the key is taken away
  Code code;
  Vector<const char*> message;  // parts
};

void expect_refused(const Mistake& mistake, json scene) {
  SCOPED_TRACE(std::string(mistake.pointer) + " = " + (mistake.value ? mistake.value : "nothing"));
  const json::json_pointer at(mistake.pointer);
  if (mistake.value) {
    scene[at] = json::parse(mistake.value);
  } else {
    scene.at(at.parent_pointer()).erase(at.back());
  }
  const Outcome outcome = load(scene.dump());
  EXPECT_EQ(static_cast<int>(outcome.code), static_cast<int>(mistake.code)) << outcome.message;
  for (const char* part : mistake.message) {
    EXPECT_NE(outcome.message.find(part), std::string::npos) << "'" << part << "' is not in: " << outcome.message;
  }
}

TEST(SceneFile, IsReadKeyByKey) {
  const TemporaryFolder folder;
  write_text(folder.file("small.json"), kGood.dump());
  const Scene scene = load_scene(folder.file("small.json").string(), Preset::standard);
  EXPECT_EQ(scene.name, "small");
  EXPECT_EQ(scene.description, "a small box");
  EXPECT_EQ(scene.top, 0.016);
  EXPECT_EQ(scene.def.material.stiffness, 20);
  EXPECT_EQ(scene.def.material.damping_ratio, 25);
  EXPECT_EQ(scene.def.material.length_limit, 1.2);
  EXPECT_EQ(scene.def.material.mass, 0.01);
  EXPECT_EQ(scene.def.gravity, Vec3(0, -1, 0));
  EXPECT_EQ(scene.def.step.precision, Precision::float32);
  ASSERT_EQ(scene.def.walls.size(), 1u);
  EXPECT_EQ(scene.def.walls[0].plane.normal, Vec3::UnitY());
  EXPECT_EQ(scene.def.walls[0].plane.offset, -0.1);
  EXPECT_EQ(scene.def.walls[0].friction.static_coefficient, 0.4);
  EXPECT_EQ(scene.def.tools[0].friction.dynamic_coefficient, 0.4);
  EXPECT_EQ(scene.motions[0].start.position, Vec3(0.002, 0.016 + 0.001 + 0.002, -0.003));
  EXPECT_EQ(scene.motions[0].press.speed, 0.002);
  EXPECT_EQ(scene.motions[0].press.depth, 0.01);
}

TEST(SceneFile, OfTheManualLoads) {
  const std::string manual = read_text(CRUMBLE_SOURCE_DIR "/docs/scenes.md"), fence = "```json\n";
  const std::size_t begin = manual.find(fence) + fence.size();
  const Outcome outcome = load(manual.substr(begin, manual.find("```", begin) - begin));
  EXPECT_EQ(outcome.code, Code{}) << outcome.message;
}

TEST(SceneFile, FindsATrajectoryBesideIt) {
  const TemporaryFolder folder;
  json scene = kGood;
  scene["motion"] = json::parse(R"({"replay": {"file": "own.ctraj", "workspace": {"position": [0, 0.02, 0]}}})");
  write_text(folder.file("scene.json"), scene.dump());
  write_text(folder.file("own.ctraj"), "# crumble-traj 1\nt,px,py,pz\n0,0,0,0\n1,0,-0.01,0\n# end rows=2\n");
  EXPECT_EQ(load_scene(folder.file("scene.json").string(), Preset::standard).motions[0].trajectory->rows.size(), 2u);
}

TEST(SceneFile, RefusesUnknownKeys) {
  const std::array<Mistake, 9> mistakes{{
      {"/colour", "1", Code::format, {"colour is not a key"}},
      {"/body/radius", "0.1", Code::format, {"body.radius is not a key"}},
      {"/material/density", "1000", Code::format, {"material.density is not a key"}},
      {"/tool/mass", "1", Code::format, {"tool.mass is not a key"}},
      {"/tool/friction/kinetic", "1", Code::format, {"tool.friction.kinetic is not a key"}},
      {"/walls/0/height", "1", Code::format, {"walls[0].height is not a key"}},
      {"/start/y", "1", Code::format, {"start.y is not a key"}},
      {"/motion/stir", "{}", Code::format, {"motion.stir is not a key"}},
      {"/motion/press/angle", "1", Code::format, {"motion.press.angle is not a key"}},
  }};
  for (const Mistake& mistake : mistakes) expect_refused(mistake, kGood);
  json sphere = kGood, cylinder = kGood;
  sphere["body"] = json::parse(R"({"sphere": {"radius": 0.02}, "spacing": 0.005})");
  cylinder["body"] = json::parse(R"({"cylinder": {"radius": 0.02, "height": 0.02}, "spacing": 0.005})");
  expect_refused({"/body/sphere/height", "1", Code::format, {"body.sphere.height is not a key"}}, sphere);
  expect_refused({"/body/cylinder/x", "1", Code::format, {"body.cylinder.x is not a key"}}, cylinder);
}

TEST(SceneFile, RefusesMissingKeys) {
  const std::array<Mistake, 11> mistakes{{
      {"/description", nullptr, Code::format, {"description is missing"}},
      {"/body", nullptr, Code::format, {"body is missing"}},
      {"/body/box", nullptr, Code::format, {"body.paper is missing", "box, sphere and cylinder"}},
      {"/body/spacing", nullptr, Code::format, {"body.spacing is missing"}},
      {"/tool", nullptr, Code::format, {"tool is missing"}},
      {"/tool/bar", nullptr, Code::format, {"tool.round_stick is missing", "bar, blade"}},
      {"/tool/friction/static", nullptr, Code::format, {"tool.friction.static is missing"}},
      {"/walls/0/offset", nullptr, Code::format, {"walls[0].offset is missing"}},
      {"/motion", nullptr, Code::format, {"motion is missing"}},
      {"/motion/press", nullptr, Code::format, {"motion.press is missing", "replay and path"}},
      {"/motion/press/depth", nullptr, Code::format, {"motion.press.depth is missing"}},
  }};
  for (const Mistake& mistake : mistakes) expect_refused(mistake, kGood);
  expect_refused({"/start/degrees", "90", Code::format, {"start.axis is missing"}}, kGood);
}

TEST(SceneFile, RefusesWrongTypes) {
  const std::array<Mistake, 16> mistakes{{
      {"/precision", R"("float16")", Code::format, {"precision must be float64 or float32, is float16"}},
      {"/precision", "32", Code::format, {"precision must be a text, is 32"}},
      {"/description", "7", Code::format, {"description must be a text, is 7"}},
      {"/body", "[1, 2]", Code::format, {"body must be an object, is [1,2]"}},
      {"/body/box", "[0.03, 0.03]", Code::format, {"body.box must be three numbers, is [0.03,0.03]"}},
      {"/body/box", R"([0.03, 0.03, "a"])", Code::format, {"body.box must be three numbers", "\"a\""}},
      {"/body/spacing", R"("small")", Code::format, {"body.spacing must be a number, is \"small\""}},
      {"/body/spacing", "null", Code::format, {"body.spacing must be a number, is null"}},
      {"/body/structure", R"("crystal")", Code::format, {"body.structure must be relaxed or lattice, is crystal"}},
      {"/body/structure", "1", Code::format, {"body.structure must be a text, is 1"}},
      {"/body/surface_nodes", "10.5", Code::format, {"body.surface_nodes must be a whole number, is 10.5"}},
      {"/body/surface_nodes", "-3", Code::format, {"body.surface_nodes must be a whole number, is -3"}},
      {"/walls", R"({"normal": 1})", Code::format, {"walls must be a list, is {\"normal\":1}"}},
      {"/walls/0", "5", Code::format, {"walls[0] must be an object, is 5"}},
      {"/gravity", "true", Code::format, {"gravity must be three numbers, is true"}},
      {"/motion/press", "null", Code::format, {"motion.press must be an object, is null"}},
  }};
  for (const Mistake& mistake : mistakes) expect_refused(mistake, kGood);
  EXPECT_NE(load("[1, 2, 3]").message.find("the scene must be an object, is [1,2,3]"), std::string::npos);
}

TEST(SceneFile, RefusesSizesThatAreNone) {
  const std::array<Mistake, 21> mistakes{{
      {"/body/box", "[0.02, 0, 0.02]", Code::out_of_range, {"body.box.y must be positive, is 0"}},
      {"/body/box", "[-0.02, 0.02, 0.02]", Code::out_of_range, {"body.box.x must be positive, is -0.02"}},
      {"/body/spacing", "0", Code::out_of_range, {"body.spacing must be positive, is 0"}},
      {"/body/spacing", "-0.001", Code::out_of_range, {"body.spacing must be positive, is -0.001"}},
      {"/body/spacing", "0.05", Code::too_coarse, {"body: spacing 0.05"}},
      {"/body/spacing", "1e-8", Code::too_large, {"body: spacing 1e-08"}},
      {"/material/stiffness", "0", Code::out_of_range, {"material.stiffness must be positive, is 0"}},
      {"/material/mass", "-1", Code::out_of_range, {"material.mass must be positive, is -1"}},
      {"/material/damping_ratio", "-2", Code::out_of_range, {"material.damping_ratio", "-2"}},
      {"/material/length_limit", "1", Code::out_of_range, {"material.length_limit", "is 1"}},
      {"/tool/bar", "[0.004, 0.004, 0]", Code::out_of_range, {"tool.bar.z must be positive, is 0"}},
      {"/tool/friction/dynamic", "-0.1", Code::out_of_range, {"tool.friction", "-0.1"}},
      {"/tool/friction/static", "0.1", Code::out_of_range, {"tool.friction", "0.1", "0.4"}},
      {"/walls/0/normal", "[0, 0, 0]", Code::out_of_range, {"walls[0].normal", "is 0"}},
      {"/walls/0/friction/static", "-1", Code::out_of_range, {"walls[0].friction", "-1"}},
      {"/motion/press/speed", "0", Code::out_of_range, {"motion.press.speed must be positive, is 0"}},
      {"/motion/press/depth", "-0.01", Code::out_of_range, {"motion.press.depth must be positive, is -0.01"}},
      {"/tool/bar", nullptr, Code::format, {"tool.round_stick"}},
      {"/body", R"({"paper": "pyramid"})", Code::format, {"body.paper", "is pyramid"}},
      {"/start/degrees", "1e9", Code::out_of_range, {"start.degrees", "1e+09"}},
      {"/body/surface_nodes", "300", Code::invalid_value, {"body: surface_nodes and inside_nodes"}},
  }};
  for (const Mistake& mistake : mistakes) expect_refused(mistake, kGood);
}

TEST(SceneFile, RefusesRoundThingsThatAreNone) {
  json sphere = kGood, cylinder = kGood, stick = kGood;
  sphere["body"] = json::parse(R"({"sphere": {"radius": 0.02}, "spacing": 0.005})");
  cylinder["body"] = json::parse(R"({"cylinder": {"radius": 0.02, "height": 0.02}, "spacing": 0.005})");
  stick["tool"] = json::parse(R"({"round_stick": {"diameter": 0.008, "length": 0.05, "sides": 16}})");
  expect_refused({"/body/sphere/radius", "-0.02", Code::out_of_range, {"body.sphere.radius", "-0.02"}}, sphere);
  // balls of 25 mm radius do not fit into a sphere of 20 mm
  expect_refused({"/body/spacing", "0.05", Code::too_coarse, {"body: spacing 0.05"}}, sphere);
  expect_refused({"/body/cylinder/height", "0", Code::out_of_range, {"body.cylinder.height", "is 0"}}, cylinder);
  const std::array<Mistake, 4> mistakes{{
      {"/tool/round_stick/diameter", "0", Code::out_of_range, {"tool.round_stick.diameter must be positive, is 0"}},
      {"/tool/round_stick/length", "-0.05", Code::out_of_range, {"tool.round_stick.length", "-0.05"}},
      {"/tool/round_stick/sides", "2", Code::out_of_range, {"tool.round_stick: sides", "is 2"}},
      {"/tool/round_stick/sides", "1e9", Code::out_of_range, {"tool.round_stick: sides", "1e+09"}},
  }};
  for (const Mistake& mistake : mistakes) expect_refused(mistake, stick);
}

TEST(SceneFile, RefusesWorkspacesAndTrajectoriesThatAreNone) {
  json scene = kGood;
  scene["motion"]["replay"] =
      json::parse(R"({"file": "press_1mm_s", "workspace": {"position": [0, 0.03, 0], "scale": 1}})");
  const std::array<Mistake, 5> mistakes{{
      {"/motion/replay/workspace/scale", "0", Code::out_of_range, {"motion.replay.workspace.scale", "is 0"}},
      {"/motion/replay/workspace/position", nullptr, Code::format, {"motion.replay.workspace.position is missing"}},
      {"/motion/replay/workspace/mount_degrees", "3", Code::format, {"motion.replay.workspace.mount_axis is missing"}},
      {"/motion/replay/file", R"("nothing.ctraj")", Code::io, {"motion.replay", "nothing.ctraj"}},
      {"/motion/replay/speed", "2", Code::format, {"motion.replay.speed is not a key"}},
  }};
  for (const Mistake& mistake : mistakes) expect_refused(mistake, scene);
}

// JSON has no word for NaN, so it is bad JSON; a number too great for a double is refused too.
TEST(SceneFile, RefusesBadJson) {
  const std::string good = kGood.dump();
  std::string nan = good, infinite = good;
  nan.replace(nan.find("0.005"), 5, "NaN");
  infinite.replace(infinite.find("0.005"), 5, "1e999");
  for (const std::string& text : {std::string(), std::string("{"), std::string("not json"), nan, infinite, good + "}",
                                  std::string("\xff\xfe{}")}) {
    SCOPED_TRACE(text);
    const Outcome outcome = load(text);
    EXPECT_EQ(outcome.code, Code::format);
    EXPECT_NE(outcome.message.find("scene.json"), std::string::npos) << outcome.message;
  }
  for (std::size_t size = 1; size < good.size(); size += 37) EXPECT_EQ(load(good.substr(0, size)).code, Code::format);
}

TEST(SceneFile, IsNamedWhenItCannotBeRead) {
  const TemporaryFolder folder;
  const std::string long_name(5000, 'x');
  for (const std::string& name : {std::string("tofu_pyramid"), folder.file("missing.json").string(),
                                  folder.file("").string(), long_name, std::string()}) {
    try {
      load_scene(name, Preset::standard);
      ADD_FAILURE() << "loaded " << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), Code::io);
      EXPECT_NE(std::string(error.what()).find("'" + name + "'"), std::string::npos);
      EXPECT_NE(std::string(error.what()).find("tofu_cube_upright"), std::string::npos) << "the list of scenes";
    }
  }
}

}  // namespace
}  // namespace crumble
