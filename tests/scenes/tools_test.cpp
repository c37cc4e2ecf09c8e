// Tools, motions, regions and attachments as scenes name them; tools from mesh files.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "crumble/base/file.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/text.hpp"
#include "crumble/base/transcendental.hpp"
#include "crumble/geometry/mesh_solid.hpp"
#include "crumble/geometry/tool_solids.hpp"
#include "render/temporary_folder.hpp"
#include "scenes/scene.hpp"
#include "scenes/tool_mesh.hpp"

namespace crumble {
namespace {

using nlohmann::json;
using render::TemporaryFolder;

const json kBase = json::parse(R"({
  "description": "a small box",
  "body": {"box": [0.02, 0.016, 0.02], "spacing": 0.005},
  "tool": {"bar": [0.004, 0.004, 0.03]},
  "start": {"clearance": 0.001},
  "motion": {"path": [{"time": 1}]}
})");

struct Outcome {
  Code code{};
  std::string message;
  Scene scene;
};

Outcome load(const json& scene, const TemporaryFolder& folder = {}) {
  write_text(folder.file("scene.json"), scene.dump());
  try {
    return {{}, {}, load_scene(folder.file("scene.json").string(), Preset::standard)};
  } catch (const Error& error) {
    return {error.code(), error.what(), {}};
  }
}

void expect_refused(Code code, const std::string& message, const std::string& pointer, const char* value) {
  json scene = kBase;
  scene[json::json_pointer(pointer)] = json::parse(value);
  const Outcome outcome = load(scene);
  EXPECT_EQ(static_cast<int>(outcome.code), static_cast<int>(code)) << pointer << " = " << value << outcome.message;
  EXPECT_NE(outcome.message.find(message), std::string::npos) << outcome.message;
}

// The same solid gives the same bytes.
Vector<std::uint8_t> bytes_of(const Solid& solid) {
  ByteWriter out;
  solid->write(out);
  return out.bytes();
}

TEST(SceneTools, AreOfEveryKind) {
  const auto expect = [](const char* tool, const Solid& expected) {
    json scene = kBase;
    scene["tool"] = json::parse(tool);
    const Outcome outcome = load(scene);
    ASSERT_EQ(outcome.code, Code{}) << outcome.message;
    EXPECT_EQ(bytes_of(outcome.scene.def.tools[0].shape), bytes_of(expected)) << tool;
  };
  expect(R"({"round_stick": {"diameter": 0.008, "length": 0.05}})", make_round_stick(0.004, 0.05, 16));
  expect(R"({"bar": [0.06, 0.002, 0.06]})", make_bar({0.06, 0.002, 0.06}));
  expect(R"({"blade": {"size": [0.002, 0.02, 0.05], "bevel": 0.004}})", make_blade({0.002, 0.02, 0.05}, 0.004));
  expect(R"({"blade": {"size": [0.002, 0.02, 0.05]}})", make_blade({0.002, 0.02, 0.05}, 0.02));
  expect(R"({"ball": {"radius": 0.01}})", make_ball(0.01));
  expect(R"({"capsule": {"radius": 0.01, "length": 0.03}})", make_capsule(0.01, 0.03));
  expect(R"({"cone": {"radius": 0.01, "height": 0.03}})", make_cone(0.01, 0.03));
}

TEST(SceneTools, AreRefusedByName) {
  expect_refused(Code::format, "tool.round_stick is missing, and so are bar, blade", "/tool", "{}");
  expect_refused(Code::out_of_range, "tool.ball: radius must be positive, is -1", "/tool",
                 R"({"ball": {"radius": -1}})");
  expect_refused(Code::format, "tool.ball.length is not a key", "/tool", R"({"ball": {"radius": 1, "length": 1}})");
  expect_refused(Code::format, "tool.cone.height is missing", "/tool", R"({"cone": {"radius": 1}})");
  expect_refused(Code::out_of_range, "tool.capsule: length", "/tool", R"({"capsule": {"radius": 1, "length": -1}})");
  expect_refused(Code::out_of_range, "tool.blade: bevel", "/tool", R"({"blade": {"size": [1, 1, 1], "bevel": 2}})");
  expect_refused(Code::io, "tool.mesh: ", "/tool", R"({"mesh": {"file": "none.stl"}})");
  expect_refused(Code::unsupported, "must end in .stl, .obj or .ply", "/tool", R"({"mesh": {"file": "none.step"}})");
  expect_refused(Code::out_of_range, "tool.mesh.scale", "/tool", R"({"mesh": {"file": "none.stl", "scale": 0}})");
  expect_refused(Code::format, "tool.offset.axis is missing", "/tool/offset", R"({"degrees": 3})");
  expect_refused(Code::format, "tools is empty", "/tools", "[]");
  expect_refused(Code::format, "tools[0].start is missing", "/tools", R"([{"ball": {"radius": 1}}])");
}

TEST(SceneTools, HaveAStartAndAMotionEach) {
  json scene = kBase;
  scene.erase("tool"), scene.erase("start"), scene.erase("motion");
  scene["tools"] = json::parse(R"([
    {"ball": {"radius": 0.002}, "start": {"position": [0.1, 0.2, 0.3]}, "motion": {"press": {"depth": 0.01}}},
    {"cone": {"radius": 0.002, "height": 0.01}, "friction": {"static": 1, "dynamic": 0.5},
     "offset": {"position": [0, 0, 0.001], "axis": [1, 0, 0], "degrees": -90}, "start": {"clearance": 0.001},
     "motion": {"path": [{"time": 1, "move": [0, -0.01, 0]}, {"time": 3, "axis": [0, 2, 0], "degrees": 720}]}}
  ])");
  Outcome outcome = load(scene);
  ASSERT_EQ(outcome.code, Code{}) << outcome.message;
  const Scene& loaded = outcome.scene;
  ASSERT_EQ(loaded.def.tools.size(), 2u);
  ASSERT_EQ(loaded.motions.size(), 2u);
  EXPECT_EQ(loaded.motions[0].start.position, Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(loaded.motions[0].press.depth, 0.01);
  EXPECT_EQ(loaded.def.tools[1].friction.static_coefficient, 1);
  // the cone's point, 5 mm from its middle, looks down
  EXPECT_NEAR(loaded.motions[1].start.position.y(), 0.016 + 0.001 + 0.005, 1e-15);
  EXPECT_EQ(loaded.def.tools[1].offset.position, Vec3(0, 0, 0.001));
  MotionDevice mover = open_motion(loaded.motions[1], loaded.tick());
  EXPECT_EQ(mover.seconds, 3);
  EXPECT_EQ(loaded.motions[1].path[1].turn, Vec3(0, 4 * kPi, 0));
  DeviceSample sample;
  for (int tick = 0; tick <= 1000; ++tick) ASSERT_EQ(mover.device->read(sample), ReadStatus::ok);
  EXPECT_NEAR(mover.workspace.to_scene(sample.pose).position.y(), loaded.motions[1].start.position.y() - 0.01, 1e-15);
  EXPECT_NO_THROW(Simulation{loaded.def});

  scene["tool"] = json::parse(R"({"ball": {"radius": 1}})");
  EXPECT_EQ(load(scene).code, Code::format) << "tool beside tools";
}

TEST(SceneMotions, AreRefusedByName) {
  expect_refused(Code::format, "motion.press is missing, and so are replay and path", "/motion", "{}");
  expect_refused(Code::format, "motion.path must be a list", "/motion/path", "7");
  expect_refused(Code::empty, "motion: path.points is empty", "/motion/path", "[]");
  expect_refused(Code::format, "motion.path[0].time is missing", "/motion/path", "[{}]");
  expect_refused(Code::out_of_range, "motion: path.points[1].time", "/motion/path", R"([{"time": 2}, {"time": 1}])");
  expect_refused(Code::format, "motion.path[0].axis is missing", "/motion/path", R"([{"time": 1, "degrees": 9}])");
  expect_refused(Code::out_of_range, "motion.path[0].degrees", "/motion/path",
                 R"([{"time": 1, "degrees": 1e9, "axis": [1, 0, 0]}])");
  expect_refused(Code::format, "motion.path[0].position is not a key", "/motion/path",
                 R"([{"time": 1, "position": 1}])");
  expect_refused(Code::format, "motion.press is not a key", "/motion/press", R"({"depth": 1})");
}

TEST(SceneWorld, HasRegionsAndChoices) {
  json scene = kBase;
  scene["fixed_below"] = 1e-6;
  scene["fixed"] = json::parse(R"([{"box": {"low": [-1, 0.0159, -1], "high": [1, 1, 1]}},
                                   {"plane": {"normal": [2, 0, 0], "offset": -0.0099}}, {"nodes": [3, 3]}])");
  scene["drag_frame"] = "room";
  scene["material"]["spring_damping"] = 0.5;
  scene["ball_friction"] = json::parse(R"({"static": 0.9, "dynamic": 0.8})");
  scene["ball_contact"] = scene["surface_samples"] = false;
  const Outcome outcome = load(scene);
  ASSERT_EQ(outcome.code, Code{}) << outcome.message;
  const SimulationDef& def = outcome.scene.def;
  Vector<std::uint32_t> expected;
  for (std::uint32_t i = 0; i < def.mesh.node_count(); ++i) {
    const Vec3& p = def.mesh.positions[i];
    if (p.y() <= 1e-6 || p.y() >= 0.0159 || p.x() <= -0.0099 || i == 3) expected.push_back(i);
  }
  EXPECT_EQ(def.fixed_nodes, expected);
  EXPECT_EQ(def.step.drag_frame, DragFrame::room);
  EXPECT_EQ(def.material.spring_damping, 0.5);
  EXPECT_EQ(def.ball_friction.dynamic_coefficient, 0.8);
  EXPECT_FALSE(def.step.ball_contact);
  EXPECT_FALSE(def.step.surface_samples);

  expect_refused(Code::format, "fixed[0].box is missing, and so are plane and nodes", "/fixed", "[{}]");
  expect_refused(Code::format, "fixed[0].nodes[1] must be a whole number below", "/fixed", R"([{"nodes": [0, 1e6]}])");
  expect_refused(Code::format, "fixed[0].nodes[0] must be a whole number below", "/fixed", R"([{"nodes": [-1]}])");
  expect_refused(Code::format, "drag_frame must be fragment or room, is space", "/drag_frame", R"("space")");
  expect_refused(Code::format, "ball_contact must be true or false, is 1", "/ball_contact", "1");
  expect_refused(Code::out_of_range, "ball_friction", "/ball_friction", R"({"static": 0, "dynamic": 1})");
}

TEST(SceneWorld, HasAttachments) {
  json scene = kBase;
  scene["attachments"] = json::parse(R"([
    {"region": {"plane": {"normal": [0, -1, 0], "offset": -0.0159}}, "path": [{"time": 2, "move": [0, 0.01, 0]}]},
    {"region": {"nodes": [0]}, "center": [1, 2, 3], "path": [{"time": 1}]}])");
  const Outcome outcome = load(scene);
  ASSERT_EQ(outcome.code, Code{}) << outcome.message;
  ASSERT_EQ(outcome.scene.def.attachments.size(), 2u);
  ASSERT_EQ(outcome.scene.motions.size(), 3u) << "the tool's first";
  EXPECT_NEAR(outcome.scene.motions[1].start.position.y(), 0.016, 1e-12) << "the middle of the top";
  EXPECT_EQ(outcome.scene.motions[2].start.position, Vec3(1, 2, 3));
  for (const std::uint32_t i : outcome.scene.def.attachments[0].nodes) {
    EXPECT_GT(outcome.scene.def.mesh.positions[i].y(), 0.0159);
  }
  expect_refused(Code::format, "attachments[0].region has no nodes", "/attachments",
                 R"([{"region": {"nodes": []}, "path": [{"time": 1}]}])");
  expect_refused(Code::format, "attachments[0].path is missing", "/attachments", R"([{"region": {"nodes": [1]}}])");
}

// A pyramid that is dented from below, as every format writes it, in millimetres.
const Vector<Vec3> kCorners{{-5, 0, -5}, {5, 0, -5}, {5, 0, 5}, {-5, 0, 5}, {0, 8, 0}, {0, 3, 0}};
const Vector<Triangle> kFaces{{0, 4, 1}, {1, 4, 2}, {2, 4, 3}, {3, 4, 0}, {0, 1, 5}, {1, 2, 5}, {2, 3, 5}, {3, 0, 5}};

std::string as_text_stl() {
  std::string text = "solid dent\n";
  for (const Triangle& t : kFaces) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const std::uint32_t v : t) {
      text +=
          "vertex " + to_text(kCorners[v].x()) + " " + to_text(kCorners[v].y()) + " " + to_text(kCorners[v].z()) + "\n";
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid dent\n";
}

std::string as_binary_stl() {
  std::string bytes(80, ' ');
  const auto put = [&](auto value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  put(static_cast<std::uint32_t>(kFaces.size()));
  for (const Triangle& t : kFaces) {
    for (int i = 0; i < 3; ++i) put(0.0f);
    for (const std::uint32_t v : t) {
      for (int axis = 0; axis < 3; ++axis) put(static_cast<float>(kCorners[v][axis]));
    }
    put(std::uint16_t{0});
  }
  return bytes;
}

std::string as_obj() {
  std::string text;
  for (const Vec3& v : kCorners) text += "v " + to_text(v.x()) + " " + to_text(v.y()) + " " + to_text(v.z()) + "\n";
  for (const Triangle& t : kFaces) {
    text += "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " + std::to_string(t[2] + 1) + "\n";
  }
  return text;
}

std::string as_ply() {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 8\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3& v : kCorners) text += to_text(v.x()) + " " + to_text(v.y()) + " " + to_text(v.z()) + "\n";
  for (const Triangle& t : kFaces) {
    text += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) + "\n";
  }
  return text;
}

// With squares on the outside, colours, and numbers that are 2 bytes long.
std::string as_binary_ply(bool big_endian) {
  std::string bytes = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
                      "_endian 1.0\ncomment a cube\nelement vertex 8\nproperty double x\nproperty uchar red\n"
                      "property short y\nproperty float z\nelement face 6\nproperty list uint8 uint16 vertex_index\n"
                      "end_header\n";
  const auto put = [&](auto value) {
    std::array<char, sizeof value> raw;
    std::memcpy(raw.data(), &value, sizeof value);
    if (big_endian) std::reverse(raw.begin(), raw.end());
    bytes.append(raw.data(), raw.size());
  };
  for (int i = 0; i < 8; ++i) {
    put(i & 1 ? 1.0 : -1.0), put(std::uint8_t{200}), put(static_cast<std::int16_t>(i & 2 ? 1 : -1));
    put(i & 4 ? 1.0f : -1.0f);
  }
  for (const auto& [a, b, c, d] : {std::array<std::uint16_t, 4>{0, 4, 6, 2},
                                   {1, 3, 7, 5},
                                   {0, 1, 5, 4},
                                   {2, 6, 7, 3},
                                   {0, 2, 3, 1},
                                   {4, 5, 7, 6}}) {
    put(std::uint8_t{4}), put(a), put(b), put(c), put(d);
  }
  return bytes;
}

TEST(MeshFile, OfBinaryPlyIsReadInBothByteOrders) {
  const TemporaryFolder folder;
  for (const bool big_endian : {false, true}) {
    write_text(folder.file("cube.ply"), as_binary_ply(big_endian));
    const TriangleMesh mesh = read_tool_mesh(folder.file("cube.ply"), 0.5);
    EXPECT_EQ(mesh.triangles.size(), 12u);
    EXPECT_EQ(find_surface_defects(mesh).total(), 0u);
    EXPECT_EQ(volume(mesh), 1);
  }
}

TEST(MeshFile, IsReadInEveryFormat) {
  const TemporaryFolder folder;
  const std::array<std::pair<const char*, std::string>, 4> files{
      {{"text.stl", as_text_stl()}, {"binary.STL", as_binary_stl()}, {"dent.obj", as_obj()}, {"dent.ply", as_ply()}}};
  for (const auto& [name, text] : files) {
    SCOPED_TRACE(name);
    write_text(folder.file(name), text);
    const TriangleMesh mesh = read_tool_mesh(folder.file(name), 0.001);
    EXPECT_EQ(mesh.vertices.size(), 6u) << "welded";
    EXPECT_EQ(mesh.triangles.size(), 8u);
    EXPECT_EQ(find_surface_defects(mesh).total(), 0u);
    EXPECT_NEAR(volume(mesh), 1e-9 * 100 * (8 - 3) / 3, 1e-18);
    json scene = kBase;
    scene["tool"] = {{"mesh", {{"file", name}, {"scale", 0.001}}}};
    const Outcome outcome = load(scene, folder);
    ASSERT_EQ(outcome.code, Code{}) << outcome.message;
    EXPECT_EQ(bytes_of(outcome.scene.def.tools[0].shape), bytes_of(make_mesh_solid(mesh)));
    EXPECT_GT(outcome.scene.def.tools[0].shape->nearest({0, 0.001, 0}, 1).signed_distance, 0) << "in the dent";
  }
}

TEST(MeshFile, IsRefusedByName) {
  const TemporaryFolder folder;
  const auto expect = [&](Code code, const std::string& name, const std::string& text, const std::string& message) {
    SCOPED_TRACE(name + " " + message);
    write_text(folder.file(name), text);
    try {
      read_tool_mesh(folder.file(name), 1);
      ADD_FAILURE() << "read";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code) << error.what();
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
    }
  };
  for (const char* name : {"empty.stl", "empty.ply"}) expect(Code::format, name, "", "cannot be read");
  expect(Code::empty, "empty.obj", "", "has no triangle");
  for (const char* name : {"noise.stl", "noise.ply"}) expect(Code::format, name, "\xff\x01 noise", "cannot be read");
  expect(Code::format, "nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "line 1 has no number as its word 2");
  const std::string binary = as_binary_stl(), ply = as_ply();
  expect(Code::format, "short.stl", binary.substr(0, 200), "cannot be read");
  std::string lies = binary;
  lies.replace(80, 4, "\xff\xff\xff\x7f");
  expect(Code::format, "lies.stl", lies, "cannot be read");
  std::string many = ply;
  many.replace(many.find("vertex 6"), 8, "vertex 4000000000");
  expect(Code::format, "many.ply", many, "line 3 announces more than the file holds");
  expect(Code::format, "open.ply", ply.substr(0, ply.find("end_header")), "header has no end");
  expect(Code::format, "index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "line 4 names vertex '9' of 3");
  expect(Code::format, "short.ply", ply.substr(0, 200), "it ends too early");
  EXPECT_THROW(read_tool_mesh(folder.file("missing.stl"), 1), Error);
  std::ofstream(folder.file("huge.stl")).seekp((256 << 20) + 1).put('x');  // no disk is used: it has a hole
  try {
    read_tool_mesh(folder.file("huge.stl"), 1);
    ADD_FAILURE() << "read";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Code::too_large) << error.what();
  }
}

// Cut off at any byte it is read or refused, and never worse.
TEST(MeshFile, MayEndAnywhere) {
  const TemporaryFolder folder;
  for (const auto& [name, text] : {std::pair{"a.stl", as_text_stl()},
                                   {"b.stl", as_binary_stl()},
                                   {"c.obj", as_obj()},
                                   {"d.ply", as_ply()},
                                   {"e.ply", as_binary_ply(true)}}) {
    for (std::size_t size = 0; size < text.size(); size += 7) {
      write_text(folder.file(name), text.substr(0, size));
      try {
        make_mesh_solid(read_tool_mesh(folder.file(name), 1));
      } catch (const Error& error) {
        EXPECT_NE(static_cast<int>(error.code()), 0);
      }
    }
  }
}

TEST(Manual, AllItsScenesLoad) {
  const std::string manual = read_text(CRUMBLE_SOURCE_DIR "/docs/scenes.md"), fence = "```json\n";
  int count = 0;
  for (std::size_t at = manual.find(fence); at != std::string::npos; at = manual.find(fence, at + 1), ++count) {
    const std::size_t begin = at + fence.size();
    const Outcome outcome = load(json::parse(manual.substr(begin, manual.find("```", begin) - begin)));

    ASSERT_EQ(outcome.code, Code{}) << outcome.message;
    EXPECT_NO_THROW(Simulation{outcome.scene.def});
  }
  EXPECT_EQ(count, 2);
}

}  // namespace
}  // namespace crumble
