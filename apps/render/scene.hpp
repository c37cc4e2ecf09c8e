// What a picture shows: meshes over a floor, one key light, a camera.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>

#include "crumble/base/memory.hpp"
#include "crumble/geometry/triangle_mesh.hpp"
#include "render/camera.hpp"

namespace crumble::render {

enum class Material : std::uint8_t {
  skin = 0,      // outside of the tofu
  interior = 1,  // broken faces of the tofu
  wood = 2,      // grain along the rest frame's z
  steel = 3,
};

using CornerNormals = std::array<Eigen::Vector3f, 3>;  // unit, one per corner of a triangle

/// Closed, outward triangles in the scene's frame.
struct RenderMesh {
  Vector<Vec3> positions;       // metres
  Vector<Vec3> rest_positions;  // holds the grain to the material while it moves; empty: same as positions
  Vector<Triangle> triangles;
  Vector<CornerNormals> corner_normals;  // one per triangle
  Vector<Material> materials;            // one per triangle
};

struct Scene {
  Vector<RenderMesh> meshes;
  Camera camera;
  Vec3 to_light = {-0.55, 0.76, 0.43};       // towards the key light, any length
  std::optional<double> floor_height = 0.0;  // y of a floor, metres; none: the meshes float before the background
};

/// Sphere about the middle of the box round all vertices: what camera and shadow map have to cover.
struct BoundingSphere {
  Vec3 center = Vec3::Zero();
  double radius = 0;  // metres
};
BoundingSphere bounding_sphere(const Vector<RenderMesh>& meshes);

/// Throws Error, naming the field: mesh (array lengths differ, index past the end), invalid_value (a number that is not
/// finite), empty (nothing to draw), out_of_range (all in one point, no light), and what the camera's check throws.
void check(const Scene& scene);

/// Normals for triangles that come without: at each corner the mean, weighted by area, over the triangles round that
/// vertex which have the same material and a face normal within `crease_degrees` of the corner's own triangle.
/// `materials`: one per triangle.
RenderMesh make_render_mesh(const TriangleMesh& mesh, Vector<Material> materials, double crease_degrees);

}  // namespace crumble::render
