#include "support/oracles.hpp"

#include <ccd/ccd.h>
// the fine-grained headers: fcl/fcl.h takes several seconds to compile
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/distance.h>

#include <Eigen/Geometry>

namespace crumble {
namespace {

struct MprBody {
  const ConvexPolyhedron* shape;
  Quat orientation;
  Vec3 position, center;
  double scale;
};

ccd_vec3_t to_ccd(const Vec3& v) {
  return {{v.x(), v.y(), v.z()}};
}

void body_support(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* out) {
  const auto& body = *static_cast<const MprBody*>(object);
  const Vec3 local = body.orientation.conjugate() * Vec3(direction->v[0], direction->v[1], direction->v[2]);
  const Vec3* farthest = &body.shape->vertices.front();
  for (const Vec3& v : body.shape->vertices) {
    if (v.dot(local) > farthest->dot(local)) farthest = &v;
  }
  *out = to_ccd(body.scale * (body.orientation * *farthest + body.position));
}

void body_center(const void* object, ccd_vec3_t* out) {
  const auto& body = *static_cast<const MprBody*>(object);
  *out = to_ccd(body.scale * body.center);
}

void point_support(const void* object, const ccd_vec3_t*, ccd_vec3_t* out) {
  *out = *static_cast<const ccd_vec3_t*>(object);
}

void point_center(const void* object, ccd_vec3_t* out) {
  *out = *static_cast<const ccd_vec3_t*>(object);
}

}  // namespace

MprAnswer mpr_penetration(const ConvexPolyhedron& shape, const Pose& pose, const Vec3& point, const Vec3& center) {
  const double scale = 1 / shape.half_thickness;
  const MprBody body{&shape, pose.orientation, pose.position - point, center - point, scale};
  const ccd_vec3_t origin = to_ccd(Vec3::Zero());  // the point is the origin, so that nothing cancels far from it
  ccd_t ccd;
  CCD_INIT(&ccd);
  ccd.support1 = body_support, ccd.support2 = point_support;
  ccd.center1 = body_center, ccd.center2 = point_center;
  ccd.max_iterations = 200;
  ccd.mpr_tolerance = 1e-9;
  ccd_real_t depth = 0;
  ccd_vec3_t direction{}, position{};  // MPR, unlike GJK, takes no null pointers
  MprAnswer answer;
  answer.inside = ccdMPRPenetration(&body, &origin, &ccd, &depth, &direction, &position) == 0;
  answer.depth = depth / scale;
  answer.direction = {direction.v[0], direction.v[1], direction.v[2]};
  return answer;
}

struct FclSurface::Model {
  fcl::BVHModel<fcl::OBBRSS<double>> triangles;
  fcl::Sphere<double> ball{1e-4};
  double scale;
};

FclSurface::FclSurface(const ConvexPolyhedron& body) : model_(std::make_unique<Model>()) {
  model_->scale = 1 / body.half_thickness;
  std::vector<Vec3> vertices;
  for (const Vec3& v : body.surface.vertices) vertices.push_back(model_->scale * v);
  std::vector<fcl::Triangle> triangles;
  for (const auto& [a, b, c] : body.surface.triangles) triangles.emplace_back(a, b, c);
  model_->triangles.beginModel();
  model_->triangles.addSubModel(vertices, triangles);
  model_->triangles.endModel();
}

FclSurface::~FclSurface() = default;

double FclSurface::distance(const Pose& pose, const Vec3& point) const {
  fcl::Transform3<double> tool = fcl::Transform3<double>::Identity(), ball = tool;
  tool.linear() = pose.orientation.toRotationMatrix();
  tool.translation() = model_->scale * pose.position;
  ball.translation() = model_->scale * point;
  fcl::DistanceRequest<double> request;
  fcl::DistanceResult<double> result;
  fcl::distance(&model_->triangles, tool, &model_->ball, ball, request, result);
  return (result.min_distance + model_->ball.radius) / model_->scale;
}

double FclSurface::least_distance() const {
  return 2 * model_->ball.radius / model_->scale;
}

}  // namespace crumble
