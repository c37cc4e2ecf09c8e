// Many boxes, spheres and cylinders of random sizes, lattices and offsets: each must give a valid mesh of good quality.
#include <gtest/gtest.h>

#include <sstream>

#include "crumble/base/random.hpp"
#include "crumble/bubblemesh/generate.hpp"
#include "support/long_lane.hpp"

namespace crumble {
namespace {

struct Body {
  std::unique_ptr<Shape> shape;
  BubbleMeshOptions options;
  bool is_box = false;
  std::string text;
};

/// At least two spacings thick, at most `volume` cubic spacings.
Body random_body(std::uint64_t seed, double volume) {
  Random random(seed);
  Body body;
  std::ostringstream text;
  do {
    const double thickness = random.uniform(2, 9);
    const double a = thickness * random.uniform(1, 3), b = thickness * random.uniform(1, 3);
    text.str("");
    switch (seed % 4) {
      case 0:
        body.shape = make_sphere(thickness / 2), text << "sphere " << thickness / 2;
        break;
      case 1:
        body.shape = make_cylinder(thickness / 2, a), text << "cylinder " << thickness / 2 << ' ' << a;
        break;
      case 2:
        body.shape = make_cylinder(a / 2, thickness), text << "cylinder " << a / 2 << ' ' << thickness;
        break;
      default:
        body.shape = make_box({a, thickness, b}), text << "box " << a << ' ' << thickness << ' ' << b;
    }
  } while (body.shape->volume() > volume);
  body.is_box = seed % 4 == 3;
  body.options.spacing = 1;
  body.options.offset = {random.uniform(), random.uniform(), random.uniform()};
  body.options.lattice = random.below(3) == 0 ? Lattice::fcc : Lattice::hcp;
  body.text = text.str() + ", seed " + std::to_string(seed);
  return body;
}

void expect_good(const Body& body) {
  SCOPED_TRACE(body.text);
  const BubbleMesh result = generate(*body.shape, body.options);
  const MeshQuality& q = result.quality;
  EXPECT_EQ(q.boundary_defects.total(), 0u);
  EXPECT_EQ(q.euler_defect, 0);
  EXPECT_EQ(q.slivers, 0u);
  EXPECT_GE(q.dihedral_min, 30);
  EXPECT_LE(q.dihedral_max, 145);
  EXPECT_GE(q.volume_length_mean, body.shape->least_thickness() >= 8 ? 0.85 : 0.70);
  EXPECT_LE(q.edge_variation, 0.25);
  if (body.is_box) {
    EXPECT_LE(std::abs(result.volume_error), 1e-12);
  }
}

TEST(RandomBodies, AreAllGood) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) expect_good(random_body(seed, 300));
}

// Larger ones too, about a minute.
TEST(RandomBodies, LargerOnesAreGoodToo) {
  if (!is_long_lane()) GTEST_SKIP() << "in scripts/test-long";
  for (std::uint64_t seed = 1000; seed < 1300; ++seed) expect_good(random_body(seed, 3000));
}

}  // namespace
}  // namespace crumble
