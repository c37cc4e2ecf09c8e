// After the solver has moved the nodes, none is left inside any tool.
#include <gtest/gtest.h>

#include "contact/tool_kinds.hpp"
#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

constexpr double kDeep = 1e-9;  // metres: what tells inside from a rounding error

// A tool that goes about at up to 10 m/s and 50 rad/s, near `home` and as fast as it is followed.
class Wild {
 public:
  Wild(const Tool& tool, const Vec3& home) : tool_(&tool), home_(home) { pose_.position = home; }

  Pose next(Random& random) {
    if (random.below(8) == 0) {
      velocity_ = 10 * random.uniform(0, 1) * random_direction(random);
      turning_ = 50 * random.uniform(0, 1) * random_direction(random);
    }
    const Vec3 back = home_ - pose_.position;
    if (norm(back) > 0.006) velocity_ = norm(velocity_) * normalized(back);
    for (double share = 1;; share /= 2) {
      const Vec3 turn = share * kTau * turning_;
      Pose next{pose_.position + share * kTau * velocity_, pose_.orientation};
      if (norm(turn) > 0) next.orientation = multiply(axis_angle(normalized(turn), norm(turn)), pose_.orientation);
      next = renormalized(next);
      if (travel_to(next) < 7.99 * tool_->shape->half_thickness()) return pose_ = next;
    }
  }
  const Pose& pose() const { return pose_; }

 private:
  double travel_to(const Pose& next) const {
    const Frame from(pose_), to(next);
    double greatest = 0;
    const VecView corners = tool_->shape->corners();
    for (std::size_t i = 0; i < corners.size(); ++i) {
      greatest = std::max(greatest, norm(to.to_scene(corners[i]) - from.to_scene(corners[i])));
    }
    return greatest + tool_->shape->rounding() * (to.rotation - from.rotation).norm();
  }

  const Tool* tool_;
  Vec3 home_;
  Pose pose_;
  Vec3 velocity_ = Vec3::Zero(), turning_ = Vec3::Zero();
};

// How deep the node is in the deepest of the tools; 0 outside.
double depth(const ContactRig& rig, std::size_t node) {
  double greatest = 0;
  for (std::size_t t = 0; t < rig.contacts.tools().size(); ++t) {
    const Vec3 local = rig.contacts.frame(t).to_local(rig.nodes.positions[node]);
    greatest = std::max(greatest, -rig.contacts.tools()[t].shape->nearest(local, 0).signed_distance);
  }
  return greatest;
}

double deepest(const ContactRig& rig) {
  double greatest = 0;
  for (std::size_t i = 0; i < rig.nodes.node_count(); ++i) greatest = std::max(greatest, depth(rig, i));
  return greatest;
}

// What a solver may do: held nodes stick, slide along their tangent plane or are let go; free ones leap.
std::size_t solve_wildly(ContactRig& rig, Random& random) {
  Vector<bool> stays(rig.nodes.node_count());
  for (NodeConstraint& c : rig.contacts.constraints()) {
    c.state = static_cast<ContactState>(1 + random.below(3));
    stays[c.node] = c.state == ContactState::stick;
    if (c.state != ContactState::slip) continue;
    const Vec3 slide = 5e-4 * random_vector(random);
    rig.nodes.positions.set(c.node, rig.nodes.positions[c.node] + slide - dot(slide, c.normal) * c.normal);
    stays[c.node] = true;
  }
  std::size_t leapt_in = 0;
  for (std::uint32_t i = 0; i < stays.size(); ++i) {
    if (stays[i]) continue;
    rig.nodes.positions.set(i, (rig.nodes.positions[i] + 1e-3 * random_vector(random)).cwiseMax(-0.03).cwiseMin(0.03));
    leapt_in += depth(rig, i) > kDeep;
  }
  return leapt_in;
}

Vector<Vec3> cloud(Random& random, int count) {
  Vector<Vec3> nodes;
  for (int i = 0; i < count; ++i) nodes.push_back(0.03 * random_vector(random));
  return nodes;
}

// Every kind beside another one; their homes are so far apart that they never overlap.
TEST(PushOut, LeavesNoNodeInsideAnyToolWhateverTheMotion) {
  const Vector<ToolKind> kinds = tool_kinds();
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    const ToolKind &one = kinds[k], &other = kinds[(k + 3) % kinds.size()];
    const bool slow = !one.convex || !other.convex || one.name == "ellipsoid" || other.name == "ellipsoid";
    Random random(100 + k);
    ContactRig rig({one.tool, other.tool}, cloud(random, slow ? 300 : 600));
    Wild first(one.tool, {-0.018, 0, 0}), second(other.tool, {0.018, 0, 0});
    rig.engage({first.pose(), second.pose()});
    std::size_t leapt_in = 0;
    for (int step = 0; step < (slow ? 100 : 400); ++step) {
      rig.touch({first.next(random), second.next(random)});
      ASSERT_TRUE(rig.contacts.engaged(0) && rig.contacts.engaged(1)) << one.name << " and " << other.name;
      ASSERT_LT(deepest(rig), kDeep) << one.name << " before the solver, step " << step;
      leapt_in += solve_wildly(rig, random);
      rig.contacts.push_out(rig.nodes);
      ASSERT_LT(deepest(rig), kDeep) << one.name << " and " << other.name << ", step " << step;
      rig.contacts.drop_released();
    }
    EXPECT_GT(leapt_in, 30u) << one.name << ": nothing to push out";
  }
}

TEST(PushOut, AFreeNodeBecomesAFreshContactAndASlidingOneStaysOne) {
  ContactRig rig({bar(0.01, 0.006, 0.05)}, {{0, -0.0029, 0}, {0.002, -0.0035, 0}, {0.003, -0.0029, 0}});
  rig.engage({at(0, 0, 0)});
  rig.touch({at(0, -1e-5, 0)});
  ASSERT_EQ(rig.contacts.constraints().size(), 2u);
  rig.contacts.constraints()[0].state = ContactState::slip;
  rig.contacts.constraints()[0].reaction = {0, -1, 0.5};
  rig.contacts.constraints()[1].state = ContactState::released;
  rig.nodes.positions.set(0, {0, -0.00295, 0});
  rig.nodes.positions.set(1, {0.002, -0.003, 0});
  rig.nodes.velocities.set(1, {0.1, 0.2, 0.3});
  rig.nodes.positions.set(2, {0.003, -0.003, 0});
  rig.contacts.push_out(rig.nodes);
  for (std::uint32_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(rig.nodes.positions.y[i], -0.00301, 1e-15);
    ASSERT_NE(rig.contact_of(i), nullptr);
    EXPECT_EQ(rig.contact_of(i)->state, i == 0 ? ContactState::slip : ContactState::fresh);
  }
  EXPECT_EQ(rig.contact_of(0)->reaction, Vec3(0, -1, 0.5)) << "this step's force was already exchanged";
  EXPECT_LT(norm(rig.nodes.velocities[1] - Vec3(0.1, -0.01, 0.3)), 1e-12) << "normal velocity is the tool's";
  EXPECT_NEAR(rig.contact_of(1)->approach, 0.21, 1e-12);
  rig.contacts.drop_released();
  EXPECT_EQ(rig.contacts.constraints().size(), 3u);
  rig.touch({at(0, -2e-5, 0)});
  EXPECT_EQ(rig.contacts.constraints().size(), 3u) << "held from then on";
}

TEST(PushOut, LeavesAloneWhatIsFixedAttachedExcludedOrUnderAJump) {
  const Vector<Vec3> nodes(3, {0, -0.0029, 0});
  Contacts contacts({bar(0.01, 0.006, 0.05)}, {}, Vector<std::uint8_t>{1, 0, 0}, ContactRule::nearest_surface, {{{1}}});
  NodeArrays source(nodes), elsewhere = far_away(3);
  contacts.exclude(2);
  contacts.move_holder(0, at(0, 0, 0), kTau);
  contacts.find(0, elsewhere);
  contacts.push_out(source);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(source.positions[i], nodes[i]);
  EXPECT_TRUE(contacts.constraints().empty());

  ContactRig rig({bar(0.01, 0.006, 0.05)}, nodes);
  rig.touch({at(0, 0, 0)});  // begins inside
  rig.contacts.push_out(rig.nodes);
  EXPECT_EQ(rig.nodes.positions[0], nodes[0]);
}

// The paper looks at the nodes once a step.
TEST(PushOut, IsNotDoneUnderThePapersRule) {
  ContactRig rig({bar(0.01, 0.006, 0.05)}, {{0, -0.0035, 0}}, ContactRule::along_motion);
  rig.touch({at(0, 0, 0)});
  rig.nodes.positions.set(0, {0, -0.0029, 0});
  rig.contacts.push_out(rig.nodes);
  EXPECT_EQ(rig.nodes.positions.y[0], -0.0029);
}

}  // namespace
}  // namespace crumble
