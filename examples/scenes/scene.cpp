#include "scenes/scene.hpp"

#include <algorithm>
#include <filesystem>

#include "crumble/base/file.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/text.hpp"
#include "crumble/bubblemesh/presets.hpp"
#include "scenes/embedded.hpp"
#include "scenes/read_tools.hpp"

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
  material.spring_damping = fields.number("spring_damping", material.spring_damping);
  material.length_limit = fields.number("length_limit", material.length_limit);
  material.mass = fields.number("mass", material.mass);
  fields.finish();
  return material;
}

Wall read_wall(Fields fields) {
  Wall wall{{fields.direction("normal"), fields.number("offset")}, {}};
  if (fields.has("friction")) wall.friction = read_friction(fields.object("friction"));
  fields.finish();
  return wall;
}

DragFrame read_drag_frame(Fields& scene) {
  const std::string name = scene.text("drag_frame");
  if (name == "fragment") return DragFrame::fragment;
  if (name == "room") return DragFrame::room;
  Fields::fail(scene.name("drag_frame"), "must be fragment or room, is " + name);
}

Vector<std::uint32_t> read_fixed(Fields& scene, const TetMesh& mesh) {
  Vector<std::uint32_t> nodes;
  if (scene.has("fixed_below")) nodes = nodes_below(mesh, scene.number("fixed_below"));
  if (scene.has("fixed")) {
    for (Fields& region : scene.objects("fixed")) {
      const Vector<std::uint32_t> more = read_region(std::move(region), mesh);
      nodes.insert(nodes.end(), more.begin(), more.end());
    }
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

void read_step(Fields& fields, StepSettings& step) {
  if (fields.has("drag_frame")) step.drag_frame = read_drag_frame(fields);
  step.surface_samples = fields.truth("surface_samples", step.surface_samples);
  step.ball_contact = fields.truth("ball_contact", step.ball_contact);
  if (fields.has("precision")) step.precision = read_precision(fields);
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
  scene.def.fixed_nodes = read_fixed(fields, scene.def.mesh);
  scene.def.gravity = fields.vector("gravity", scene.def.gravity);
  if (fields.has("walls")) {
    scene.def.walls.clear();
    for (Fields& wall : fields.objects("walls")) scene.def.walls.push_back(read_wall(std::move(wall)));
  }
  if (fields.has("ball_friction")) scene.def.ball_friction = read_friction(fields.object("ball_friction"));
  read_tools(fields, folder, scene);
  if (fields.has("attachments")) read_attachments(fields, scene);
  read_step(fields, scene.def.step);
  if (preset == Preset::paper) apply_paper_preset(scene.def);
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

Vector<std::string> scene_names() {
  Vector<std::string> names;
  for (const std::string_view file : embedded_names()) {
    if (file.ends_with(".json")) names.emplace_back(file.substr(0, file.size() - 5));
  }
  return names;
}

}  // namespace crumble
