#include "crumble/contact/surface_samples.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "contact/contact_rig.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/tetmesh/lattice_box.hpp"

namespace crumble {
namespace {

// A block of 3 x 3 x 3 cells of 4 mm, standing on y = 0.
TetMesh block() {
  return make_lattice_box({0.012, 0.012, 0.012}, 0.004);
}

std::array<std::uint32_t, 3> sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

std::set<Triangle> turned(const Triangle& t) {
  return {t, {t[1], t[2], t[0]}, {t[2], t[0], t[1]}};
}

Vector<std::uint32_t> all_nodes(const TetMesh& mesh) {
  Vector<std::uint32_t> nodes(mesh.node_count());
  for (std::uint32_t i = 0; i < nodes.size(); ++i) nodes[i] = i;
  return nodes;
}

std::map<Triangle, Triangle> open_faces(SurfaceSamples& surface, const TetMesh& mesh) {
  std::map<Triangle, Triangle> faces;
  for (const std::uint32_t f : surface.faces_of(all_nodes(mesh))) {
    EXPECT_TRUE(faces.emplace(sorted(surface.nodes_of(f)), surface.nodes_of(f)).second) << "twice";
  }
  return faces;
}

TEST(SurfaceSamples, OpenFacesAreTheBoundaryAtFirst) {
  const TetMesh mesh = block();
  SurfaceSamples surface(mesh);
  const auto faces = open_faces(surface, mesh);
  EXPECT_EQ(faces.size(), mesh.boundary.size());
  for (const Triangle& t : mesh.boundary) {
    ASSERT_TRUE(faces.count(sorted(t)));
    EXPECT_TRUE(turned(t).count(faces.at(sorted(t)))) << "faces outward";
  }
  double sum = 0;
  for (const auto& [a, b] : mesh.springs) sum += norm(mesh.positions[a] - mesh.positions[b]);
  EXPECT_NEAR(surface.node_spacing(), sum / static_cast<double>(mesh.springs.size()), 1e-15);
}

// Against the definition, tetrahedron by tetrahedron, while springs are cut at random.
TEST(SurfaceSamples, OpenFacesFollowTheCuts) {
  const TetMesh mesh = block();
  SurfaceSamples surface(mesh);
  Random random(8);
  Vector<bool> cut(mesh.springs.size());
  std::size_t seen_inside = 0;
  for (int round = 0; round < 60; ++round) {
    Vector<std::uint32_t> cuts;
    for (int k = 0; k < 5; ++k) cuts.push_back(static_cast<std::uint32_t>(random.below(cut.size())));
    for (const std::uint32_t s : cuts) cut[s] = true;
    surface.note_cut(cuts);

    struct Sides {
      Vector<Triangle> of_whole, of_broken;  // outward of their tetrahedra
      bool torn = false;
    };
    std::map<Triangle, Sides> expected;
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
      const auto& springs = mesh.tet_springs[t];
      const bool broken = std::any_of(springs.begin(), springs.end(), [&](std::uint32_t s) { return cut[s]; });
      for (const auto& corners : kTetFaces) {
        Triangle face;
        for (std::size_t k = 0; k < 3; ++k) face[k] = mesh.tetrahedra[t][corners[k]];
        Sides& sides = expected[sorted(face)];
        (broken ? sides.of_broken : sides.of_whole).push_back(face);
        for (std::size_t e = 0; e < 6; ++e) {
          const auto [a, b] = mesh.springs[springs[e]];
          const bool both = std::count(face.begin(), face.end(), a) + std::count(face.begin(), face.end(), b) == 2;
          sides.torn = sides.torn || (both && cut[springs[e]]);
        }
      }
    }
    const auto faces = open_faces(surface, mesh);
    std::size_t count = 0;
    for (const auto& [key, sides] : expected) {
      const bool boundary = sides.of_whole.size() + sides.of_broken.size() == 1;
      const bool open = !sides.torn && (boundary || sides.of_whole.size() == 1);
      ASSERT_EQ(faces.count(key), open ? 1u : 0u);
      if (!open) continue;
      ++count, seen_inside += !boundary;
      const Triangle outward = sides.of_whole.empty() ? sides.of_broken[0] : sides.of_whole[0];
      ASSERT_TRUE(turned(outward).count(faces.at(key))) << "faces away from what is whole";
    }
    ASSERT_EQ(faces.size(), count);
  }
  EXPECT_GT(seen_inside, 100u);
  surface.clear();
  EXPECT_EQ(open_faces(surface, mesh).size(), mesh.boundary.size());
}

TEST(SurfaceSamples, PartsCoverAnEdgeAndAreBounded) {
  EXPECT_EQ(SurfaceSamples::parts(0.004, 0.001), 4u);
  EXPECT_EQ(SurfaceSamples::parts(0.0041, 0.001), 5u);
  EXPECT_EQ(SurfaceSamples::parts(0.0001, 0.001), 1u);
  EXPECT_EQ(SurfaceSamples::parts(0.004, 1e-6), SurfaceSamples::kMostParts);
}

struct NeedleRig {
  TetMesh mesh = block();
  NodeArrays nodes{mesh.positions};
  Contacts contacts{{{make_round_stick(0.0005, 0.02, 16), kPaperFriction}},
                    {},
                    Vector<std::uint8_t>(mesh.node_count()),
                    ContactRule::nearest_surface,
                    {},
                    SurfaceSamples(mesh)};

  // the tip, in the scene
  Pose upright(const Vec3& tip) const { return {tip + Vec3(0, 0.01, 0), axis_angle(Vec3::UnitX(), M_PI / 2)}; }
  void touch(const Vec3& tip) {
    contacts.move_holder(0, upright(tip), kTau);
    contacts.find(0, nodes), contacts.project(nodes);
  }
};

TEST(ThinTool, PressesTheFaceBetweenNodesDownByWhatItIsDeep) {
  Random random(9);
  for (int trial = 0; trial < 300; ++trial) {
    NeedleRig rig;
    const double x = random.uniform(-0.0055, 0.0055), z = random.uniform(-0.0055, 0.0055);
    rig.touch({x, 0.01201, z});
    ASSERT_TRUE(rig.contacts.engaged(0));
    ASSERT_TRUE(rig.contacts.constraints().empty());
    rig.touch({x, 0.01197, z});
    ASSERT_FALSE(rig.contacts.constraints().empty()) << x << ' ' << z;
    for (const NodeConstraint& c : rig.contacts.constraints()) {
      ASSERT_EQ(c.state, ContactState::fresh);
      ASSERT_LT(norm(c.normal + Vec3::UnitY()), 0.1) << "the face's inward normal";
      const Vec3 moved = rig.nodes.positions[c.node] - rig.mesh.positions[c.node];
      ASSERT_LT(moved.y(), 0);
      ASSERT_LT(norm(moved - Vec3(0, moved.y(), 0)), 1e-6) << "but for what tilted with its neighbours";
      ASSERT_LT(-moved.y(), 1.4 * 3e-5 / 0.25 + 1e-12);
    }
    // no sample of the faces round it is left inside: pressed once more they stay
    const VecArray pressed = rig.nodes.positions;
    rig.touch({x, 0.01197, z});
    for (std::size_t i = 0; i < pressed.size(); ++i) ASSERT_LT(norm(rig.nodes.positions[i] - pressed[i]), 3e-5);
  }
}

TEST(ThinTool, StickingCornersKeepTheirPlacesInItsFrame) {
  NeedleRig rig;
  rig.touch({0.0013, 0.01201, 0.0007});
  rig.touch({0.0013, 0.01198, 0.0007});
  ASSERT_GE(rig.contacts.constraints().size(), 2u);
  for (NodeConstraint& c : rig.contacts.constraints()) c.state = ContactState::stick;
  rig.contacts.drop_released();
  const Vector<NodeConstraint> first(rig.contacts.constraints().begin(), rig.contacts.constraints().end());
  for (int step = 1; step <= 100; ++step) {
    rig.touch({0.0013 + 1e-6 * step, 0.01198 - 1e-5 * step, 0.0007});
    for (const NodeConstraint& c : first) {
      ASSERT_LT(norm(rig.nodes.positions[c.node] - (c.point + step * Vec3(1e-6, -1e-5, 0))), 1e-13);
    }
    for (NodeConstraint& c : rig.contacts.constraints()) c.state = ContactState::stick;
  }
}

TEST(ThinTool, LeavesAFaceAloneThatItWasNotSeenToEnter) {
  NeedleRig rig;
  rig.contacts.move_holder(0, rig.upright({0.0013, 0.006, 0.0007}), kTau);  // pierces the top, between nodes
  for (int step = 0; step < 3; ++step) rig.contacts.find(0, rig.nodes), rig.contacts.project(rig.nodes);
  for (std::size_t i = 0; i < rig.mesh.node_count(); ++i) {
    EXPECT_LT(norm(rig.nodes.positions[i] - rig.mesh.positions[i]), 1e-4);
  }
}

TEST(ThinTool, LetsATornFaceGoBackBitByBit) {
  NeedleRig rig;
  rig.touch({0.0013, 0.01201, 0.0007});
  rig.touch({0.0013, 0.01198, 0.0007});
  const std::size_t count = rig.contacts.constraints().size();
  ASSERT_GE(count, 2u);
  for (NodeConstraint& c : rig.contacts.constraints()) c.state = ContactState::stick;
  Vector<std::uint32_t> all(rig.mesh.springs.size());
  for (std::uint32_t s = 0; s < all.size(); ++s) all[s] = s;
  rig.contacts.note_cut(all);
  const VecArray before = rig.nodes.positions;
  rig.touch({0.0013, 0.01198, 0.0007});
  ASSERT_EQ(rig.contacts.constraints().size(), count);
  for (const NodeConstraint& c : rig.contacts.constraints()) {
    const Vec3 moved = rig.nodes.positions[c.node] - before[c.node];
    EXPECT_NEAR(moved.y(), 0.02 * kTau, 1e-12);
  }
}

TEST(ThinTool, ContinuesFromASnapshotWithTheSameBits) {
  NeedleRig live, restored;
  live.touch({0.0013, 0.01201, 0.0007});
  live.touch({0.0013, 0.01198, 0.0007});
  for (std::uint32_t s = 0; s < live.mesh.springs.size(); ++s) {  // tear the faces that are held
    const auto [a, b] = live.mesh.springs[s];
    const auto held = live.contacts.constraints();
    const auto ends =
        std::count_if(held.begin(), held.end(), [&](const auto& c) { return c.node == a || c.node == b; });
    if (ends == 2) live.contacts.note_cut({&s, 1});
  }
  ByteWriter out;
  live.contacts.save(out);
  ByteReader in(out.bytes(), "snapshot");
  restored.contacts.load(in);
  restored.nodes = live.nodes;
  ASSERT_GE(restored.contacts.constraints().size(), 2u);
  for (int step = 0; step < 50; ++step) {
    const Vec3 tip(0.0013 + 2e-6 * step, 0.01198 - 1e-5 * step, 0.0007);
    live.touch(tip), restored.touch(tip);
    for (std::size_t i = 0; i < live.nodes.node_count(); ++i) {
      ASSERT_EQ(live.nodes.positions[i], restored.nodes.positions[i]) << step;
    }
  }
  Vector<std::uint8_t> bytes = out.bytes();
  bytes[57 + 8 + 3] = 2;  // of a spring
  ByteReader damaged(bytes, "snapshot");
  EXPECT_THROW(restored.contacts.load(damaged), Error);
}

}  // namespace
}  // namespace crumble
