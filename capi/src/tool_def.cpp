#include "tool_def.hpp"

#include <string>

#include "crumble/geometry/mesh_solid.hpp"
#include "crumble/geometry/support_solid.hpp"
#include "crumble/geometry/tool_solids.hpp"
#include "defs.hpp"

namespace crumble::capi {
namespace {

crumble_tool_def default_tool_def() {
  crumble_tool_def def{};
  def.struct_size = sizeof def;
  def.shape = CRUMBLE_TOOL_STICK;
  def.radius = 0.004;
  def.length = 0.05;
  def.size[0] = def.size[1] = 0.006;
  def.size[2] = 0.05;
  def.sides = 16;
  def.offset.orientation[0] = 1;
  return def;
}

crumble_wall_def default_wall_def() {
  crumble_wall_def def{};
  def.struct_size = sizeof def;
  def.normal[1] = 1;
  return def;
}

Vec3 to_vector(const double (&v)[3]) {
  return {v[0], v[1], v[2]};
}

TriangleMesh read_triangles(const crumble_tool_def& def) {
  if (def.vertex_count > 0x7fffffffu || def.triangle_count > 0x7fffffffu) {
    throw Error(Code::too_large, "vertex_count and triangle_count must not be above 2^31 - 1");
  }
  if (def.vertex_count > 0) require_pointer("vertices", def.vertices);
  if (def.triangle_count > 0) require_pointer("triangles", def.triangles);
  TriangleMesh mesh;
  mesh.vertices.resize(def.vertex_count);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    mesh.vertices[v] = {def.vertices[3 * v], def.vertices[3 * v + 1], def.vertices[3 * v + 2]};
  }
  mesh.triangles.resize(def.triangle_count);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::copy_n(def.triangles + 3 * t, 3, mesh.triangles[t].begin());
  }
  return mesh;
}

Solid make_tool_shape(const crumble_tool_def& def) {
  switch (def.shape) {
    case CRUMBLE_TOOL_STICK:
      return make_round_stick(def.radius, def.length, def.sides);
    case CRUMBLE_TOOL_BAR:
      return make_bar(to_vector(def.size));
    case CRUMBLE_TOOL_MESH:
      return make_mesh_solid(read_triangles(def), {.auto_orient = def.auto_orient != 0});
    case CRUMBLE_TOOL_BALL:
      return make_ball(def.radius);
    case CRUMBLE_TOOL_CAPSULE:
      return make_capsule(def.radius, def.length);
    case CRUMBLE_TOOL_CONE:
      return make_cone(def.radius, def.length);
    case CRUMBLE_TOOL_BLADE:
      return make_blade(to_vector(def.size), def.bevel == 0 ? def.size[1] : def.bevel);
    case CRUMBLE_TOOL_SUPPORT:
      return make_support_solid({def.support, def.support_context}, to_vector(def.inside));
    default:
      throw Error(Code::out_of_range, "shape must be a CRUMBLE_TOOL_ value, is " + std::to_string(def.shape));
  }
}

}  // namespace

Tool read_tool(const crumble_tool_def* def) {
  const crumble_tool_def given = read_def("def", def, default_tool_def());
  require_at_most("reserved", given.reserved, 0);
  require_at_most("reserved_2", given.reserved_2, 0);
  require_at_most("auto_orient", given.auto_orient, 1);
  const double* const q = given.offset.orientation;
  const Pose offset{to_vector(given.offset.position), Quat(q[0], q[1], q[2], q[3])};
  if (!is_valid(offset)) throw Error(Code::bad_pose, "offset must have a finite position and a unit quaternion");
  const Friction friction{given.static_friction, given.dynamic_friction};
  check(friction);
  return {make_tool_shape(given), friction, renormalized(offset)};
}

Wall read_wall(const crumble_wall_def* def) {
  const crumble_wall_def given = read_def("def", def, default_wall_def());
  require_at_most("reserved", given.reserved, 0);
  const Wall wall{{{given.normal[0], given.normal[1], given.normal[2]}, given.offset},
                  {given.static_friction, given.dynamic_friction}};
  check(wall);
  return wall;
}

}  // namespace crumble::capi

using namespace crumble::capi;

crumble_result crumble_tool_def_init(crumble_tool_def* def, uint32_t struct_size) {
  return guard(__func__, [&](const Call&) {
    write_struct("def", def, struct_size, default_tool_def());
    return CRUMBLE_OK;
  });
}

crumble_result crumble_wall_def_init(crumble_wall_def* def, uint32_t struct_size) {
  return guard(__func__, [&](const Call&) {
    write_struct("def", def, struct_size, default_wall_def());
    return CRUMBLE_OK;
  });
}
