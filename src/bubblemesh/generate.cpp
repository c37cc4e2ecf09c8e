#include "crumble/bubblemesh/generate.hpp"

#include <algorithm>
#include <cmath>

#include "bubblemesh/cloud.hpp"
#include "bubblemesh/delaunay.hpp"
#include "bubblemesh/features.hpp"
#include "bubblemesh/improve.hpp"
#include "bubblemesh/lattice.hpp"
#include "bubblemesh/populate.hpp"
#include "bubblemesh/restrict.hpp"
#include "bubblemesh/row_order.hpp"
#include "crumble/base/error.hpp"
#include "crumble/base/text.hpp"

namespace crumble {
namespace {

constexpr double kMostNodes = 5e6;

double expected_nodes(const Shape& shape, double spacing) {
  const double inside = std::sqrt(2.0) * (shape.volume() / spacing / spacing / spacing);
  const double surface = shape.area() / spacing / spacing;
  return inside + surface;
}

void check_options(const Shape& shape, const BubbleMeshOptions& options) {
  require_positive("spacing", options.spacing);
  require_finite("offset.x", options.offset.x());
  require_finite("offset.y", options.offset.y());
  require_finite("offset.z", options.offset.z());
  if (options.surface_nodes.has_value() != options.inside_nodes.has_value()) {
    throw Error(Code::invalid_value, "surface_nodes and inside_nodes must be given together");
  }
  const double greatest = largest_spacing(shape);
  if (options.spacing > greatest) {
    throw Error(Code::too_coarse, "spacing " + to_text(options.spacing) + " m is too coarse for this body: it may be at most " +
                                      to_text(greatest) + " m");
  }
  const double nodes = expected_nodes(shape, options.spacing);
  if (!(nodes <= kMostNodes)) {
    throw Error(Code::too_large, "spacing " + to_text(options.spacing) + " m would give about " + to_text(std::floor(nodes)) +
                                     " nodes, more than " + to_text(kMostNodes));
  }
}

/// Whole steps of the lattice move nothing; taking them off keeps the row numbers small.
Vec3 lattice_origin(const Shape& shape, const BubbleMeshOptions& options) {
  return 0.5 * (shape.lower() + shape.upper()) + options.spacing * options.offset;
}

[[noreturn]] void fail(const std::string& what) {
  throw Error(Code::mesh, "the generated mesh is not valid: " + what + "; another offset or spacing may help");
}

void require_valid(const TetMesh& mesh, const MeshQuality& quality) {
  if (quality.boundary_defects.total() != 0) {
    fail("its surface has " + std::to_string(quality.boundary_defects.total()) + " defects");
  }
  if (quality.euler_defect != 0) fail("it is not one solid ball (Euler defect " + std::to_string(quality.euler_defect) + ")");
  std::vector<char> on_boundary(mesh.node_count(), 0);
  for (const Triangle& t : mesh.boundary) {
    for (const std::uint32_t v : t) on_boundary[v] = 1;
  }
  for (std::size_t i = 0; i < mesh.node_count(); ++i) {
    if (on_boundary[i] != (mesh.kinds[i] != NodeKind::inside)) fail((on_boundary[i] ? "inside node " : "surface node ") + std::to_string(i) + (on_boundary[i] ? " lies on its boundary" : " lies under its boundary"));
  }
}

}  // namespace

double largest_spacing(const Shape& shape) { return shape.least_thickness(); }

BubbleMesh generate(const Shape& shape, const BubbleMeshOptions& options) {
  check_options(shape, options);
  const double d = options.spacing;
  const LatticeFrame frame(options.lattice, lattice_origin(shape, options), d);

  Cloud cloud;
  place_features(shape, d, cloud);
  const Carving carving = carve(shape, frame);
  populate_surface(shape, d, carving, options.surface_nodes, cloud);
  populate_inside(shape, d, carving, options.inside_nodes, cloud);

  std::vector<Tetrahedron> tetrahedra = delaunay(quantize(cloud.positions));
  restrict_to_shape(shape, d, cloud, tetrahedra);
  improve(shape, d, cloud, tetrahedra);
  put_in_row_order(frame, cloud, tetrahedra);

  BubbleMesh result;
  result.mesh = make_tet_mesh(std::move(cloud.positions), std::move(tetrahedra), std::move(cloud.kinds));
  result.quality = measure_quality(result.mesh);
  require_valid(result.mesh, result.quality);
  result.volume_error = (volume(result.mesh) - shape.volume()) / shape.volume();
  if (shape.least_thickness() < 2 * d) {
    result.warnings.push_back("the body is thinner than two spacings: " + to_text(shape.least_thickness()) + " m at " + to_text(d) + " m");
  }
  return result;
}

}  // namespace crumble
