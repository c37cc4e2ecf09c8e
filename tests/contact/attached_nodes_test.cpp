// Nodes that a frame holds for good.
#include <gtest/gtest.h>

#include "contact/contact_rig.hpp"
#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

struct AttachedRig {
  NodeArrays nodes;
  Contacts contacts;

  AttachedRig(const Vector<Vec3>& start, Vector<Attachment> attachments, Vector<Tool> tools = {},
              Vector<Wall> walls = {})
      : nodes(start),
        contacts(std::move(tools), std::move(walls), Vector<std::uint8_t>(start.size()), ContactRule::nearest_surface,
                 std::move(attachments)) {}

  void touch(const Vector<Pose>& poses) {
    for (std::size_t h = 0; h < poses.size(); ++h) contacts.move_holder(h, poses[h], kTau);
    for (std::uint32_t place = 0; place < contacts.place_count(); ++place) {
      contacts.find(place, nodes), contacts.project(nodes);
    }
  }
};

TEST(AttachedNodes, GoWhereTheFrameGoesWithoutDrift) {
  Random random(3);
  Pose pose = random_pose(random);
  const Vector<Vec3> start{random_vector(random), random_vector(random), random_vector(random)};
  AttachedRig rig(start, {{{0, 2}}});
  rig.touch({pose});
  Vector<Vec3> locals;
  for (const Vec3& p : start) locals.push_back(pose.orientation.conjugate() * (p - pose.position));
  for (const std::uint32_t i : {0u, 2u}) EXPECT_LT(norm(rig.nodes.positions[i] - start[i]), 1e-15) << "first placing";
  for (int step = 0; step < 100000; ++step) {
    const Pose before = pose;
    const Quat turn = axis_angle(random_direction(random), 1e-3);
    pose = renormalized({pose.position + 1e-4 * random_direction(random), multiply(turn, pose.orientation)});
    rig.touch({pose});
    ASSERT_EQ(rig.contacts.constraints().size(), 2u);
    for (const NodeConstraint& c : rig.contacts.constraints()) {
      const Vec3 expected = pose.orientation * locals[c.node] + pose.position;
      ASSERT_LT(norm(rig.nodes.positions[c.node] - expected), 1e-13) << step;
      ASSERT_EQ(c.state, ContactState::attached);
      ASSERT_EQ(c.holder, 0u);
      const Vec3 way = expected - (before.orientation * locals[c.node] + before.position);
      ASSERT_LT(norm(rig.nodes.velocities[c.node] - way / kTau), 1e-9);
    }
    rig.contacts.drop_released();
  }
  EXPECT_EQ(rig.nodes.positions[1], start[1]);
}

TEST(AttachedNodes, AreNumberedBehindTheTools) {
  AttachedRig rig({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{{2}}, {{1}}}, {bar(0.01, 0.01, 0.01)});
  rig.touch({at(5, 0, 0), at(0, 0, 0), at(0, 0, 0)});
  ASSERT_EQ(rig.contacts.constraints().size(), 2u);
  EXPECT_EQ(rig.contacts.constraints()[0].node, 2u);
  EXPECT_EQ(rig.contacts.constraints()[0].holder, 1u);
  EXPECT_EQ(rig.contacts.constraints()[1].node, 1u);
  EXPECT_EQ(rig.contacts.constraints()[1].holder, 2u);
  EXPECT_TRUE(rig.contacts.engaged(1) && rig.contacts.engaged(2));
}

TEST(AttachedNodes, NoToolWallOrSleepTakesThem) {
  const Wall floor{{{0, 1, 0}, 0}, {}};
  AttachedRig rig({{0, -0.001, 0}, {0, -0.001, 0}}, {{{0}}}, {bar(0.01, 0.01, 0.01)}, {floor});
  rig.contacts.move_holder(1, at(0, 0, 0), kTau);
  rig.contacts.let_sleep(0);
  rig.touch({at(0, 0.1, 0), at(0, 0, 0)});
  ASSERT_EQ(rig.contacts.constraints().size(), 2u);
  EXPECT_EQ(rig.contacts.constraints()[0].node, 0u);
  EXPECT_EQ(rig.contacts.constraints()[0].holder, 1u);
  EXPECT_EQ(rig.contacts.constraints()[1].holder, kWorldHolder) << "the other one";
  for (double y = 0.1; y > 0; y -= 0.005) rig.touch({at(0, y, 0), at(0, 0, 0)});
  rig.contacts.push_out(rig.nodes);
  EXPECT_TRUE(rig.contacts.engaged(0)) << "what is attached does not keep a tool from being outside";
  EXPECT_EQ(rig.nodes.positions[0], Vec3(0, -0.001, 0));
  EXPECT_EQ(rig.contacts.constraints()[1].state, ContactState::attached);
  rig.contacts.exclude(0);
  rig.touch({at(0, 0, 0), at(0, 0.001, 0)});
  EXPECT_EQ(rig.nodes.positions[0], Vec3(0, -0.001, 0)) << "excluded: not there any more";
  rig.contacts.clear();
  rig.touch({at(0, 1, 0), at(0, 0, 0)});
  EXPECT_EQ(rig.contacts.constraints()[0].state, ContactState::attached) << "clear() brings it back";
}

TEST(AttachedNodes, AJumpLeavesThemWhereTheyAreAndTakesHoldOfThemAnew) {
  const double most = Contacts::kMaxAttachedSpeed * kTau;
  for (const double factor : {0.999, 1.001}) {
    AttachedRig rig({{0, 0, 0}, {0.01, 0, 0}}, {{{0, 1}}});
    rig.touch({at(0, 0, 0)});
    rig.touch({at(0, factor * most, 0)});
    EXPECT_EQ(rig.contacts.jumped(0), factor > 1);
    EXPECT_EQ(rig.nodes.positions[1], Vec3(0.01, factor > 1 ? 0 : factor * most, 0));
    if (factor < 1) continue;
    EXPECT_EQ(rig.nodes.velocities[1], Vec3::Zero());
    rig.touch({{Vec3(0, factor * most, 0), axis_angle(Vec3::UnitZ(), 0.1)}});
    EXPECT_FALSE(rig.contacts.jumped(0));
    const Vec3 arm(0.01, -factor * most, 0), turned = axis_angle(Vec3::UnitZ(), 0.1) * arm;
    EXPECT_LT(norm(rig.nodes.positions[1] - (Vec3(0, factor * most, 0) + turned)), 1e-15);
  }
  // turning counts as well
  AttachedRig rig({{1, 0, 0}}, {{{0}}});
  rig.touch({at(0, 0, 0)});
  rig.touch({{Vec3::Zero(), axis_angle(Vec3::UnitY(), 0.02)}});
  EXPECT_TRUE(rig.contacts.jumped(0));
  EXPECT_EQ(rig.nodes.positions[0], Vec3(1, 0, 0));
}

TEST(AttachedNodes, ContinueFromASnapshotWithTheSameBits) {
  Random random(5);
  AttachedRig live({{0.1, 0.2, 0.3}, {0.3, 0.1, 0}, {5, 5, 5}}, {{{1}}, {{0}}}, {bar(0.01, 0.01, 0.01)});
  Vector<Pose> poses{at(0, 0, 0), random_pose(random), random_pose(random)};
  live.touch(poses);
  const auto move = [&] {
    for (Pose& pose : poses) pose = renormalized({pose.position + 1e-4 * random_vector(random), pose.orientation});
  };
  for (int i = 0; i < 10; ++i) move(), live.touch(poses);
  ByteWriter out;
  live.contacts.save(out);
  AttachedRig restored({live.nodes.positions[0], live.nodes.positions[1], live.nodes.positions[2]}, {{{1}}, {{0}}},
                       {bar(0.01, 0.01, 0.01)});
  ByteReader in(out.bytes(), "snapshot");
  restored.contacts.load(in);
  EXPECT_EQ(in.left(), 0u);
  ASSERT_EQ(restored.contacts.constraints().size(), 2u);
  for (int i = 0; i < 10; ++i) {
    move();
    live.touch(poses), restored.touch(poses);
    for (std::size_t n = 0; n < 3; ++n) {
      ASSERT_EQ(live.nodes.positions[n], restored.nodes.positions[n]);
      ASSERT_EQ(live.nodes.velocities[n], restored.nodes.velocities[n]);
    }
  }
  // the second contact's node made that of the first
  Vector<std::uint8_t> bytes = out.bytes();
  const std::size_t first = bytes.size() - 2 * (17 + 8 + 15 * 8);
  std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(first), 8,
              bytes.end() - static_cast<std::ptrdiff_t>((bytes.size() - first) / 2));
  ByteReader damaged(bytes, "snapshot");
  EXPECT_THROW(restored.contacts.load(damaged), Error);
}

TEST(AttachedNodes, AreCheckedAtSetUp) {
  const auto code_of = [](Vector<Attachment> attachments) {
    try {
      const Contacts contacts({}, {}, Vector<std::uint8_t>{0, 0, 1}, ContactRule::nearest_surface,
                              std::move(attachments));
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("attachments[1].nodes"), std::string::npos) << error.what();
      return error.code();
    }
    return Code{};
  };
  EXPECT_EQ(code_of({{{0}}, {{1}}}), Code{});
  EXPECT_EQ(code_of({{{0}}, {}}), Code::empty);
  EXPECT_EQ(code_of({{{0}}, {{3}}}), Code::out_of_range);
  EXPECT_EQ(code_of({{{0}}, {{2}}}), Code::state);
  EXPECT_EQ(code_of({{{0}}, {{1, 0}}}), Code::state);
  EXPECT_EQ(code_of({{{0}}, {{1, 1}}}), Code::state);
}

}  // namespace
}  // namespace crumble
