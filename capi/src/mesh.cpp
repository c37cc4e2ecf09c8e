#include <string>

#include "crumble/base/memory.hpp"
#include "crumble/bubblemesh/presets.hpp"
#include "crumble/tetmesh/vtk_file.hpp"
#include "defs.hpp"
#include "objects.hpp"

namespace crumble::capi {
namespace {

crumble_mesh_def default_mesh_def() {
  crumble_mesh_def def{};
  def.struct_size = sizeof def;
  def.shape = CRUMBLE_SHAPE_BOX;
  for (double& edge : def.size) edge = 0.03;
  def.radius = 0.02;
  def.height = 0.03;
  def.spacing = 0.0044;
  return def;
}

std::unique_ptr<Shape> make_shape(const crumble_mesh_def& def) {
  switch (def.shape) {
    case CRUMBLE_SHAPE_BOX:
      return make_box({def.size[0], def.size[1], def.size[2]});
    case CRUMBLE_SHAPE_SPHERE:
      return make_sphere(def.radius);
    case CRUMBLE_SHAPE_CYLINDER:
      return make_cylinder(def.radius, def.height);
    default:
      throw Error(Code::out_of_range, "shape must be a CRUMBLE_SHAPE_ value, is " + std::to_string(def.shape));
  }
}

BubbleMeshOptions options_of(const crumble_mesh_def& def) {
  BubbleMeshOptions options;
  options.spacing = def.spacing;
  if (def.surface_nodes != 0) options.surface_nodes = def.surface_nodes;
  if (def.inside_nodes != 0) options.inside_nodes = def.inside_nodes;
  return options;
}

void publish_mesh(TetMesh mesh, crumble_mesh* out) {
  publish(std::make_unique<Mesh>(Mesh{{}, share_new<const TetMesh>(std::move(mesh))}), out);
}

void require_count(const char* field, std::uint32_t count) {
  if (count > 0x7fffffffu)
    throw Error(Code::too_large, std::string(field) + " " + std::to_string(count) + " is above 2^31 - 1");
}

crumble_mesh_info info_of(const TetMesh& mesh) {
  crumble_mesh_info info{};
  info.node_count = static_cast<std::uint32_t>(mesh.node_count());
  info.surface_node_count = static_cast<std::uint32_t>(mesh.surface_node_count());
  info.spring_count = static_cast<std::uint32_t>(mesh.springs.size());
  info.tetrahedron_count = static_cast<std::uint32_t>(mesh.tetrahedra.size());
  info.boundary_triangle_count = static_cast<std::uint32_t>(mesh.boundary.size());
  info.volume = volume(mesh);
  return info;
}

}  // namespace
}  // namespace crumble::capi

using namespace crumble;
using namespace crumble::capi;

crumble_result crumble_mesh_def_init(crumble_mesh_def* def, uint32_t struct_size) {
  return guard(__func__, [&](const Call&) {
    write_struct("def", def, struct_size, default_mesh_def());
    return CRUMBLE_OK;
  });
}

crumble_result crumble_mesh_create(const crumble_mesh_def* def, crumble_mesh* mesh) {
  return guard(__func__, [&](const Call&) {
    require_pointer("mesh", mesh);
    const crumble_mesh_def given = read_def("def", def, default_mesh_def());
    publish_mesh(generate(*make_shape(given), options_of(given)).mesh, mesh);
    return CRUMBLE_OK;
  });
}

crumble_result crumble_mesh_create_paper(uint32_t body, crumble_mesh* mesh) {
  return guard(__func__, [&](const Call&) {
    require_pointer("mesh", mesh);
    require_at_most("body", body, CRUMBLE_PAPER_GLOBE_LITERAL);
    publish_mesh(generate_paper_body(static_cast<PaperBody>(body)).mesh, mesh);
    return CRUMBLE_OK;
  });
}

crumble_result crumble_mesh_create_from_tets(const double* positions, uint32_t node_count, const uint32_t* tetrahedra,
                                             uint32_t tetrahedron_count, crumble_mesh* mesh) {
  return guard(__func__, [&](const Call&) {
    require_pointer("mesh", mesh);
    require_count("node_count", node_count);
    require_count("tetrahedron_count", tetrahedron_count);
    if (node_count > 0) require_pointer("positions", positions);
    if (tetrahedron_count > 0) require_pointer("tetrahedra", tetrahedra);
    Vector<Vec3> points(node_count);
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i] = {positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]};
    }
    Vector<Tetrahedron> tets(tetrahedron_count);
    for (std::size_t t = 0; t < tets.size(); ++t) std::copy_n(tetrahedra + 4 * t, 4, tets[t].begin());
    publish_mesh(make_tet_mesh(std::move(points), std::move(tets)), mesh);
    return CRUMBLE_OK;
  });
}

crumble_result crumble_mesh_save_vtk(crumble_mesh mesh, const char* path) {
  return with<Mesh>(__func__, mesh, [&](const Mesh& m, const Call&) {
    write_vtk(*m.mesh, path_of(path));
    return CRUMBLE_OK;
  });
}

crumble_result crumble_mesh_destroy(crumble_mesh mesh) {
  return destroy<Mesh>(__func__, mesh);
}

crumble_result crumble_mesh_get_info(crumble_mesh mesh, crumble_mesh_info* info) {
  return with<Mesh>(__func__, mesh, [&](const Mesh& m, const Call&) {
    write_struct("info", info, info_of(*m.mesh));
    return CRUMBLE_OK;
  });
}
