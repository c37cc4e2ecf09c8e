#include "crumble/bubblemesh/generate.hpp"

#include <algorithm>
#include <cmath>

#include "bubblemesh/cloud.hpp"
#include "bubblemesh/delaunay.hpp"
#include "bubblemesh/features.hpp"
#include "bubblemesh/improve.hpp"
#include "bubblemesh/lattice.hpp"
#include "bubblemesh/lattice_cut.hpp"
#include "bubblemesh/populate.hpp"
#include "bubblemesh/relax.hpp"
#include "bubblemesh/repair.hpp"
#include "bubblemesh/restrict.hpp"
#include "bubblemesh/row_order.hpp"
#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/text.hpp"

namespace crumble {
namespace {

constexpr double kMostNodes = 5e6;
constexpr double kFinestSpacing = 1e-9,
                 kCoarsestSpacing = 1e9;  // metres; cubes of them are far from under- and overflow
constexpr double kFarthestOffset = 1000;  // in spacings; the lattice repeats after a few
constexpr double kLeastThickness = 1.25;  // in spacings; random thinner spheres failed, 2000 of this thickness did not
constexpr double kLeastLatticeThickness = 2;
constexpr double kOnSurface = 1e-9;  // of the body's extent
constexpr double kMuchVolume = 0.1;  // of the body's: a mesh that lacks more is worth a warning
constexpr int kRepairRounds = 6;
constexpr int kRepairIterations = 30;

double expected_nodes(const Shape& shape, double spacing) {
  const double inside = std::sqrt(2.0) * (shape.volume() / spacing / spacing / spacing);
  const double surface = shape.area() / spacing / spacing;
  return inside + surface;
}

void check_options(const Shape& shape, const BubbleMeshOptions& options) {
  require_positive("spacing", options.spacing);
  require_in_range("spacing", options.spacing, kFinestSpacing, kCoarsestSpacing);
  require_in_range("offset.x", options.offset.x(), -kFarthestOffset, kFarthestOffset);
  require_in_range("offset.y", options.offset.y(), -kFarthestOffset, kFarthestOffset);
  require_in_range("offset.z", options.offset.z(), -kFarthestOffset, kFarthestOffset);
  if (options.surface_nodes.has_value() != options.inside_nodes.has_value()) {
    throw Error(Code::invalid_value, "surface_nodes and inside_nodes must be given together");
  }
  if (options.structure == Structure::lattice && options.surface_nodes) {
    throw Error(Code::unsupported,
                "surface_nodes and inside_nodes cannot be chosen with structure lattice: its nodes come by themselves");
  }
  const double greatest = largest_spacing(shape, options.structure);
  if (options.spacing > greatest) {
    throw Error(Code::too_coarse, "spacing " + to_text(options.spacing) +
                                      " m is too coarse for this body: it may be at most " + to_text(greatest) + " m");
  }
  const double nodes = expected_nodes(shape, options.spacing);
  if (!(nodes <= kMostNodes)) {
    throw Error(Code::too_large, "spacing " + to_text(options.spacing) + " m would give about " +
                                     to_text(std::floor(nodes)) + " nodes, more than 5 million");
  }
}

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
  if (quality.euler_defect != 0)
    fail("it is not one solid ball (Euler defect " + std::to_string(quality.euler_defect) + ")");
  Vector<char> on_boundary(mesh.node_count(), 0);
  for (const Triangle& t : mesh.boundary) {
    for (const std::uint32_t v : t) on_boundary[v] = 1;
  }
  for (std::size_t i = 0; i < mesh.node_count(); ++i) {
    if (on_boundary[i] != (mesh.kinds[i] != NodeKind::inside))
      fail((on_boundary[i] ? "inside node " : "surface node ") + std::to_string(i) +
           (on_boundary[i] ? " lies on its boundary" : " lies under its boundary"));
  }
}

/// Nodes and tetrahedra before improvement.
struct Draft {
  Cloud cloud;
  Vector<CreaseEdge> crease_edges;
  Vector<Tetrahedron> tetrahedra;
};

void populate(const Shape& shape, const BubbleMeshOptions& options, const LatticeFrame& frame, Cloud& cloud) {
  const Carving carving = carve(shape, frame);
  populate_surface(shape, options.spacing, carving, options.surface_nodes, cloud);
  populate_inside(shape, options.spacing, carving, options.inside_nodes, cloud);
}

Draft make_draft(const Shape& shape, const BubbleMeshOptions& options, const LatticeFrame& frame) {
  const double d = options.spacing;
  const bool exact = options.surface_nodes.has_value();
  Vector<int> extra_pieces(shape.creases().size(), 0);
  Draft draft;
  for (int round = 0; round < kRepairRounds; ++round) {
    if (draft.cloud.size() == 0) {
      draft.crease_edges = place_features(shape, d, extra_pieces, draft.cloud);
      populate(shape, options, frame, draft.cloud);
    }
    draft.tetrahedra = delaunay(quantize(draft.cloud.positions));
    restrict_to_shape(shape, d, draft.cloud, draft.tetrahedra);
    const Flaws flaws = find_flaws(draft.cloud, draft.crease_edges, draft.tetrahedra);
    if (!flaws.broken_creases.empty()) {  // start again with more nodes on them
      for (const std::size_t crease : flaws.broken_creases) ++extra_pieces[crease];
      draft.cloud = {};
    } else if (!flaws.exposed.empty() && !exact) {
      bring_to_surface(shape, flaws.exposed, draft.cloud);
      relax_surface(shape, d, kRepairIterations, draft.cloud);
      relax_inside(shape, d, kRepairIterations, draft.cloud);
    } else {
      return draft;
    }
  }
  fail("nodes and sharp edges do not find their places");
}

/// Mesh, quality and what the caller has to know.
BubbleMesh finish(const Shape& shape, double spacing, Cloud cloud, Vector<Tetrahedron> tetrahedra) {
  BubbleMesh result;
  result.mesh = make_tet_mesh(std::move(cloud.positions), std::move(tetrahedra), std::move(cloud.kinds));
  result.quality = measure_quality(result.mesh);
  require_valid(result.mesh, result.quality);
  const double meshed = volume(TriangleMesh{result.mesh.positions, result.mesh.boundary});
  result.volume_error = (meshed - shape.volume()) / shape.volume();
  if (shape.least_thickness() < 2 * spacing) {
    result.warnings.push_back("the body is thinner than two spacings: " + to_text(shape.least_thickness()) + " m at " +
                              to_text(spacing) + " m");
  } else if (result.volume_error < -kMuchVolume) {
    result.warnings.push_back("the spacing is coarse for so round a body: the mesh lacks " +
                              to_text(std::floor(-100 * result.volume_error + 0.5)) + " % of its volume");
  }
  return result;
}

BubbleMesh generate_relaxed(const Shape& shape, const BubbleMeshOptions& options) {
  const LatticeFrame frame(options.lattice, lattice_origin(shape, options), options.spacing);
  Draft draft = make_draft(shape, options, frame);
  improve(shape, options.spacing, draft.cloud, draft.tetrahedra);
  const bool creases_kept = find_flaws(draft.cloud, draft.crease_edges, draft.tetrahedra).broken_creases.empty();
  put_in_row_order(frame, draft.cloud, draft.tetrahedra);
  BubbleMesh result = finish(shape, options.spacing, std::move(draft.cloud), std::move(draft.tetrahedra));
  if (!creases_kept) fail("a sharp edge of the body is missing");
  describe_rows(frame, result);
  return result;
}

BubbleMesh generate_lattice(const Shape& shape, const BubbleMeshOptions& options) {
  const LatticeBody body(shape, options.spacing, options.offset);
  LatticeCut cut = cut_lattice(body, options.spacing);
  sort_tetrahedra(cut.tetrahedra);
  BubbleMesh result = finish(shape, options.spacing, std::move(cut.cloud), std::move(cut.tetrahedra));
  const double tolerance = kOnSurface * norm(shape.upper() - shape.lower());
  for (std::size_t i = 0; i < result.mesh.node_count(); ++i) {
    const double distance = shape.signed_distance(result.mesh.positions[i]);
    const bool on_surface = result.mesh.kinds[i] != NodeKind::inside;
    if (on_surface ? std::abs(distance) > tolerance : distance > -tolerance)
      fail("node " + std::to_string(i) + " is not where the surface has it");
  }
  describe_rows(cut.sites, result);
  return result;
}

}  // namespace

double largest_spacing(const Shape& shape, Structure structure) {
  return shape.least_thickness() / (structure == Structure::lattice ? kLeastLatticeThickness : kLeastThickness);
}

BubbleMesh generate(const Shape& shape, const BubbleMeshOptions& options) {
  check_options(shape, options);
  return options.structure == Structure::lattice ? generate_lattice(shape, options) : generate_relaxed(shape, options);
}

}  // namespace crumble
