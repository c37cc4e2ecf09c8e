// Tools that start inside, jump, go fast: what must never be seen in the hand.
#include <gtest/gtest.h>

#include "contact/contact_rig.hpp"
#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

TEST(ToolMotion, ToolThatStartsInsideHoldsNothingUntilItHasBeenOutside) {
  const double tops[] = {0, 0.001, 0.002};
  Vector<Vec3> nodes;
  for (const double y : tops) nodes.push_back({0, y, 0});
  ContactRig rig({bar(0.006, 0.006, 0.05)}, nodes);
  const auto expect_untouched = [&](double y) {
    rig.touch({at(0, y, 0)});
    EXPECT_FALSE(rig.contacts.engaged(0)) << y;
    EXPECT_TRUE(rig.contacts.constraints().empty()) << y;
    for (std::size_t i = 0; i < nodes.size(); ++i) EXPECT_EQ(rig.nodes.positions[i], nodes[i]);
    rig.decide(ContactState::stick);
  };
  for (const double y : {0.001, 0.0, -0.001, 0.002, 0.0045}) expect_untouched(y);
  rig.touch({at(0, 0.00501, 0)});  // its underside is above the top node
  EXPECT_TRUE(rig.contacts.engaged(0));
  EXPECT_TRUE(rig.contacts.constraints().empty());
  rig.touch({at(0, 0.0049, 0)});
  ASSERT_EQ(rig.contacts.constraints().size(), 1u);
  EXPECT_NEAR(rig.nodes.positions.y[2], 0.0019, 1e-15);
}

TEST(ToolMotion, ToolThatStartsTouchingIsEngaged) {
  for (const double depth : {0.9, 1.1}) {
    ContactRig rig({bar(0.006, 0.006, 0.05)}, {{0, 0, 0}});
    rig.touch({at(0, 0.003 - depth * Contacts::kTouch, 0)});
    EXPECT_EQ(rig.contacts.engaged(0), depth < 1);
    EXPECT_EQ(rig.contacts.constraints().size(), depth < 1 ? 1u : 0u);
  }
}

TEST(ToolMotion, FixedNodesInsideDoNotKeepAToolFromEngaging) {
  ContactRig rig({bar(0.006, 0.006, 0.05)}, {{0, 0, 0}, {1, 1, 1}}, ContactRule::nearest_surface, {}, {1, 0});
  rig.touch({at(0, 0, 0)});
  EXPECT_TRUE(rig.contacts.engaged(0));
}

TEST(ToolMotion, JumpBeyondEightHalfThicknessesSuspendsContactUntilOutside) {
  const double most = 8 * 0.0015;  // of the 3 mm bar
  for (const double factor : {0.999, 1.001}) {
    ContactRig rig({bar(0.003, 0.01, 0.05)}, {{0, 0, 0}});
    rig.touch({at(-0.006, 0, 0)});
    ASSERT_TRUE(rig.contacts.engaged(0));
    rig.touch({at(-0.006 + factor * most, 0, 0)});
    EXPECT_EQ(rig.contacts.jumped(0), factor > 1);
    EXPECT_EQ(rig.contacts.constraints().size(), factor > 1 ? 0u : 1u);
  }

  ContactRig rig({bar(0.003, 0.01, 0.05)}, {{0, 0, 0}});
  rig.touch({at(-0.1, 0, 0)});
  EXPECT_FALSE(rig.contacts.jumped(0)) << "the first place is no jump, wherever it is";
  rig.touch({at(-0.001, 0, 0)});  // lands in the body
  EXPECT_TRUE(rig.contacts.jumped(0));
  for (const double x : {-0.0005, 0.0005, 0.0014}) {
    rig.touch({at(x, 0, 0)});
    EXPECT_FALSE(rig.contacts.jumped(0));
    EXPECT_FALSE(rig.contacts.engaged(0));
    EXPECT_TRUE(rig.contacts.constraints().empty());
    EXPECT_EQ(rig.nodes.positions[0], Vec3::Zero());
  }
  rig.touch({at(0.00151, 0, 0)});
  EXPECT_TRUE(rig.contacts.engaged(0));
  rig.touch({at(0.0014, 0, 0)});
  EXPECT_EQ(rig.contacts.constraints().size(), 1u);
  EXPECT_NEAR(rig.nodes.positions.x[0], -0.0001, 1e-15);
}

// The tool jumps off to where no node is, so it engages again at once: what stuck to it must stay behind.
TEST(ToolMotion, JumpLeavesStickingNodesBehind) {
  for (const ContactState state : {ContactState::stick, ContactState::slip}) {
    ContactRig rig({bar(0.006, 0.006, 0.05)}, {{0, -0.0029, 0}});
    rig.engage({at(0, 0, 0)});
    rig.touch({at(0, 0, 0)});
    rig.decide(state);
    const Vec3 held = rig.nodes.positions[0];
    rig.touch({at(0, 1, 0)});
    EXPECT_TRUE(rig.contacts.jumped(0));
    EXPECT_TRUE(rig.contacts.constraints().empty());
    EXPECT_EQ(rig.nodes.positions[0], held);
  }
}

TEST(ToolMotion, TurningInPlaceCountsAsTravel) {
  ContactRig rig({bar(0.006, 0.006, 0.05)}, {{1, 1, 1}});
  rig.touch({at(0, 0, 0)});
  rig.touch({{Vec3::Zero(), axis_angle(Vec3::UnitX(), 0.1)}});  // the corners go 2.5 mm
  EXPECT_EQ(rig.contacts.place_count(), 1u);
  rig.touch({{Vec3::Zero(), axis_angle(Vec3::UnitX(), 0.3)}});  // 5 mm
  EXPECT_EQ(rig.contacts.place_count(), 2u);
  rig.touch({{Vec3::Zero(), axis_angle(Vec3::UnitX(), 2.0)}});  // 38 mm
  EXPECT_TRUE(rig.contacts.jumped(0));
}

// A tool passes over nodes at 0.1 to 7.9 half thicknesses per step, along its thin side. All are pushed ahead of it.
TEST(ToolMotion, FastThinToolDoesNotPassItsNodes) {
  Random random(21);
  for (int trial = 0; trial < 300; ++trial) {
    const Tool tool = bar(0.003, 0.01, 0.05);
    const Pose start = random_pose(random);
    const Frame frame(start);
    const double per_step = random.uniform(0.1, 7.9) * tool.shape->half_thickness();
    Vector<Vec3> nodes;
    for (int i = 0; i < 20; ++i) {  // farther from the sides than the depth that one place can bring
      nodes.push_back(frame.to_scene(
          {random.uniform(0.002, 0.05), random.uniform(-0.0034, 0.0034), random.uniform(-0.023, 0.023)}));
    }
    ContactRig rig({tool}, nodes);
    rig.touch({start});
    for (double gone = 0; gone < 0.06; gone += per_step) {
      const Pose pose{frame.to_scene({gone, 0, 0}), start.orientation};
      rig.touch({pose});
      ASSERT_TRUE(rig.contacts.engaged(0));
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        ASSERT_GT(Frame(pose).to_local(rig.nodes.positions[i]).x(), 0.0015 - 1e-12)
            << per_step << " m per step, node " << i;
      }
      rig.decide(ContactState::slip);
    }
    ASSERT_EQ(rig.contacts.constraints().size(), nodes.size());
  }
}

// The 8 mm stick through a cloud of nodes: whatever its line, a node on it is met, and none is left inside.
TEST(ToolMotion, FastRoundStickMeetsWhatIsOnItsWay) {
  Random random(22);
  for (int trial = 0; trial < 100; ++trial) {
    const Tool tool{make_round_stick(0.004, 0.05, 16), kPaperFriction};
    const Pose start = random_pose(random);
    const Frame frame(start);
    const double per_step = random.uniform(0.1, 7.9) * tool.shape->half_thickness();
    Vector<Vec3> nodes;
    for (int i = 0; i < 50; ++i) {  // where its chord is longer than a place
      nodes.push_back(
          frame.to_scene({random.uniform(0.0041, 0.05), random.uniform(-0.0033, 0.0033), random.uniform(-0.02, 0.02)}));
    }
    ContactRig rig({tool}, nodes);
    rig.touch({start});
    Vector<bool> met(nodes.size());
    double gone = 0;
    while (gone < 0.06) {
      gone += per_step;
      rig.touch({{frame.to_scene({gone, 0, 0}), start.orientation}});
      ASSERT_LT(rig.greatest_depth(0), 1e-12);
      for (const NodeConstraint& c : rig.contacts.constraints()) met[c.node] = true;
      rig.decide(ContactState::slip);
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) ASSERT_TRUE(met[i]) << per_step << " m per step, node " << i;
  }
}

// A stick wanders through a cloud of nodes at up to 50 mm/s, pushing, turning and drawing back. The nodes it does not
// hold creep home by 0.01 mm per step; what it holds sticks, slips or is released by chance.
class WanderingStick {
 public:
  WanderingStick(const Stick& stick, ContactRule rule, std::uint64_t seed)
      : random_(seed), rig_({{stick.shape, kPaperFriction}}, cloud(), rule), home_(rig_.nodes.positions) {
    pose_.position = {0, 0.012 + stick.size.z() / 2, 0};
    pose_.orientation = axis_angle(Vec3::UnitX(), M_PI / 2);  // upright
    rig_.touch({pose_});
  }

  /// The greatest move of a node in one step beyond the tool's travel, metres.
  double greatest_excess_move(int steps) {
    double greatest = -1;
    for (int step = 0; step < steps; ++step) {
      if (step % 200 == 0) direction_ = heading(), axis_ = random_direction(random_);
      const Pose before = pose_;
      const Quat turn = axis_angle(axis_, 4e-4);
      pose_ = renormalized({before.position + 3.5e-5 * direction_, multiply(turn, before.orientation)});
      const double travel = greatest_travel(before);
      EXPECT_LT(travel, 50e-6);
      const VecArray from = rig_.nodes.positions;
      rig_.touch({pose_});
      if (step % 10 == 0) {
        EXPECT_LT(rig_.greatest_depth(0), 1e-12) << "a node is left inside in step " << step;
      }
      contacts_ += rig_.contacts.constraints().size();
      for (std::size_t i = 0; i < from.size(); ++i)
        greatest = std::max(greatest, norm(rig_.nodes.positions[i] - from[i]) - travel);
      solve();
    }
    return greatest;
  }
  std::size_t contacts() const { return contacts_; }

 private:
  static Vector<Vec3> cloud() {
    Vector<Vec3> nodes;
    for (int i = 0; i < 12 * 12 * 12; ++i)
      nodes.push_back(0.002 * Vec3(i % 12 - 5.5, i / 12 % 12 - 5.5, i / 144 - 5.5));
    return nodes;
  }
  // mostly into the cloud, often out of it
  Vec3 heading() {
    const Vec3 tip = Frame(pose_).to_scene({0, 0, 0.02});
    return random_.below(3) == 0 ? random_direction(random_) : normalized(0.012 * random_vector(random_) - tip);
  }
  double greatest_travel(const Pose& before) const {
    double greatest = 0;
    for (const Vec3& v : rig_.contacts.tools()[0].shape->surface().vertices) {
      greatest = std::max(greatest, norm(Frame(pose_).to_scene(v) - Frame(before).to_scene(v)));
    }
    return greatest;
  }
  void solve() {
    Vector<bool> stays(home_.size());
    for (NodeConstraint& c : rig_.contacts.constraints()) {
      const std::uint64_t dice = random_.below(20);
      c.state = dice == 0                                    ? ContactState::released
                : dice < 10 && c.state != ContactState::slip ? ContactState::stick
                                                             : ContactState::slip;
      stays[c.node] = c.state == ContactState::stick;
      if (c.state != ContactState::slip) continue;
      const Vec3 slide = 1e-5 * random_direction(random_);
      rig_.nodes.positions.set(c.node, rig_.nodes.positions[c.node] + slide - dot(slide, c.normal) * c.normal);
      stays[c.node] = true;
    }
    rig_.contacts.drop_released();
    for (std::size_t i = 0; i < home_.size(); ++i) {
      const Vec3 way = home_[i] - rig_.nodes.positions[i];
      if (!stays[i] && norm(way) > 0)
        rig_.nodes.positions.set(i, rig_.nodes.positions[i] + std::min(1.0, 1e-5 / norm(way)) * way);
    }
  }

  Random random_;
  Pose pose_;
  Vec3 direction_ = Vec3::Zero(), axis_ = Vec3::UnitX();
  ContactRig rig_;
  VecArray home_;
  std::size_t contacts_ = 0;
};

TEST(ToolMotion, NearestRuleMovesNoNodeFurtherThanTheToolAndATenthOfAMillimetre) {
  std::uint64_t seed = 31;
  for (const Stick& stick : paper_sticks()) {
    if (stick.name == "globe_16mm") continue;  // wider than the cloud
    WanderingStick wandering(stick, ContactRule::nearest_surface, seed++);
    EXPECT_LT(wandering.greatest_excess_move(1500), 1e-4) << stick.name;
    EXPECT_GT(wandering.contacts(), 10000u) << stick.name;
  }
}

// The paper's rule on the same ways: why it is not the default.
TEST(ToolMotion, PaperRuleTeleportsNodes) {
  WanderingStick wandering(paper_sticks()[0], ContactRule::along_motion, 31);
  EXPECT_GT(wandering.greatest_excess_move(1500), 1e-3);
}

// 1 um of travel: a node barely inside a side face goes to the tip.
TEST(ToolMotion, PaperRuleTeleportsByMillimetresForAMicrometreOfTravel) {
  for (const ContactRule rule : {ContactRule::nearest_surface, ContactRule::along_motion}) {
    ContactRig rig({bar(0.006, 0.05, 0.006)}, {{0.003 - 1e-7, -0.018, 0}}, rule);
    rig.engage({at(0, 1e-6, 0)});
    rig.touch({at(0, 0, 0)});
    const double move = norm(rig.nodes.positions[0] - Vec3(0.003 - 1e-7, -0.018, 0));
    if (rule == ContactRule::nearest_surface) {
      EXPECT_NEAR(move, 1e-7, 1e-15);
    } else {
      EXPECT_NEAR(move, 0.007, 1e-12);
    }
  }
}

}  // namespace
}  // namespace crumble
