#include "scenes/read_tools.hpp"

#include <algorithm>

#include "crumble/base/memory.hpp"
#include "crumble/base/transcendental.hpp"
#include "crumble/geometry/mesh_solid.hpp"
#include "crumble/geometry/tool_solids.hpp"
#include "scenes/tool_mesh.hpp"

namespace crumble {
namespace {

using std::filesystem::path;

// A file that a scene names: beside it, or where the name says.
path find_file(const path& folder, const std::string& name) {
  std::error_code none;
  return !folder.empty() && std::filesystem::exists(folder / name, none) ? folder / name : path(name);
}

Solid read_mesh(Fields mesh, const path& folder) {
  const std::string file = mesh.text("file");
  const double scale = mesh.positive("scale", 1);
  const MeshSolidOptions options{.auto_orient = mesh.truth("auto_orient", false)};
  mesh.finish();
  return mesh.build([&] { return make_mesh_solid(read_tool_mesh(find_file(folder, file), scale), options); });
}

Solid read_round_stick(Fields stick) {
  const double radius = stick.positive("diameter") / 2, length = stick.positive("length");
  const std::uint32_t sides = stick.has("sides") ? stick.count("sides") : 16;
  stick.finish();
  return stick.build([&]() -> Solid { return make_round_stick(radius, length, sides); });
}

// A solid that is made from up to two lengths.
template <class Make>
Solid read_sizes(Fields fields, const char* first, const char* second, Make&& make) {
  const double a = fields.number(first), b = second ? fields.number(second) : 0;
  fields.finish();
  return fields.build([&]() -> Solid { return make(a, b); });
}

Solid read_blade(Fields blade) {
  const Vec3 size = blade.sizes("size");
  const double bevel = blade.number("bevel", size.y());
  blade.finish();
  return blade.build([&]() -> Solid { return make_blade(size, bevel); });
}

Solid read_shape(Fields& tool, const path& folder) {
  if (tool.has("round_stick")) return read_round_stick(tool.object("round_stick"));
  if (tool.has("bar")) return make_bar(tool.sizes("bar"));
  if (tool.has("blade")) return read_blade(tool.object("blade"));
  if (tool.has("ball")) {
    return read_sizes(tool.object("ball"), "radius", nullptr, [](double r, double) { return make_ball(r); });
  }
  if (tool.has("capsule")) return read_sizes(tool.object("capsule"), "radius", "length", make_capsule);
  if (tool.has("cone")) return read_sizes(tool.object("cone"), "radius", "height", make_cone);
  if (tool.has("mesh")) return read_mesh(tool.object("mesh"), folder);
  Fields::fail(tool.name("round_stick"),
               "is missing, and so are bar, blade, ball, capsule, cone and mesh: a tool needs one of them");
}

// A turn as its unit axis times its angle; none when neither key is there.
Vec3 read_turn_vector(Fields& fields, const char* axis, const char* degrees, double most) {
  if (!fields.has(axis) && !fields.has(degrees)) return Vec3::Zero();
  const double angle = fields.number(degrees);
  require_in_range(fields.name(degrees), angle, -most, most);
  return angle * kPi / 180 * fields.direction(axis);
}

Quat read_turn(Fields& fields, const char* axis, const char* degrees) {
  if (!fields.has(axis) && !fields.has(degrees)) return Quat::Identity();
  const double angle = fields.number(degrees);
  require_in_range(fields.name(degrees), angle, -360, 360);
  return axis_angle(fields.direction(axis), angle * kPi / 180);
}

Pose read_offset(Fields fields) {
  const Pose offset{fields.vector("position", Vec3::Zero()), read_turn(fields, "axis", "degrees")};
  fields.finish();
  return offset;
}

Tool read_tool(Fields& fields, const path& folder) {
  Tool tool;
  tool.shape = read_shape(fields, folder);
  if (fields.has("friction")) tool.friction = read_friction(fields.object("friction"));
  if (fields.has("offset")) tool.offset = read_offset(fields.object("offset"));
  return tool;
}

// At `position`, or `clearance` above the body at x and z; turned.
Pose read_start(Fields fields, const Tool& tool, double top) {
  Pose pose;
  pose.orientation = read_turn(fields, "axis", "degrees");
  if (fields.has("position")) {
    pose.position = fields.vector("position");
  } else {
    const double clearance = fields.number("clearance", 0);
    const double lowest = lowest_point(*tool.shape, Frame(compose(pose, tool.offset)));
    pose.position = {fields.number("x", 0), top + clearance - lowest, fields.number("z", 0)};
  }
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

Vector<PathPoint> read_path(Fields& motion) {
  Vector<PathPoint> points;
  for (Fields& fields : motion.objects("path")) {
    PathPoint point;
    point.time = fields.number("time");
    point.move = fields.vector("move", Vec3::Zero());
    point.turn = read_turn_vector(fields, "axis", "degrees", 360'000);
    fields.finish();
    points.push_back(point);
  }
  motion.build([&] { open_path({.points = points}, 1); });
  return points;
}

Motion read_motion(Fields fields, const Pose& start, const path& folder) {
  Motion motion;
  motion.start = motion.press.start = start;
  if (fields.has("path")) {
    motion.path = read_path(fields);
    fields.finish();
    return motion;
  }
  if (fields.has("press")) {
    Fields press = fields.object("press");
    motion.press.speed = press.positive("speed", motion.press.speed);
    motion.press.depth = press.positive("depth");
    press.finish();
  }
  if (fields.has("replay")) {
    Fields replay = fields.object("replay");
    const std::string file = replay.text("file");
    motion.trajectory = replay.build([&] { return load_trajectory(find_file(folder, file).string()); });
    if (replay.has("from")) motion.replay.from = replay.number("from");
    if (replay.has("to")) motion.replay.to = replay.number("to");
    motion.workspace = read_workspace(replay.object("workspace"));
    replay.finish();
  }
  if (!fields.has("press") && !fields.has("replay")) {
    Fields::fail(fields.name("press"), "is missing, and so are replay and path: a motion needs one of them");
  }
  fields.finish();
  return motion;
}

}  // namespace

void read_tools(Fields& scene_fields, const path& folder, Scene& scene) {
  const auto add = [&](Tool tool, Fields& motion) {
    const Pose start = read_start(motion.object("start"), tool, scene.top);
    scene.motions.push_back(read_motion(motion.object("motion"), start, folder));
    scene.def.tools.push_back(std::move(tool));
  };
  if (!scene_fields.has("tools")) {
    Fields tool = scene_fields.object("tool");
    Tool read = read_tool(tool, folder);
    tool.finish();
    add(std::move(read), scene_fields);
    return;
  }
  for (Fields& tool : scene_fields.objects("tools")) {
    add(read_tool(tool, folder), tool);
    tool.finish();
  }
  if (scene.def.tools.empty()) Fields::fail(scene_fields.name("tools"), "is empty: a scene has one tool at least");
}

void read_attachments(Fields& scene_fields, Scene& scene) {
  for (Fields& fields : scene_fields.objects("attachments")) {
    Attachment attachment{read_region(fields.object("region"), scene.def.mesh)};
    if (attachment.nodes.empty()) Fields::fail(fields.name("region"), "has no nodes");
    Pose start;
    for (const std::uint32_t i : attachment.nodes) start.position += scene.def.mesh.positions[i];
    start.position = fields.vector("center", start.position / static_cast<double>(attachment.nodes.size()));
    Motion motion;
    motion.start = start;
    motion.path = read_path(fields);
    fields.finish();
    scene.def.attachments.push_back(std::move(attachment));
    scene.motions.push_back(std::move(motion));
  }
}

Friction read_friction(Fields fields) {
  const Friction friction{fields.number("static"), fields.number("dynamic")};
  fields.finish();
  fields.build([&] { check(friction); });
  return friction;
}

Vector<std::uint32_t> read_region(Fields fields, const TetMesh& mesh) {
  Vector<std::uint32_t> nodes;
  if (fields.has("box")) {
    Fields box = fields.object("box");
    const Vec3 low = box.vector("low"), high = box.vector("high");
    nodes = nodes_in_box(mesh, low, high);
    box.finish();
  } else if (fields.has("plane")) {
    Fields plane = fields.object("plane");
    const Vec3 normal = plane.direction("normal");
    nodes = nodes_behind(mesh, {normal, plane.number("offset")});
    plane.finish();
  } else if (fields.has("nodes")) {
    nodes = fields.counts("nodes", mesh.node_count());
  } else {
    Fields::fail(fields.name("box"), "is missing, and so are plane and nodes: a region needs one of them");
  }
  fields.finish();
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

}  // namespace crumble
