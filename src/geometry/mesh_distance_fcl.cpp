// FCL is asked for one thing that it does well, the distance of a small ball from triangles that the ball does not
// touch. Its depth of meshes is not usable (fcl issues 221, 492), and its signed distances of some pairs end in an
// assertion that takes the host program along, so neither is asked for.
#include "geometry/mesh_distance_fcl.hpp"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <vector>

namespace crumble {
namespace {

constexpr double kRadius = 1e-6;  // of the ball, in units of the mesh's size

}  // namespace

Vector<double> distances_from_mesh(const TriangleMesh& mesh, const Vector<Vec3>& points) {
  Vec3 low = mesh.vertices[0], high = low;
  for (const Vec3& v : mesh.vertices) low = low.cwiseMin(v), high = high.cwiseMax(v);
  const Vec3 center = 0.5 * (low + high);
  const double size = norm(high - low);  // FCL compares lengths with fixed numbers

  std::vector<Vec3> vertices;
  for (const Vec3& v : mesh.vertices) vertices.push_back((v - center) / size);
  std::vector<fcl::Triangle> triangles;
  for (const auto& [a, b, c] : mesh.triangles) triangles.emplace_back(a, b, c);
  fcl::BVHModel<fcl::OBBRSS<double>> model;
  model.beginModel(static_cast<int>(triangles.size()), static_cast<int>(vertices.size()));
  model.addSubModel(vertices, triangles);
  model.endModel();

  const fcl::Sphere<double> ball(kRadius);
  const fcl::Transform3<double> still = fcl::Transform3<double>::Identity();
  fcl::Transform3<double> place = still;
  Vector<double> distances;
  for (const Vec3& p : points) {
    place.translation() = (p - center) / size;
    fcl::DistanceResult<double> result;
    const double distance = fcl::distance(&model, still, &ball, place, fcl::DistanceRequest<double>(), result);
    distances.push_back(distance > 0 ? size * (distance + kRadius) : 0);
  }
  return distances;
}

}  // namespace crumble
