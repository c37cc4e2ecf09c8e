#include "crumble/bubblemesh/generate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "bubblemesh/lattice.hpp"
#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

BubbleMesh mesh_of(const Shape& shape, double spacing, const Vec3& offset = Vec3::Zero()) {
  BubbleMeshOptions options;
  options.spacing = spacing;
  options.offset = offset;
  return generate(shape, options);
}

Code error_of(const Shape& shape, const BubbleMeshOptions& options, const std::string& word) {
  try {
    generate(shape, options);
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    return error.code();
  }
  ADD_FAILURE() << "no error: " << word;
  return Code::internal;
}

TEST(Generate, BoxKeepsItsFacesExactly) {
  const auto box = make_box({0.03, 0.02, 0.025});
  const BubbleMesh result = mesh_of(*box, 0.0031, {0.3, 0.1, 0.7});
  EXPECT_LE(std::abs(result.volume_error), 1e-12);
  for (std::size_t i = 0; i < result.mesh.node_count(); ++i) {
    const double distance = box->signed_distance(result.mesh.positions[i]);
    if (result.mesh.kinds[i] == NodeKind::inside) {
      EXPECT_LT(distance, -0.1 * 0.0031);
    } else {
      EXPECT_EQ(distance, 0) << i;
    }
  }
  const auto corners = std::ranges::count(result.mesh.kinds, NodeKind::corner);
  const auto creases = std::ranges::count(result.mesh.kinds, NodeKind::crease);
  EXPECT_EQ(corners, 8);
  EXPECT_EQ(creases, 4 * ((10 - 1) + (6 - 1) + (8 - 1)));  // 30, 20, 25 mm in pieces nearest to 3.1 mm
}

TEST(Generate, SphereIsCloseToItsSurface) {
  const double radius = 0.02, spacing = radius / 4.5;
  const auto sphere = make_sphere(radius);
  const BubbleMesh result = mesh_of(*sphere, spacing);
  double farthest = 0;  // of points on the boundary faces from the sphere
  for (const Triangle& t : result.mesh.boundary) {
    const auto& p = result.mesh.positions;
    for (int i = 0; i <= 10; ++i) {
      for (int j = 0; i + j <= 10; ++j) {
        const Vec3 q = 0.1 * (i * p[t[0]] + j * p[t[1]] + (10 - i - j) * p[t[2]]);
        farthest = std::max(farthest, std::abs(sphere->signed_distance(q)));
      }
    }
  }
  EXPECT_LE(farthest, 0.06 * spacing);
  EXPECT_LT(result.volume_error, 0);
}

TEST(Generate, CylinderKeepsItsRims) {
  const auto cylinder = make_cylinder(0.01, 0.02);
  const BubbleMesh result = mesh_of(*cylinder, 0.003);
  for (const double y : {0.0, 0.02}) {
    Vector<char> on_rim(result.mesh.node_count(), 0);
    for (std::size_t i = 0; i < on_rim.size(); ++i) {
      on_rim[i] = result.mesh.kinds[i] == NodeKind::crease && result.mesh.positions[i].y() == y;
    }
    const auto nodes = std::ranges::count(on_rim, 1);
    EXPECT_EQ(nodes, 21);  // 62.8 mm / 3 mm
    EXPECT_EQ(std::ranges::count_if(result.mesh.springs, [&](const Edge& e) { return on_rim[e[0]] && on_rim[e[1]]; }),
              nodes);
  }
}

TEST(Generate, DeepNodesStayOnTheLatticeInRowOrder) {
  const auto box = make_box({14, 14, 14});
  const BubbleMesh result = mesh_of(*box, 1);
  const LatticeFrame frame(Lattice::hcp, {0, 7, 0}, 1);
  std::size_t deep = 0;
  for (const Vec3& p : result.mesh.positions) {
    if (box->signed_distance(p) > -3.6) continue;
    const std::int64_t layer = frame.nearest_layer(p), row = frame.nearest_row(p, layer);
    const Vec3 first = frame.point(0, row, layer);
    const double place = p.x() - first.x();
    EXPECT_EQ(p.y(), first.y());
    EXPECT_EQ(p.z(), first.z());
    EXPECT_NEAR(place, std::round(place), 1e-12);
    ++deep;
  }
  EXPECT_GT(deep, 350u);  // (14 - 7.2)^3 sqrt 2 = 445
  for (std::size_t i = 1; i < result.mesh.node_count(); ++i) {
    const Vec3 &a = result.mesh.positions[i - 1], &b = result.mesh.positions[i];
    const std::int64_t la = frame.nearest_layer(a), lb = frame.nearest_layer(b);
    const auto key_a = std::tuple(la, frame.nearest_row(a, la), a.x()),
               key_b = std::tuple(lb, frame.nearest_row(b, lb), b.x());
    EXPECT_LE(key_a, key_b);
  }
}

TEST(Generate, TwiceTheSame) {
  const auto shape = make_cylinder(3, 5);
  const BubbleMesh a = mesh_of(*shape, 1), b = mesh_of(*shape, 1);
  EXPECT_EQ(a.mesh.tetrahedra, b.mesh.tetrahedra);
  for (std::size_t i = 0; i < a.mesh.node_count(); ++i) EXPECT_TRUE(a.mesh.positions[i] == b.mesh.positions[i]);
}

TEST(Generate, BothLatticesAndExactCounts) {
  const auto box = make_box({0.03, 0.03, 0.03});
  BubbleMeshOptions options;
  options.spacing = 0.0044;
  for (const Lattice lattice : {Lattice::hcp, Lattice::fcc}) {
    options.lattice = lattice;
    for (const auto& [surface, inside] : {std::pair{260u, 230u}, std::pair{340u, 380u}}) {
      options.surface_nodes = surface;
      options.inside_nodes = inside;
      const BubbleMesh result = generate(*box, options);
      EXPECT_EQ(result.mesh.surface_node_count(), surface);
      EXPECT_EQ(result.mesh.node_count(), surface + inside);
      EXPECT_EQ(result.quality.slivers, 0u);
    }
  }
}

TEST(Generate, ThinBodiesAreMeshedWithAWarning) {
  for (const auto& shape :
       {make_box({20, 1.3, 20}), make_box({1.3, 30, 1.42}), make_sphere(0.7), make_cylinder(0.65, 20)}) {
    const BubbleMesh result = mesh_of(*shape, 1);
    ASSERT_EQ(result.warnings.size(), 1u);
    EXPECT_NE(result.warnings[0].find("thinner"), std::string::npos);
  }
}

TEST(Generate, RefusesBadOptions) {
  const auto cube = make_box({0.03, 0.03, 0.03});
  const auto with_spacing = [](double spacing) {
    BubbleMeshOptions options;
    options.spacing = spacing;
    return options;
  };
  EXPECT_EQ(error_of(*cube, with_spacing(0), "spacing must be positive, is 0"), Code::out_of_range);
  EXPECT_EQ(error_of(*cube, with_spacing(-1), "spacing"), Code::out_of_range);
  EXPECT_EQ(error_of(*cube, with_spacing(std::numeric_limits<double>::quiet_NaN()), "spacing"), Code::invalid_value);
  EXPECT_EQ(error_of(*cube, with_spacing(std::numeric_limits<double>::infinity()), "spacing"), Code::invalid_value);
  EXPECT_EQ(error_of(*cube, with_spacing(0.03), "at most 0.024 m"), Code::too_coarse);
  EXPECT_EQ(error_of(*cube, with_spacing(1e-7), "5 million"), Code::too_large);
  EXPECT_EQ(error_of(*cube, with_spacing(1e-300), "spacing"), Code::out_of_range);
  BubbleMeshOptions options = with_spacing(0.0044);
  options.offset = {0, 1e300, 0};
  EXPECT_EQ(error_of(*cube, options, "offset.y"), Code::out_of_range);
  options.offset = Vec3::Zero();
  options.surface_nodes = 306;
  EXPECT_EQ(error_of(*cube, options, "together"), Code::invalid_value);
  options.inside_nodes = 9000;
  EXPECT_EQ(error_of(*cube, options, "inside_nodes"), Code::out_of_range);
  options.surface_nodes = 7;
  EXPECT_EQ(error_of(*cube, options, "surface_nodes"), Code::out_of_range);
  EXPECT_NO_THROW(mesh_of(*cube, largest_spacing(*cube)));
}

}  // namespace
}  // namespace crumble
