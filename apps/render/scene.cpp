#include "render/scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/transcendental.hpp"

namespace crumble::render {
namespace {

void require_count(const std::string& field, std::size_t count, std::size_t wanted) {
  if (count != wanted) {
    throw Error(Code::mesh, field + " must have " + std::to_string(wanted) + " entries, has " + std::to_string(count));
  }
}

void require_all_finite(const std::string& field, const Vector<Vec3>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!is_finite(values[i])) throw Error(Code::invalid_value, field + "[" + std::to_string(i) + "] must be finite");
  }
}

void check(const RenderMesh& mesh, const std::string& name) {
  require_count(name + ".corner_normals", mesh.corner_normals.size(), mesh.triangles.size());
  if (!mesh.rest_positions.empty()) {
    require_count(name + ".rest_positions", mesh.rest_positions.size(), mesh.positions.size());
  }
  require_count(name + ".materials", mesh.materials.size(), mesh.triangles.size());
  require_all_finite(name + ".positions", mesh.positions);
  require_all_finite(name + ".rest_positions", mesh.rest_positions);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const Eigen::Vector3f& normal : mesh.corner_normals[t]) {
      if (!is_finite(normal.cast<double>())) {
        throw Error(Code::invalid_value, name + ".corner_normals[" + std::to_string(t) + "] must be finite");
      }
    }
    for (const std::uint32_t v : mesh.triangles[t]) {
      if (v >= mesh.positions.size()) {
        throw Error(Code::mesh, name + ".triangles[" + std::to_string(t) + "] names vertex " + std::to_string(v) +
                                    " of " + std::to_string(mesh.positions.size()));
      }
    }
  }
}

Vec3 unit_or_zero(const Vec3& v) {
  const double length = norm(v);
  return length > 0 ? Vec3(v / length) : Vec3::Zero();
}

}  // namespace

BoundingSphere bounding_sphere(const Vector<RenderMesh>& meshes) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Vec3 lower = Vec3::Constant(kFar), upper = Vec3::Constant(-kFar);
  for (const RenderMesh& mesh : meshes) {
    for (const Vec3& p : mesh.positions) lower = lower.cwiseMin(p), upper = upper.cwiseMax(p);
  }
  return {0.5 * (lower + upper), 0.5 * norm(upper - lower)};
}

void check(const Scene& scene) {
  std::size_t triangles = 0;
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    check(scene.meshes[i], "meshes[" + std::to_string(i) + "]");
    triangles += scene.meshes[i].triangles.size();
  }
  if (triangles == 0) throw Error(Code::empty, "meshes must have at least one triangle to draw, have 0");
  require_positive("size of meshes", bounding_sphere(scene.meshes).radius);
  check(scene.camera);
  if (!is_finite(scene.to_light)) throw Error(Code::invalid_value, "to_light must be finite");
  require_positive("length of to_light", norm(scene.to_light));
  if (scene.floor_height) require_finite("floor_height", *scene.floor_height);
}

RenderMesh make_render_mesh(const TriangleMesh& mesh, Vector<Material> materials, double crease_degrees) {
  require_in_range("crease_degrees", crease_degrees, 0, 180);
  require_count("materials", materials.size(), mesh.triangles.size());
  const double least_cosine = cos_exact(crease_degrees * kPi / 180) - 1e-9;
  Vector<Vec3> weighted(mesh.triangles.size()), facing(mesh.triangles.size());
  Vector<Vector<std::size_t>> around(mesh.vertices.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    weighted[t] = cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]);
    facing[t] = unit_or_zero(weighted[t]);
    for (const std::uint32_t v : mesh.triangles[t]) around[v].push_back(t);
  }
  RenderMesh out{mesh.vertices, {}, mesh.triangles, {}, std::move(materials)};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    CornerNormals& corners = out.corner_normals.emplace_back();
    for (int k = 0; k < 3; ++k) {
      Vec3 sum = Vec3::Zero();
      for (const std::size_t other : around[mesh.triangles[t][k]]) {
        const bool smooth = out.materials[other] == out.materials[t] && dot(facing[other], facing[t]) >= least_cosine;
        if (smooth || other == t) sum += weighted[other];
      }
      corners[k] = unit_or_zero(sum).cast<float>();
    }
  }
  return out;
}

}  // namespace crumble::render
