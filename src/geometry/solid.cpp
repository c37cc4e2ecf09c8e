#include "crumble/geometry/solid.hpp"

#include <algorithm>
#include <cmath>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/geometry/mesh_solid.hpp"
#include "crumble/geometry/tool_solids.hpp"
#include "geometry/solid_bytes.hpp"

namespace crumble {

void SolidModel::set_corners(const Vector<Vec3>& corners) {
  corners_ = VecArray((corners.size() + 3) / 4 * 4);
  for (std::size_t i = 0; i < corners_.size(); ++i) corners_.set(i, corners[std::min(i, corners.size() - 1)]);
}

namespace {

class PolyhedronModel final : public SolidModel {
 public:
  explicit PolyhedronModel(ConvexPolyhedron body) : body_(std::move(body)) {
    if (body_.planes.size() < 4) throw Error(Code::empty, "tool.shape has no faces");
    set_corners(body_.vertices);
    half_thickness_ = body_.half_thickness;
    edge_sine_ = body_.edge_sine;
    surface_ = body_.surface;
  }

  // Most points that are asked for are outside, and mostly above the face that they were above last time.
  bool find_inside(const Vec3& p, std::uint32_t& hint, SolidPoint& nearest) const noexcept override {
    const Plane& likely = body_.planes[hint < body_.planes.size() ? hint : 0];  // it may be another solid's
    if (dot(likely.normal, p) - likely.offset >= 0) return false;
    const double distance = greatest_plane_distance(body_, p, hint);
    if (!(distance < 0)) return false;  // nor what is not a number
    nearest = {p - distance * body_.planes[hint].normal, body_.planes[hint].normal, distance};
    return true;
  }

  SolidPoint nearest(const Vec3& p, double far) const noexcept override {
    const SurfaceQuery query = nearest_surface(body_, p, far);
    return {query.point, body_.planes[query.plane].normal, query.signed_distance};
  }

  bool leave_along(const Vec3& p, const Vec3& direction, SolidPoint& out) const noexcept override {
    double least = std::numeric_limits<double>::infinity();
    for (const Plane& plane : body_.planes) {
      const double approach = dot(plane.normal, direction);
      if (approach <= 0) continue;
      const double way = (plane.offset - dot(plane.normal, p)) / approach;
      if (way < least) least = way, out.normal = plane.normal;
    }
    if (!std::isfinite(least)) return false;
    out.point = p + least * direction;
    out.signed_distance = -least;
    return true;
  }

  void write(ByteWriter& out) const override {
    out.put(static_cast<std::uint8_t>(SolidKind::polyhedron));
    put_mesh(out, body_.surface);
  }

 private:
  ConvexPolyhedron body_;
};

}  // namespace

Solid::Solid(ConvexPolyhedron polyhedron) : model_(share_new<PolyhedronModel>(std::move(polyhedron))) {}

double lowest_point(const SolidModel& solid, const Frame& frame) {
  double least = frame.to_scene(solid.corners()[0]).y();
  for (std::size_t i = 1; i < solid.corners().size(); ++i) {
    least = std::min(least, frame.to_scene(solid.corners()[i]).y());
  }
  return least - solid.rounding();
}

Solid read_solid(ByteReader& in) {
  const auto kind = in.get<std::uint8_t>();
  switch (static_cast<SolidKind>(kind)) {
    case SolidKind::polyhedron:
      return make_convex(get_mesh(in));
    case SolidKind::capsule: {
      const auto radius = in.get<double>();
      return make_capsule(radius, in.get<double>());
    }
    case SolidKind::cone: {
      const auto radius = in.get<double>();
      return make_cone(radius, in.get<double>());
    }
    case SolidKind::mesh:
      return make_mesh_solid(get_mesh(in));
    case SolidKind::support:
      throw Error(Code::unsupported, "recording holds a tool shape made of a support function, which no file holds");
    default:
      throw Error(Code::corrupt, "recording holds an unknown kind of tool shape, " + std::to_string(kind));
  }
}

}  // namespace crumble
