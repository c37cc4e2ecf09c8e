#include "crumble/contact/contacts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "contact/contact_rig.hpp"
#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

Vector<Vec3> random_nodes_inside(const Stick& stick, const Pose& pose, int count, Random& random) {
  Vector<Vec3> nodes;
  const Frame frame(pose);
  while (nodes.size() < static_cast<std::size_t>(count)) {
    const Vec3 local = random_vector(random).cwiseProduct(stick.size / 2);
    if (nearest_surface(stick.shape, local).signed_distance < -1e-5) nodes.push_back(frame.to_scene(local));
  }
  return nodes;
}

TEST(Contacts, NearestRulePushesEachNodeToTheNearestFace) {
  Random random(1);
  for (const Stick& stick : paper_sticks()) {
    const Pose pose = random_pose(random);
    const Vector<Vec3> nodes = random_nodes_inside(stick, pose, 200, random);
    ContactRig rig({{stick.shape, kPaperFriction}}, nodes);
    rig.engage({pose});
    rig.touch({pose});
    ASSERT_EQ(rig.contacts.constraints().size(), nodes.size());
    for (const NodeConstraint& c : rig.contacts.constraints()) {
      const Vec3 before = nodes[c.node];
      double least = 1;  // over the faces, each turned by Eigen
      Vec3 normal = Vec3::Zero(), nearest = before;
      for (const Plane& plane : stick.shape.planes) {
        const Vec3 n = pose.orientation * plane.normal;
        const double depth = plane.offset - n.dot(before - pose.position);
        if (depth < least) least = depth, normal = n, nearest = before + depth * n;
      }
      EXPECT_LT(norm(rig.nodes.positions[c.node] - nearest), 1e-14) << stick.name;
      EXPECT_LT(norm(c.point - nearest), 1e-14);
      EXPECT_LT(norm(c.normal - normal), 1e-14);
      EXPECT_EQ(c.state, ContactState::fresh);
      EXPECT_EQ(c.holder, 0u);
      EXPECT_EQ(c.static_friction, 3.0);
      EXPECT_EQ(c.dynamic_friction, 1.5);
    }
  }
}

TEST(Contacts, PaperRulePushesEachNodeAlongTheToolsMotion) {
  Random random(2);
  for (const Stick& stick : paper_sticks()) {
    const Pose before = random_pose(random);
    const Quat turn = axis_angle(random_direction(random), 1e-3);
    const Pose after =
        renormalized({before.position + 5e-5 * random_direction(random), multiply(turn, before.orientation)});
    const Vector<Vec3> nodes = random_nodes_inside(stick, after, 200, random);
    ContactRig rig({{stick.shape, kPaperFriction}}, nodes, ContactRule::along_motion);
    rig.engage({before});
    rig.touch({after});
    ASSERT_EQ(rig.contacts.constraints().size(), nodes.size());
    for (const NodeConstraint& c : rig.contacts.constraints()) {
      const Vec3 node = nodes[c.node], move = rig.nodes.positions[c.node] - node;
      const Vec3 local = after.orientation.conjugate() * (node - after.position);
      const Vec3 motion = node - (before.orientation * local + before.position);  // of the tool's matter at the node
      EXPECT_GT(move.dot(motion), 0.999999999 * move.norm() * motion.norm()) << stick.name;
      const Vec3 out = Frame(after).to_local(rig.nodes.positions[c.node]);
      std::uint32_t face = 0;
      EXPECT_NEAR(greatest_plane_distance(stick.shape, out, face), 0, 1e-14);
      EXPECT_LT(norm(c.normal - after.orientation * stick.shape.planes[face].normal), 1e-12);
    }
  }
}

TEST(Contacts, StickingNodeFollowsAMovingAndTurningToolWithoutDrift) {
  const Tool tool{make_round_stick(0.004, 0.05, 16), kPaperFriction};
  Random random(3);
  Pose pose = random_pose(random);
  const Vec3 local(0.0005, -0.0035, 0.012);
  ContactRig rig({tool}, {Frame(pose).to_scene(local)});
  rig.engage({pose});
  rig.touch({pose});
  const Vec3 anchor = pose.orientation.conjugate() * (rig.nodes.positions[0] - pose.position);
  rig.decide(ContactState::stick);
  for (int step = 0; step < 100000; ++step) {
    const double speed = step % 100 == 99 ? 40 : 1;  // now and then in several places
    const Quat turn = axis_angle(random_direction(random), 2e-3 * speed);
    const Pose before = pose;
    pose = renormalized({pose.position + 1e-4 * speed * random_direction(random), multiply(turn, pose.orientation)});
    rig.touch({pose});
    ASSERT_EQ(rig.contacts.constraints().size(), 1u) << step;
    const Vec3 expected = pose.orientation * anchor + pose.position;
    const Vec3 previous = before.orientation * anchor + before.position;
    ASSERT_LT(norm(rig.nodes.positions[0] - expected), 1e-12) << step;
    ASSERT_LT(norm(rig.nodes.velocities[0] - (expected - previous) / kTau), 1e-9) << step;
    rig.decide(ContactState::stick);
    rig.contacts.push_out(rig.nodes);
  }
}

TEST(Contacts, SlippingNodeIsPushedAlongTheNormalOnly) {
  Random random(4);
  const Pose start = random_pose(random);
  const Vec3 down = start.orientation * Vec3(0, -1, 0), sideways = start.orientation * Vec3(0.6, 0, 0.8);
  ContactRig rig({bar(0.01, 0.006, 0.05)}, {start.position + 0.0029 * down});
  rig.engage({start});
  rig.touch({start});
  rig.nodes.velocities.set(0, Vec3(0.1, 0.2, 0.3));
  rig.decide(ContactState::slip);
  for (int step = 1; step <= 50; ++step) {
    const Vec3 before = rig.nodes.positions[0], velocity = rig.nodes.velocities[0];
    rig.touch({{start.position + step * (2e-5 * down + 3e-5 * sideways), start.orientation}});
    ASSERT_EQ(rig.contacts.constraints().size(), 1u);
    ASSERT_LT(norm(rig.nodes.positions[0] - (before + 2e-5 * down)), 1e-15);
    const Vec3 gained = rig.nodes.velocities[0] - velocity;
    ASSERT_LT(norm(gained - gained.dot(down) * down), 1e-14) << "the tool dragged it sideways";
    ASSERT_NEAR(rig.nodes.velocities[0].dot(down), 2e-5 / kTau, 1e-9);
    ASSERT_LT(norm(rig.contacts.constraints()[0].velocity - (2e-5 * down + 3e-5 * sideways) / kTau), 1e-9);
    rig.decide(ContactState::slip);
  }
}

TEST(Contacts, NodeThatSlidAndThenSticksIsHeldWhereItCameToRest) {
  ContactRig rig({bar(0.01, 0.006, 0.05)}, {{0, -0.0029, 0}});
  rig.engage({at(0, 0, 0)});
  rig.touch({at(0, 0, 0)});
  rig.nodes.positions.set(0, {0.0001, -0.003, 0.0002});  // slides
  rig.decide(ContactState::slip);
  rig.touch({at(0, 0, 0)});
  rig.decide(ContactState::stick);
  rig.touch({at(0.0003, 0.0001, 0)});
  EXPECT_LT(norm(rig.nodes.positions[0] - Vec3(0.0004, -0.0029, 0.0002)), 1e-15);
}

TEST(Contacts, ReleasedIsForgottenAndHeldOnlyWithinTheKeepGap) {
  for (const bool released : {true, false}) {
    ContactRig rig({bar(0.01, 0.006, 0.05)}, {{0, -0.0029, 0}});
    rig.engage({at(0, 0, 0)});
    rig.touch({at(0, 0, 0)});
    rig.decide(released ? ContactState::released : ContactState::slip);
    EXPECT_EQ(rig.contacts.constraints().size(), released ? 0u : 1u);
    rig.nodes.positions.set(0, {0, -0.003 - 4e-5, 0});
    rig.touch({at(0, 0, 0)});
    EXPECT_EQ(rig.contacts.constraints().size(), released ? 0u : 1u);
    rig.decide(released ? ContactState::released : ContactState::slip);
    rig.nodes.positions.set(0, {0, -0.003 - 6e-5, 0});
    rig.touch({at(0, 0, 0)});
    EXPECT_EQ(rig.contacts.constraints().size(), 0u);
    EXPECT_EQ(rig.nodes.positions.y[0], -0.003 - 6e-5);
  }
}

// With substeps the solver runs several times before anything is remembered.
TEST(Contacts, ReleasedInASubstepIsNotHeldInTheNext) {
  const Wall floor{{{0, 1, 0}, -1}, kPaperFriction};
  ContactRig rig({bar(0.01, 0.006, 0.05)}, {{0, -0.0029, 0}, {1, -1.0001, 0}}, ContactRule::nearest_surface, {floor});
  rig.engage({at(0, 0, 0)});
  rig.touch({at(0, 0, 0)});
  ASSERT_EQ(rig.contacts.constraints().size(), 2u);
  for (NodeConstraint& c : rig.contacts.constraints()) c.state = ContactState::released;
  rig.nodes.positions.set(0, {0, -0.003 - 1e-5, 0});
  rig.nodes.positions.set(1, {1, -1 + 1e-5, 0});
  rig.touch({at(0, 0, 0)});
  EXPECT_TRUE(rig.contacts.constraints().empty());
  EXPECT_EQ(rig.nodes.positions[0], Vec3(0, -0.003 - 1e-5, 0));
}

TEST(Contacts, FixedNodesAreNeverHeld) {
  const Wall floor{{{0, 1, 0}, 0}, kPaperFriction};
  const Vector<Vec3> nodes{{0, -0.0029, 0}, {0.001, -0.0029, 0}, {1, -0.1, 0}, {2, -0.1, 0}};
  ContactRig rig({bar(0.01, 0.006, 0.05)}, nodes, ContactRule::nearest_surface, {floor}, {1, 0, 1, 0});
  rig.engage({at(0, 0, 0)});
  rig.touch({at(0, 0, 0)});
  ASSERT_EQ(rig.contacts.constraints().size(), 2u);
  EXPECT_EQ(rig.contacts.constraints()[0].node, 1u);
  EXPECT_EQ(rig.contacts.constraints()[1].node, 3u);
  EXPECT_EQ(rig.nodes.positions[0], nodes[0]);
  EXPECT_EQ(rig.nodes.positions[2], nodes[2]);
}

TEST(Contacts, WallKeepsNodesOnItsSide) {
  Random random(6);
  const Vec3 n = random_direction(random);
  const Wall wall{{n, 0.02}, {0.8, 0.5}};
  Vector<Vec3> nodes;
  for (int i = 0; i < 200; ++i) nodes.push_back(0.05 * random_vector(random));
  ContactRig rig({}, nodes, ContactRule::nearest_surface, {wall});
  for (std::size_t i = 0; i < nodes.size(); ++i) rig.nodes.velocities.set(i, {1, 2, 3});
  rig.touch({});
  for (std::uint32_t i = 0; i < nodes.size(); ++i) {
    const double above = n.dot(nodes[i]) - 0.02;
    const NodeConstraint* c = rig.contact_of(i);
    ASSERT_EQ(c != nullptr, above < 0);
    ASSERT_LT(norm(rig.nodes.positions[i] - (nodes[i] - std::min(above, 0.0) * n)), 1e-15);
    if (!c) continue;
    EXPECT_EQ(c->holder, kWorldHolder);
    EXPECT_EQ(c->normal, n);
    EXPECT_EQ(c->static_friction, 0.8);
    EXPECT_EQ(c->dynamic_friction, 0.5);
    EXPECT_EQ(c->velocity, Vec3::Zero());
    EXPECT_NEAR(rig.nodes.velocities[i].dot(n), 0, 1e-15);
  }
}

TEST(Contacts, WallHoldsAStickingNodeLetsASlidingOneGoOnAndDropsOneThatRose) {
  const Wall floor{{{0, 1, 0}, 0}, kPaperFriction};
  ContactRig rig({}, {{0, -1e-4, 0}, {1, -1e-4, 0}, {2, -1e-4, 0}}, ContactRule::nearest_surface, {floor});
  rig.touch({});
  ASSERT_EQ(rig.contacts.constraints().size(), 3u);
  rig.contacts.constraints()[0].state = ContactState::stick;
  rig.contacts.constraints()[1].state = ContactState::slip;
  rig.contacts.constraints()[2].state = ContactState::slip;
  rig.contacts.drop_released();
  for (std::size_t i = 0; i < 2; ++i) rig.nodes.positions.set(i, rig.nodes.positions[i] + Vec3(1e-5, 1e-5, 0));
  rig.nodes.positions.set(2, {2, 6e-5, 0});
  rig.touch({});
  ASSERT_EQ(rig.contacts.constraints().size(), 2u);
  EXPECT_EQ(rig.nodes.positions[0], Vec3(0, 0, 0));
  EXPECT_EQ(rig.nodes.positions[1], Vec3(1 + 1e-5, 0, 0));
  EXPECT_EQ(rig.nodes.positions[2], Vec3(2, 6e-5, 0));
}

TEST(Contacts, ToolTakesANodeFromAWall) {
  const Wall floor{{{0, 1, 0}, 0}, kPaperFriction};
  ContactRig rig({bar(0.01, 0.006, 0.05)}, {{0, -1e-4, 0}}, ContactRule::nearest_surface, {floor});
  rig.touch({at(0, 0.00301, 0)});
  rig.decide(ContactState::stick);
  ASSERT_EQ(rig.contacts.constraints()[0].holder, kWorldHolder);
  rig.touch({at(0, 0.00299, 0)});
  ASSERT_EQ(rig.contacts.constraints().size(), 1u);
  EXPECT_EQ(rig.contacts.constraints()[0].holder, 0u);
  EXPECT_EQ(rig.contacts.constraints()[0].state, ContactState::fresh);
  EXPECT_EQ(rig.nodes.positions[0], Vec3(0, 0.00299 - 0.003, 0));
}

// Two tools that share a region, a wall below, contacts of all states: never two contacts for one node.
TEST(Contacts, EachNodeHasOneHolderAndTheLowerToolIndexWins) {
  Random random(7);
  const Wall floor{{{0, 1, 0}, -0.002}, kPaperFriction};
  Vector<Vec3> nodes;
  for (int i = 0; i < 400; ++i) nodes.push_back(0.006 * random_vector(random));
  ContactRig rig({bar(0.006, 0.006, 0.02), bar(0.006, 0.006, 0.02)}, nodes, ContactRule::nearest_surface, {floor});
  Vector<Pose> poses{at(-0.002, 0, 0), at(0.002, 0, 0)};
  rig.engage(poses);
  std::size_t taken_over = 0;
  for (int step = 0; step < 300; ++step) {
    std::set<std::uint32_t> held_by_second;
    for (const NodeConstraint& c : rig.contacts.constraints()) {
      if (c.holder == 1) held_by_second.insert(c.node);
    }
    for (Pose& pose : poses)
      pose.position = (pose.position + 2e-4 * random_vector(random)).cwiseMax(-0.004).cwiseMin(0.004);
    rig.touch(poses);
    std::set<std::uint32_t> seen;
    std::uint32_t holder = 0;
    for (const NodeConstraint& c : rig.contacts.constraints()) {
      ASSERT_TRUE(seen.insert(c.node).second) << "node " << c.node << " twice in step " << step;
      ASSERT_GE(c.holder, holder) << "not in the order of holders";
      holder = c.holder;
      if (c.holder == 0) taken_over += held_by_second.count(c.node);
    }
    for (NodeConstraint& c : rig.contacts.constraints()) c.state = static_cast<ContactState>(random.below(4));
    rig.contacts.drop_released();
    for (std::size_t i = 0; i < nodes.size(); ++i)
      rig.nodes.positions.set(i, rig.nodes.positions[i] + 1e-4 * random_vector(random));
  }
  EXPECT_GT(taken_over, 10u);
}

TEST(Contacts, ClearGoesBackToBeforeTheFirstMove) {
  ContactRig rig({bar(0.01, 0.006, 0.05)}, {{0, -0.0029, 0}});
  rig.engage({at(0, 0, 0)});
  rig.touch({at(0, 0, 0)});
  ASSERT_EQ(rig.contacts.constraints().size(), 1u);
  rig.contacts.clear();
  EXPECT_TRUE(rig.contacts.constraints().empty());
  EXPECT_FALSE(rig.contacts.engaged(0));
  rig.contacts.find(0, rig.nodes);
  EXPECT_TRUE(rig.contacts.constraints().empty()) << "a tool without a place holds nothing";
}

TEST(Contacts, ASleepingNodeIsHeldByToolsOnlyAndRousedByThem) {
  // node 0 under the floor, node 1 where the bar will come down
  ContactRig rig({bar(0.01, 0.006, 0.05)}, {{0.1, -0.001, 0}, {0, 0.01, 0}}, ContactRule::nearest_surface,
                 {{{Vec3::UnitY(), 0}, {}}});
  rig.engage({at(0, 0.1, 0)});
  rig.contacts.let_sleep(0);
  rig.contacts.let_sleep(1);
  rig.touch({at(0, 0.1, 0)});
  EXPECT_TRUE(rig.contacts.constraints().empty()) << "the floor lets it sleep";
  EXPECT_TRUE(rig.contacts.roused().empty());
  ContactRig low = rig;
  low.contacts.move_holder(0, at(0, 0.0121, 0), kTau);  // a jump
  low.contacts.find(0, low.nodes);
  EXPECT_TRUE(low.contacts.roused().empty()) << "a suspended tool touches nothing";
  for (double y = 0.1; y > 0.012; y -= 0.001) rig.touch({at(0, y, 0)});
  ASSERT_EQ(rig.contacts.constraints().size(), 1u);
  EXPECT_EQ(rig.contacts.constraints()[0].node, 1u);
  ASSERT_EQ(rig.contacts.roused().size(), 1u);
  EXPECT_EQ(rig.contacts.roused()[0], 1u);
  rig.contacts.wake(0);
  rig.touch({at(0, 0.0121, 0)});
  EXPECT_NE(rig.contact_of(0), nullptr) << "awake, the floor pushes it";
  EXPECT_TRUE(rig.contacts.roused().empty()) << "told once";
}

TEST(Contacts, AnExcludedNodeTouchesNothing) {
  ContactRig rig({bar(0.01, 0.006, 0.05)}, {{0, -0.0029, 0}, {0.001, -0.0029, 0}});
  rig.engage({at(0, 0, 0)});
  rig.touch({at(0, 0, 0)});
  ASSERT_EQ(rig.contacts.constraints().size(), 2u);
  rig.contacts.exclude(0);
  EXPECT_EQ(rig.contact_of(0), nullptr) << "let go at once";
  EXPECT_NE(rig.contact_of(1), nullptr);
  rig.touch({at(0, 0, 0)});
  EXPECT_EQ(rig.contact_of(0), nullptr);
  rig.contacts.clear();
  rig.engage({at(0, 0, 0)});
  rig.nodes.positions.set(0, {0, -0.0029, 0});
  rig.touch({at(0, 0, 0)});
  EXPECT_NE(rig.contact_of(0), nullptr) << "clear() brings it back";
}

TEST(Contacts, AFreshContactTellsHowFastTheyMet) {
  ContactRig rig({bar(0.01, 0.006, 0.05)}, {{0, -0.0035, 0}});
  rig.nodes.velocities.set(0, {0.3, 0.2, 0});  // up towards the bar's lower face
  rig.engage({at(0, 0, 0)});
  rig.touch({at(0, -0.001, 0)});  // which comes down at 1 m/s
  ASSERT_NE(rig.contact_of(0), nullptr);
  const double approach = rig.contact_of(0)->approach;
  EXPECT_NEAR(approach, 1.2, 1e-12);
  rig.decide(ContactState::slip);
  rig.touch({at(0, -0.002, 0)});
  EXPECT_EQ(rig.contact_of(0)->approach, approach) << "of the first moment";
}

}  // namespace
}  // namespace crumble
