// Fast tools, moving and turning, every kind: what they pass over is met.
#include <gtest/gtest.h>

#include "contact/tool_kinds.hpp"
#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

double greatest_travel(const Tool& tool, const Pose& from, const Pose& to) {
  const Frame a(from), b(to);
  double greatest = 0;
  const VecView corners = tool.shape->corners();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    greatest = std::max(greatest, norm(b.to_scene(corners[i]) - a.to_scene(corners[i])));
  }
  return greatest + tool.shape->rounding() * (b.rotation - a.rotation).norm();
}

// Up to 10 m/s and 50 rad/s, as far as the tool's thickness allows.
Pose fast_move(const Tool& tool, const Pose& from, Random& random) {
  const Vec3 way = random.uniform(0, 10) * kTau * random_direction(random);
  const Vec3 axis = random_direction(random);
  const double angle = random.uniform(0, 50) * kTau;
  for (double share = 1;; share *= 0.9) {
    const Pose to =
        renormalized({from.position + share * way, multiply(axis_angle(axis, share * angle), from.orientation)});
    if (greatest_travel(tool, from, to) < 7.99 * tool.shape->half_thickness()) return to;
  }
}

// The way in 200 pieces: how long at a stretch the node is inside, as a part of the way.
double longest_stay(const Tool& tool, const Pose& from, const Pose& to, const Vec3& node) {
  constexpr int kPieces = 200;
  int longest = 0, now = 0;
  for (int i = 1; i <= kPieces; ++i) {
    const Frame frame(interpolate(from, to, static_cast<double>(i) / kPieces));
    const bool inside = tool.shape->nearest(frame.to_local(node), 0).signed_distance < 0;
    now = inside ? now + 1 : 0;
    longest = std::max(longest, now);
  }
  return static_cast<double>(longest - 1) / kPieces;
}

// A node that stays inside for longer than from one place to the next, half a thickness, is met. It is put outside, and
// not behind the tool: what passes over it is what it is held by.
TEST(Sweep, NoNodePassesThroughAToolAtTenMetresAndFiftyRadiansPerSecond) {
  std::size_t passed_over = 0;
  std::uint64_t seed = 300;
  for (const ToolKind& kind : tool_kinds()) {
    Random random(seed++);
    const bool costly = !kind.convex || kind.name == "ellipsoid";  // to ask for distances
    for (int trial = 0; trial < (costly ? 4 : 40); ++trial) {
      const Pose from = random_pose(random), to = fast_move(kind.tool, from, random);
      Vector<Vec3> nodes;
      while (nodes.size() < 60) {  // on its way, and not inside it at first
        const Vec3 local = 0.01 * random_vector(random);
        if (kind.tool.shape->nearest(local, 0).signed_distance > 0) continue;
        const Vec3 p = Frame(interpolate(from, to, random.uniform(0, 1))).to_scene(local);
        if (kind.tool.shape->nearest(Frame(from).to_local(p), 0).signed_distance > 0) nodes.push_back(p);
      }
      ContactRig rig({kind.tool}, nodes);
      rig.touch({from});
      rig.touch({to});
      ASSERT_FALSE(rig.contacts.jumped(0)) << kind.name;
      const double place = kind.tool.shape->half_thickness() / greatest_travel(kind.tool, from, to);
      for (std::uint32_t i = 0; i < nodes.size(); ++i) {
        ASSERT_GT(kind.tool.shape->nearest(Frame(to).to_local(rig.nodes.positions[i]), kFar).signed_distance, -1e-9);
        if (longest_stay(kind.tool, from, to, nodes[i]) <= place) continue;
        ++passed_over;
        ASSERT_TRUE(rig.contact_of(i) || rig.nodes.positions[i] != nodes[i]) << kind.name << ", trial " << trial;
      }
    }
  }
  EXPECT_GT(passed_over, 300u);
}

// A 50 mm board that turns about its end at 50 rad/s: the nodes on its way are swept along on its front, from its hub
// to its tip, for a quarter of a turn.
TEST(Sweep, ALongBoardThatTurnsAboutItsEndPushesWhatIsOnItsWayAhead) {
  for (const double thickness : {0.008, 0.003, 0.001}) {
    Tool tool = bar(0.05, thickness, 0.03);
    tool.offset.position = {0.025, 0, 0};
    Vector<Vec3> nodes;
    for (int i = 0; i < 30; ++i) {
      const double radius = 0.008 + 0.0013 * i, angle = 0.6 + 0.02 * i;
      nodes.push_back({radius * std::cos(angle), radius * std::sin(angle), 0.0001 * i});
    }
    ContactRig rig({tool}, nodes);
    const auto turned = [](double angle) { return Pose{Vec3::Zero(), axis_angle(Vec3::UnitZ(), angle)}; };
    rig.touch({turned(0)});
    const double speed = std::min(50.0, 7.9 * thickness / 2 / 0.0505 / kTau);
    for (double angle = 0; angle < M_PI / 2; angle += speed * kTau) {
      rig.touch({turned(angle)});
      ASSERT_FALSE(rig.contacts.jumped(0));
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Vec3 local = Frame(turned(angle)).to_local(rig.nodes.positions[i]);
        ASSERT_GT(local.y(), thickness / 2 - 1e-12) << "node " << i << " at " << angle << ", " << thickness;
      }
      rig.decide(ContactState::slip);
    }
    EXPECT_EQ(rig.contacts.constraints().size(), nodes.size());
  }
}

// Why there is a bound: the 1 mm blade is done at 4 m/s.
TEST(Sweep, ThinBladeIsSuspendedAboveFourMetresPerSecond) {
  for (const double speed : {3.99, 4.01}) {
    ContactRig rig({bar(0.001, 0.01, 0.02)}, {{0.002, 0, 0}});
    rig.touch({at(0, 0, 0)});
    rig.touch({at(speed * kTau, 0, 0)});
    EXPECT_EQ(rig.contacts.jumped(0), speed > 4);
    EXPECT_EQ(rig.contacts.constraints().size(), speed > 4 ? 0u : 1u);
  }
}

}  // namespace
}  // namespace crumble
