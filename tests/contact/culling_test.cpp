// Searching near the tools and walls only must lose nothing: the same as if every search returned all nodes.
#include <gtest/gtest.h>

#include "contact/contact_rig.hpp"
#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

constexpr std::uint32_t kCloud = 500;

// Two sticks, a floor and a slanted wall in a cloud of nodes, one in eight of them fixed.
ContactRig make_rig(const Vector<Stick>& sticks, ContactRule rule, std::uint64_t seed) {
  Random random(seed);
  Vector<Vec3> nodes;
  Vector<std::uint8_t> fixed;
  std::size_t count = kCloud;
  for (const Stick& stick : sticks) count += stick.shape.vertices.size();
  for (std::size_t i = 0; i < count; ++i) {
    nodes.push_back(0.012 * random_vector(random));
    fixed.push_back(i < kCloud && i % 8 == 0);
  }
  Vector<Tool> tools;
  for (const Stick& stick : sticks) tools.push_back({stick.shape, kPaperFriction});
  const Wall floor{{{0, 1, 0}, -0.01}, kPaperFriction}, slope{{normalized(Vec3(1, 0.3, -0.2)), -0.009}, {0.5, 0.2}};
  return {tools, nodes, rule, {floor, slope}, fixed};
}

class Culling : public testing::TestWithParam<ContactRule> {
 protected:
  void run(std::uint64_t seed) {
    const Vector<Stick> all = paper_sticks();
    const Vector<Stick> sticks{all[seed % 4], all[(seed + 1) % 3]};
    ContactRig culled = make_rig(sticks, GetParam(), seed), plain = make_rig(sticks, GetParam(), seed);
    plain.nodes.culls = false;
    Random random(seed + 1000);
    Vector<Pose> poses{random_pose(random), random_pose(random)};
    for (Pose& pose : poses) pose.position *= 0.02 / 0.1;
    for (const bool first : {true, false}) (first ? culled : plain).engage(poses);
    for (int step = 0; step < 200; ++step) {
      for (Pose& pose : poses) move(pose, random);
      put_nodes_on_corners(poses, culled, plain, random);
      culled.touch(poses), plain.touch(poses);
      ASSERT_NO_FATAL_FAILURE(expect_same(culled, plain)) << "seed " << seed << ", step " << step;
      contacts_ += culled.contacts.constraints().size();
      let_slide(culled, plain, random);
    }
  }

  std::size_t contacts_ = 0;

 private:
  // mostly a little, now and then through several places, rarely a jump
  static void move(Pose& pose, Random& random) {
    const double far = random.below(20) == 0 ? 100 : random.below(5) == 0 ? 20 : 1;
    const Quat turn = axis_angle(random_direction(random), 1e-3 * far);
    pose = renormalized({0.99 * pose.position + 1e-4 * far * random_vector(random), multiply(turn, pose.orientation)});
  }

  // Where a box about the tool ends: inside and outside by the last bits of a coordinate.
  static void put_nodes_on_corners(const Vector<Pose>& poses, ContactRig& culled, ContactRig& plain, Random& random) {
    std::uint32_t node = kCloud;
    for (std::size_t t = 0; t < poses.size(); ++t) {
      for (const Vec3& corner : culled.contacts.tools()[t].shape->surface().vertices) {
        const Vec3 p = Frame(poses[t]).to_scene(corner * (1 - 1e-15 * random.uniform(-1, 2)));
        if (!culled.contact_of(node)) culled.nodes.positions.set(node, p), plain.nodes.positions.set(node, p);
        ++node;
      }
    }
  }

  static void expect_same(const ContactRig& a, const ContactRig& b) {
    const auto first = a.contacts.constraints(), second = b.contacts.constraints();
    ASSERT_EQ(first.size(), second.size());
    for (std::size_t k = 0; k < first.size(); ++k) {
      ASSERT_EQ(first[k].node, second[k].node);
      ASSERT_EQ(first[k].holder, second[k].holder);
      ASSERT_EQ(first[k].state, second[k].state);
      ASSERT_EQ(first[k].point, second[k].point);
      ASSERT_EQ(first[k].normal, second[k].normal);
      ASSERT_EQ(first[k].velocity, second[k].velocity);
    }
    for (std::size_t i = 0; i < a.nodes.node_count(); ++i) {
      ASSERT_EQ(a.nodes.positions[i], b.nodes.positions[i]);
      ASSERT_EQ(a.nodes.velocities[i], b.nodes.velocities[i]);
    }
    for (std::size_t t = 0; t < a.contacts.tools().size(); ++t) ASSERT_EQ(a.contacts.engaged(t), b.contacts.engaged(t));
  }

  static void let_slide(ContactRig& culled, ContactRig& plain, Random& random) {
    for (std::size_t k = 0; k < culled.contacts.constraints().size(); ++k) {
      NodeConstraint& c = culled.contacts.constraints()[k];
      c.state = static_cast<ContactState>(random.below(8) == 0 ? 3 : 1 + random.below(2));
      plain.contacts.constraints()[k].state = c.state;
      if (c.state == ContactState::stick) continue;
      const Vec3 p = culled.nodes.positions[c.node] + 2e-5 * random_vector(random);
      culled.nodes.positions.set(c.node, p), plain.nodes.positions.set(c.node, p);
    }
    culled.contacts.drop_released(), plain.contacts.drop_released();
  }
};

TEST_P(Culling, LosesNothing) {
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    run(seed);
    ASSERT_FALSE(HasFatalFailure());
  }
  EXPECT_GT(contacts_, 100000u);
}

INSTANTIATE_TEST_SUITE_P(Rules, Culling, testing::Values(ContactRule::nearest_surface, ContactRule::along_motion),
                         [](const auto& test) { return test.index == 0 ? "nearest" : "along_motion"; });

TEST(ContactOrder, ThoseHeldBeforeStayFirstAndTheRestFollowsInTheOrderOfTheSearch) {
  ContactRig rig({bar(0.01, 0.006, 0.05)},
                 {{0.003, -0.0031, 0}, {0, -0.0029, 0}, {0.002, -0.0031, 0}, {-0.002, -0.0029, 0}});
  const auto order = [&] {
    Vector<std::uint32_t> nodes;
    for (const NodeConstraint& c : rig.contacts.constraints()) nodes.push_back(c.node);
    return nodes;
  };
  rig.engage({at(0, 0, 0)});
  rig.touch({at(0, 0, 0)});
  EXPECT_EQ(order(), (Vector<std::uint32_t>{1, 3}));
  rig.decide(ContactState::stick);
  rig.touch({at(0, -0.0002, 0)});
  EXPECT_EQ(order(), (Vector<std::uint32_t>{1, 3, 0, 2}));
}

TEST(ContactOrder, NodesThatAreNotNumbersAreNotTakenIn) {
  const double nan = std::nan("");
  ContactRig rig({bar(0.01, 0.006, 0.05)}, {{nan, nan, nan}, {0, nan, 0}, {0, -0.0029, 0}});
  rig.nodes.culls = false;
  rig.engage({at(0, 0, 0)});
  rig.touch({at(0, 0, 0)});
  ASSERT_EQ(rig.contacts.constraints().size(), 1u);
  EXPECT_EQ(rig.contacts.constraints()[0].node, 2u);
}

}  // namespace
}  // namespace crumble
