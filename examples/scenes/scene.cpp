#include "scenes/scene.hpp"

#include <algorithm>
#include <filesystem>

#include "crumble/base/file.hpp"
#include "crumble/base/text.hpp"
#include "crumble/base/transcendental.hpp"
#include "crumble/bubblemesh/presets.hpp"
#include "scenes/embedded.hpp"
#include "scenes/fields.hpp"

namespace crumble {
namespace {

Structure read_structure(Fields& body) {
  const std::string name = body.text("structure");
  if (name == "relaxed") return Structure::relaxed;
  if (name == "lattice") return Structure::lattice;
  Fields::fail(body.name("structure"), "must be relaxed or lattice, is " + name);
}

Precision read_precision(Fields& scene) {
  const std::string name = scene.text("precision");
  if (name == "float64") return Precision::float64;
  if (name == "float32") return Precision::float32;
  Fields::fail(scene.name("precision"), "must be float64 or float32, is " + name);
}

BubbleMesh read_body(Fields body) {
  if (body.has("paper")) {
    const std::string name = body.text("paper");
    body.finish();
    for (const PaperBody paper : {PaperBody::cube, PaperBody::slab, PaperBody::globe, PaperBody::globe_literal}) {
      if (name == paper_body_facts(paper).name) return generate_paper_body(paper);
    }
    Fields::fail(body.name("paper"), "must be cube, slab, globe or globe_literal, is " + name);
  }
  std::unique_ptr<Shape> shape;
  if (body.has("box")) {
    shape = make_box(body.sizes("box"));
  } else if (body.has("sphere")) {
    Fields sphere = body.object("sphere");
    shape = make_sphere(sphere.positive("radius"));
    sphere.finish();
  } else if (body.has("cylinder")) {
    Fields cylinder = body.object("cylinder");
    shape = make_cylinder(cylinder.positive("radius"), cylinder.positive("height"));
    cylinder.finish();
  } else {
    Fields::fail(body.name("paper"), "is missing, and so are box, sphere and cylinder: a body needs one of them");
  }
  BubbleMeshOptions options;
  options.spacing = body.positive("spacing");
  options.offset = body.vector("offset", options.offset);
  if (body.has("structure")) options.structure = read_structure(body);
  if (body.has("surface_nodes")) options.surface_nodes = body.count("surface_nodes");
  if (body.has("inside_nodes")) options.inside_nodes = body.count("inside_nodes");
  body.finish();
  return body.build([&] { return generate(*shape, options); });
}

Material read_material(Fields fields) {
  Material material;
  material.stiffness = fields.number("stiffness", material.stiffness);
  material.damping_ratio = fields.number("damping_ratio", material.damping_ratio);
  material.length_limit = fields.number("length_limit", material.length_limit);
  material.mass = fields.number("mass", material.mass);
  fields.finish();
  return material;
}

Friction read_friction(Fields fields) {
  const Friction friction{fields.number("static"), fields.number("dynamic")};
  fields.finish();
  fields.build([&] { check(friction); });
  return friction;
}

Wall read_wall(Fields fields) {
  Wall wall{{fields.direction("normal"), fields.number("offset")}, {}};
  if (fields.has("friction")) wall.friction = read_friction(fields.object("friction"));
  fields.finish();
  return wall;
}

Tool read_tool(Fields fields) {
  Tool tool;
  if (fields.has("round_stick")) {
    Fields stick = fields.object("round_stick");
    const double radius = stick.positive("diameter") / 2, length = stick.positive("length");
    const std::uint32_t sides = stick.has("sides") ? stick.count("sides") : 16;
    stick.finish();
    tool.shape = stick.build([&] { return make_round_stick(radius, length, sides); });
  } else if (fields.has("bar")) {
    tool.shape = make_bar(fields.sizes("bar"));
  } else {
    Fields::fail(fields.name("round_stick"), "is missing, and so is bar: a tool needs one of them");
  }
  if (fields.has("friction")) tool.friction = read_friction(fields.object("friction"));
  fields.finish();
  return tool;
}

Quat read_turn(Fields& fields, const char* axis, const char* degrees) {
  if (!fields.has(axis) && !fields.has(degrees)) return Quat::Identity();
  const double angle = fields.number(degrees);
  require_in_range(fields.name(degrees), angle, -360, 360);
  return axis_angle(fields.direction(axis), angle * kPi / 180);
}

double lowest(const ConvexPolyhedron& shape, const Quat& orientation) {
  const Mat3 turn = rotation_matrix(orientation);
  double least = rotate(turn, shape.vertices[0]).y();
  for (const Vec3& v : shape.vertices) least = std::min(least, rotate(turn, v).y());
  return least;
}

// Where the tool starts: `clearance` above the body, at x and z, turned.
Pose read_start(Fields fields, const Scene& scene) {
  Pose pose;
  pose.orientation = read_turn(fields, "axis", "degrees");
  const double clearance = fields.number("clearance", 0);
  pose.position = {fields.number("x", 0), scene.top + clearance - lowest(scene.def.tools[0].shape, pose.orientation),
                   fields.number("z", 0)};
  fields.finish();
  return pose;
}

WorkspaceOptions read_workspace(Fields fields) {
  WorkspaceOptions workspace;
  workspace.pose.position = fields.vector("position");
  workspace.pose.orientation = read_turn(fields, "axis", "degrees");
  workspace.mount = read_turn(fields, "mount_axis", "mount_degrees");
  workspace.scale = fields.positive("scale", 1);
  workspace.force_gain = fields.number("force_gain", 1);
  fields.finish();
  return workspace;
}

void read_motion(Fields fields, const std::filesystem::path& folder, Scene& scene) {
  if (fields.has("press")) {
    Fields press = fields.object("press");
    scene.press.speed = press.positive("speed", scene.press.speed);
    scene.press.depth = press.positive("depth");
    press.finish();
  }
  if (fields.has("replay")) {
    Fields replay = fields.object("replay");
    const std::string file = replay.text("file");
    std::error_code none;
    const bool beside = !folder.empty() && std::filesystem::exists(folder / file, none);
    scene.trajectory = replay.build([&] { return load_trajectory(beside ? (folder / file).string() : file); });
    if (replay.has("from")) scene.replay.from = replay.number("from");
    if (replay.has("to")) scene.replay.to = replay.number("to");
    scene.workspace = read_workspace(replay.object("workspace"));
    replay.finish();
  }
  if (!fields.has("press") && !fields.has("replay")) {
    Fields::fail(fields.name("press"), "is missing, and so is replay: a motion needs one of them");
  }
  fields.finish();
}

Scene read_scene(Fields fields, const std::filesystem::path& folder, Preset preset) {
  Scene scene;
  scene.description = fields.text("description");
  BubbleMesh body = read_body(fields.object("body"));
  scene.def.mesh = std::move(body.mesh);
  scene.quality = body.quality;
  scene.warnings = std::move(body.warnings);
  for (const Vec3& p : scene.def.mesh.positions) scene.top = std::max(scene.top, p.y());
  if (fields.has("material")) scene.def.material = read_material(fields.object("material"));
  if (fields.has("fixed_below")) scene.def.fixed_nodes = nodes_below(scene.def.mesh, fields.number("fixed_below"));
  scene.def.gravity = fields.vector("gravity", scene.def.gravity);
  if (fields.has("walls")) {
    scene.def.walls.clear();
    for (Fields& wall : fields.objects("walls")) scene.def.walls.push_back(read_wall(std::move(wall)));
  }
  scene.def.tools.push_back(read_tool(fields.object("tool")));
  if (fields.has("precision")) scene.def.step.precision = read_precision(fields);
  if (preset == Preset::paper) apply_paper_preset(scene.def);
  scene.start = read_start(fields.object("start"), scene);
  scene.press.start = scene.start;
  read_motion(fields.object("motion"), folder, scene);
  fields.finish();
  return scene;
}

std::string read_scene_file(const std::string& name) {
  try {
    return read_text(name);
  } catch (const Error& error) {
    std::string list;
    for (const std::string& each : scene_names()) list += " " + each;
    throw Error(error.code(),
                "scene '" + name + "' is not one of the built-in scenes:" + list + "; and as a file: " + error.what());
  }
}

}  // namespace

Trajectory load_trajectory(const std::string& name) {
  if (const auto text = embedded_file(name + ".ctraj")) return parse_trajectory(*text, name);
  return read_trajectory(name);
}

Scene load_scene(const std::string& name, Preset preset) {
  const auto built_in = embedded_file(name + ".json");
  const std::string text = built_in ? std::string(*built_in) : read_scene_file(name);
  try {
    const nlohmann::json json = nlohmann::json::parse(text);
    const auto folder = built_in ? std::filesystem::path() : std::filesystem::absolute(name).parent_path();
    Scene scene = read_scene({json, ""}, folder, preset);
    scene.name = built_in ? name : std::filesystem::path(name).stem().string();
    return scene;
  } catch (const nlohmann::json::exception& error) {
    throw Error(Code::format, "scene '" + name + "': " + error.what());
  } catch (const Error& error) {
    throw Error(error.code(), "scene '" + name + "': " + error.what());
  }
}

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const std::string_view file : embedded_names()) {
    if (file.ends_with(".json")) names.emplace_back(file.substr(0, file.size() - 5));
  }
  return names;
}

}  // namespace crumble
