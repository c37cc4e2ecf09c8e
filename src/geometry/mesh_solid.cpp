// The mesh kind: the nearest triangle decides, by its tree, and which side of it a point lies on is told by the
// angle-weighted pseudonormal of the face, edge or vertex met (Baerentzen and Aanaes 2005), which is right for every
// closed mesh, concave corners included.
#include "crumble/geometry/mesh_solid.hpp"

#include <algorithm>
#include <cmath>

#include "crumble/base/clock.hpp"
#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/random.hpp"
#include "geometry/angle.hpp"
#include "geometry/distance_grid.hpp"
#include "geometry/mesh_checks.hpp"
#include "geometry/solid_bytes.hpp"
#include "geometry/triangle_tree.hpp"

namespace crumble {
namespace {

class MeshModel final : public SolidModel {
 public:
  explicit MeshModel(CheckedMesh checked);

  bool find_inside(const Vec3& p, std::uint32_t& hint, SolidPoint& nearest) const noexcept override {
    if (!(grid_.least_distance(p) <= 0)) return false;  // nor what is not a number
    const TriangleTree::Nearest found = tree_.nearest(p, std::numeric_limits<double>::infinity(), hint);
    hint = found.slot;
    const SolidPoint judged = judge(p, found);
    if (!(judged.signed_distance < 0)) return false;
    nearest = judged;
    return true;
  }

  SolidPoint nearest(const Vec3& p, double far) const noexcept override {
    if (grid_.least_distance(p) > far) return {p, Vec3::UnitY(), std::numeric_limits<double>::infinity()};
    return judge(p, tree_.nearest(p, std::numeric_limits<double>::infinity(), 0));
  }

  bool leave_along(const Vec3& p, const Vec3& direction, SolidPoint& out) const noexcept override {
    const TriangleTree::Exit exit = tree_.first_exit(p, direction);
    if (!std::isfinite(exit.way)) return false;
    out = {p + exit.way * direction, face_normals_[exit.triangle], -exit.way};
    return true;
  }

  void write(ByteWriter& out) const override {
    out.put(static_cast<std::uint8_t>(SolidKind::mesh));
    put_mesh(out, surface_);
  }

  std::size_t grid_cells() const { return grid_.cell_count(); }

 private:
  Vec3 pseudonormal(const TriangleTree::Nearest& found) const noexcept;
  SolidPoint judge(const Vec3& p, const TriangleTree::Nearest& found) const noexcept;
  void make_normals();
  double sampled_half_thickness() const;

  static constexpr double kTouch = 1e-9;  // of the size: nearer, p - q is too short to give a direction

  CheckedMesh checked_;
  TriangleTree tree_;
  DistanceGrid grid_;
  Vector<Vec3> face_normals_, vertex_normals_;
};

MeshModel::MeshModel(CheckedMesh checked) : checked_(std::move(checked)), tree_(checked_.mesh), grid_(checked_) {
  surface_ = checked_.mesh;
  make_normals();
  Vec3 low = surface_.vertices[0], high = low;
  for (const Vec3& v : surface_.vertices) low = low.cwiseMin(v), high = high.cwiseMax(v);
  Vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) {
    corners.push_back({i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(), i & 4 ? high.z() : low.z()});
  }
  set_corners(corners);
  half_thickness_ = std::max(sampled_half_thickness(), 1e-3 * (high - low).maxCoeff());
}

void MeshModel::make_normals() {
  vertex_normals_.assign(surface_.vertices.size(), Vec3::Zero());
  for (const Triangle& t : surface_.triangles) {
    const auto corner = [&](std::size_t k) -> const Vec3& { return surface_.vertices[t[k % 3]]; };
    const Vec3 normal = normalized(cross(corner(1) - corner(0), corner(2) - corner(0)));
    face_normals_.push_back(normal);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 to_next = corner(k + 1) - corner(k), to_last = corner(k + 2) - corner(k);
      vertex_normals_[t[k]] += angle_of(dot(to_next, to_last), norm(cross(to_next, to_last))) * normal;
    }
  }
}

// Its length means nothing.
Vec3 MeshModel::pseudonormal(const TriangleTree::Nearest& found) const noexcept {
  const Vec3& face = face_normals_[found.triangle];
  const auto feature = static_cast<std::uint32_t>(found.feature);
  Vec3 normal = face;
  if (found.feature <= TriangleFeature::c) normal = vertex_normals_[surface_.triangles[found.triangle][feature]];
  if (found.feature >= TriangleFeature::ab && found.feature <= TriangleFeature::ca) {
    normal += face_normals_[checked_.opposite[3 * found.triangle + feature - 3] / 3];
  }
  return squared_norm(normal) > 1e-20 ? normal : face;  // a surface folded onto itself
}

// At an edge or corner the normal is the way to the point, so that it turns round the edge as the point does.
SolidPoint MeshModel::judge(const Vec3& p, const TriangleTree::Nearest& found) const noexcept {
  const Vec3 pseudo = pseudonormal(found), way = p - found.point;
  const double distance = std::sqrt(found.squared_distance);
  const double side = dot(way, pseudo) < 0 ? -1 : 1;
  if (found.feature != TriangleFeature::face && distance > kTouch * checked_.size) {
    return {found.point, side / distance * way, side * distance};
  }
  return {found.point, normalized(pseudo), side * distance};
}

// Places at equal steps of area over the triangles in their order, anywhere in the triangle that they fall on.
double MeshModel::sampled_half_thickness() const {
  constexpr std::size_t kPlaces = 1000;
  Random random(1);
  Vector<double> ways;
  const double step = area(surface_) / kPlaces;
  double passed = 0.5 * step;
  for (std::uint32_t t = 0; t < surface_.triangles.size(); ++t) {
    const auto& [ia, ib, ic] = surface_.triangles[t];
    const Vec3 &a = surface_.vertices[ia], &b = surface_.vertices[ib], &c = surface_.vertices[ic];
    for (passed += 0.5 * norm(cross(b - a, c - a)); passed >= step; passed -= step) {
      const double root = std::sqrt(random.uniform()), along = random.uniform();
      const Vec3 place = ((1 - root) * a + root * (1 - along) * b) + root * along * c;
      const Vec3 inward = -face_normals_[t];
      const double way = tree_.first_exit(place + kTouch * checked_.size * inward, inward).way;
      if (std::isfinite(way)) ways.push_back(way);
    }
  }
  if (ways.empty()) return 0;
  std::sort(ways.begin(), ways.end());
  return 0.5 * ways[ways.size() / 20];
}

}  // namespace

Solid make_mesh_solid(const TriangleMesh& mesh, const MeshSolidOptions& options, MeshSolidReport* report) {
  const double start = wall_seconds();
  MeshSolidReport own;
  MeshSolidReport& found = report ? *report : own;
  found = {};
  CheckedMesh checked = check_solid_mesh(mesh, options, found);
  Solid solid;
  if (checked.mesh.triangles.size() <= kMaxPolyhedronTriangles && is_locally_convex(checked)) {
    try {
      solid = make_convex(checked.mesh);
      found.polyhedron = true;
    } catch (const Error& error) {  // convex round each edge, and still not as a whole
      if (error.code() != Code::mesh_nonconvex) throw;
    }
  }
  if (!solid) {
    auto model = share_new<MeshModel>(std::move(checked));
    found.grid_cells = model->grid_cells();
    solid = Solid(std::move(model));
  }
  found.seconds = wall_seconds() - start;
  return solid;
}

}  // namespace crumble
