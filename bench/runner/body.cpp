#include "runner/body.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/random.hpp"
#include "crumble/bubblemesh/presets.hpp"
#include "runner/choice.hpp"

namespace crumble::bench {
namespace {

constexpr double kPaperEdge = 0.03, kPaperMass = 0.03, kSpacing = 0.0044;  // m, kg, m

// A cube with edges of s spacings has about 9.9 s^3 springs, seven to a node, and 12 s^2 that its surface adds.
double edge_in_spacings(double springs) {
  double s = std::cbrt(springs / 9.9);
  for (int i = 0; i < 20; ++i) s = std::cbrt((springs - 12 * s * s) / 9.9);
  return s;
}

TetMesh make_box_mesh(const Vec3& size, Structure structure) {
  BubbleMeshOptions options;
  options.spacing = kSpacing;
  options.structure = structure;
  return generate(*make_box(size), options).mesh;
}

// Within 3 % of the number of springs. The first guess fits large bodies; of small ones one axis after the other is
// changed, since their springs come and go by the layer.
TetMesh fit_box_mesh(std::size_t springs, Structure structure) {
  Vec3 size = Vec3::Constant(kSpacing * edge_in_spacings(static_cast<double>(springs)));
  TetMesh best;
  double least_error = 1;
  for (int attempt = 0; attempt < 8 && least_error > 0.03; ++attempt) {
    TetMesh mesh = make_box_mesh(size, structure);
    const double share = static_cast<double>(mesh.springs.size()) / static_cast<double>(springs);
    size[attempt % 3] /= share;
    if (std::abs(share - 1) < least_error) least_error = std::abs(share - 1), best = std::move(mesh);
  }
  return best;
}

// 0 ... n - 1 in random order (Fisher and Yates).
Vector<std::uint32_t> random_order(std::size_t n, Random& random) {
  Vector<std::uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0u);
  for (std::size_t i = n; i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
  return order;
}

TetMesh shuffle(const TetMesh& mesh, Vector<std::uint32_t>& places) {
  Random random(1);
  places = random_order(mesh.node_count(), random);
  Vector<Vec3> positions(mesh.node_count());
  Vector<NodeKind> kinds(mesh.node_count());
  for (std::size_t i = 0; i < places.size(); ++i) {
    positions[places[i]] = mesh.positions[i];
    kinds[places[i]] = mesh.kinds[i];
  }
  Vector<Tetrahedron> tetrahedra;
  for (const std::uint32_t t : random_order(mesh.tetrahedra.size(), random)) {
    const Tetrahedron& old = mesh.tetrahedra[t];
    tetrahedra.push_back({places[old[0]], places[old[1]], places[old[2]], places[old[3]]});
  }
  return make_tet_mesh(std::move(positions), std::move(tetrahedra), std::move(kinds));
}

void set_scene(BenchBody& body) {
  Vec3 low = body.ordered.positions[0], high = low;
  for (const Vec3& p : body.ordered.positions) low = low.cwiseMin(p), high = high.cwiseMax(p);
  body.height = high.y();
  body.scale = (high.x() - low.x()) / kPaperEdge;
  body.stick_scale = body.stick == "scaled" ? body.scale : 1;
  body.def.material.mass = kPaperMass * body.scale * body.scale * body.scale;
  body.def.gravity = Vec3::Zero();
  body.def.fixed_nodes = nodes_below(body.def.mesh, low.y() + 1e-6);
  body.def.tools.push_back({make_round_stick(0.004 * body.stick_scale, 0.05 * body.scale, 16), {0.5, 0.5}});
}

}  // namespace

Vector<std::string> structure_names() {
  return {"lattice", "default", "shuffled"};
}

Vector<std::string> stick_names() {
  return {"paper", "scaled"};
}

BenchBody make_body(std::size_t springs, const std::string& structure, const std::string& stick) {
  require_choice("--structure", structure, structure_names());
  require_choice("--stick", stick, stick_names());
  require_in_range("--springs", static_cast<double>(springs), kLeastSprings, kMostSprings);
  BenchBody body;
  body.structure = structure;
  body.stick = stick;
  body.lattice = structure == "lattice" ? "fcc" : "hcp";
  body.wanted_springs = springs;
  if (structure == "lattice") {
    body.ordered = fit_box_mesh(springs, Structure::lattice);
  } else {
    body.ordered =
        springs < 6000 ? generate_paper_body(PaperBody::cube).mesh : fit_box_mesh(springs, Structure::relaxed);
  }
  if (structure == "shuffled") {
    body.def.mesh = shuffle(body.ordered, body.places);
  } else {
    body.def.mesh = body.ordered;
    body.places.resize(body.ordered.node_count());
    std::iota(body.places.begin(), body.places.end(), 0u);
  }
  set_scene(body);
  return body;
}

}  // namespace crumble::bench
