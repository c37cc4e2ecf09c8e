#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <limits>

#include "contact/contact_rig.hpp"
#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "support/allocation_counter.hpp"

namespace crumble {
namespace {

// Two sticks that knead a cloud of nodes above a floor; every step follows from its index and the state before it.
struct Kneading {
  ContactRig rig = make_rig();

  static ContactRig make_rig() {
    Random random(41);
    Vector<Vec3> nodes;
    Vector<std::uint8_t> fixed;
    for (int i = 0; i < 600; ++i) {
      nodes.push_back({random.uniform(-0.015, 0.015), random.uniform(0, 0.03), random.uniform(-0.015, 0.015)});
      fixed.push_back(i % 10 == 0);
    }
    const Vector<Stick> sticks = paper_sticks();
    return {{{sticks[0].shape, kPaperFriction}, {sticks[2].shape, {0.8, 0.4}}},
            nodes,
            ContactRule::nearest_surface,
            {{{{0, 1, 0}, 0}, kPaperFriction}, {{{1, 0, 0}, -0.014}, {1, 0}}},
            fixed};
  }

  static Vector<Pose> poses(int step) {
    const double s = step * 5e-5, leap = step % 150 == 149 ? 0.1 : 0;  // a jump now and then
    return {{Vec3(0.004 + leap, 0.036 - s, 0), axis_angle(Vec3::UnitY(), 0.2 * s / 0.01)},
            {Vec3(-0.006, 0.04 - s, 0.003), axis_angle(Vec3::UnitZ(), -0.1 * s / 0.01)}};
  }

  void step(int index) {
    rig.touch(poses(index));
    for (NodeConstraint& c : rig.contacts.constraints()) {
      Random dice((static_cast<std::uint64_t>(index) << 32) + c.node);
      c.state = static_cast<ContactState>(dice.below(10) == 0 ? 3 : 1 + dice.below(2));
      if (c.state != ContactState::stick) {
        const Vec3 slide = 2e-5 * random_vector(dice);
        rig.nodes.positions.set(c.node, rig.nodes.positions[c.node] + slide - dot(slide, c.normal) * c.normal);
      }
      c.reaction = random_vector(dice);
    }
    rig.contacts.drop_released();
  }
  Vector<std::uint8_t> saved() const {
    ByteWriter out;
    rig.contacts.save(out);
    return out.bytes();
  }
  void load(std::span<const std::uint8_t> bytes) {
    ByteReader in(bytes, "snapshot");
    rig.contacts.load(in);
    EXPECT_EQ(in.left(), 0u);
  }
};

Kneading kneaded(int steps) {
  Kneading kneading;
  for (int i = 0; i < steps; ++i) kneading.step(i);
  return kneading;
}

std::optional<Code> code_of_load(std::span<const std::uint8_t> bytes) {
  Kneading kneading;
  ByteReader in(bytes, "snapshot");
  try {
    kneading.rig.contacts.load(in);
  } catch (const Error& error) {
    return error.code();
  }
  return {};
}

void expect_same(const Kneading& a, const Kneading& b) {
  const auto same = [](const Vec3& u, const Vec3& v) { return std::memcmp(u.data(), v.data(), sizeof(Vec3)) == 0; };
  for (std::size_t i = 0; i < a.rig.nodes.positions.size(); ++i) {
    ASSERT_TRUE(same(a.rig.nodes.positions[i], b.rig.nodes.positions[i]) &&
                same(a.rig.nodes.velocities[i], b.rig.nodes.velocities[i]))
        << i;
  }
  const auto left = a.rig.contacts.constraints(), right = b.rig.contacts.constraints();
  ASSERT_EQ(left.size(), right.size());
  for (std::size_t k = 0; k < left.size(); ++k) {
    const NodeConstraint &u = left[k], &v = right[k];
    ASSERT_TRUE(u.node == v.node && u.holder == v.holder && u.state == v.state) << k;
    ASSERT_TRUE(same(u.point, v.point) && same(u.normal, v.normal) && same(u.velocity, v.velocity)) << k;
    ASSERT_TRUE(u.static_friction == v.static_friction && u.dynamic_friction == v.dynamic_friction) << k;
  }
}

TEST(ContactSnapshot, ContinuesWithTheSameBits) {
  // before the first move, in contact, in a jump, in the jump back, later
  for (const auto& [steps, jumped] :
       {std::pair{0, false}, {1, false}, {120, false}, {150, true}, {151, true}, {280, false}}) {
    Kneading live = kneaded(steps), restored;
    restored.rig.nodes.positions = live.rig.nodes.positions;
    restored.rig.nodes.velocities = live.rig.nodes.velocities;
    const Vector<std::uint8_t> bytes = live.saved();
    restored.load(bytes);
    EXPECT_EQ(restored.saved(), bytes);
    EXPECT_EQ(live.rig.contacts.jumped(0), jumped);
    EXPECT_EQ(restored.rig.contacts.jumped(0), jumped);
    std::size_t contacts = 0;
    for (int i = steps; i < steps + 200; ++i) {
      live.step(i), restored.step(i);
      contacts += live.rig.contacts.constraints().size();
      expect_same(live, restored);
      ASSERT_FALSE(HasFatalFailure()) << "step " << i << " after " << steps;
      for (std::size_t t = 0; t < 2; ++t) {
        ASSERT_EQ(live.rig.contacts.engaged(t), restored.rig.contacts.engaged(t));
        ASSERT_EQ(live.rig.contacts.jumped(t), restored.rig.contacts.jumped(t));
      }
    }
    EXPECT_GT(contacts, 200u);
  }
}

TEST(ContactSnapshot, RestoredToolStandsStillUntilItIsMoved) {
  Kneading restored;
  restored.load(kneaded(200).saved());
  restored.rig.contacts.find(0, restored.rig.nodes);
  ASSERT_FALSE(restored.rig.contacts.constraints().empty());
  for (const NodeConstraint& c : restored.rig.contacts.constraints()) ASSERT_EQ(c.velocity, Vec3::Zero());
}

TEST(ContactSnapshot, EveryTruncationIsCorrupt) {
  const Vector<std::uint8_t> bytes = kneaded(200).saved();
  ASSERT_GT(bytes.size(), 1000u);
  EXPECT_EQ(code_of_load(bytes), std::nullopt);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    ASSERT_EQ(code_of_load(std::span(bytes).first(size)), Code::corrupt) << size;
  }
}

// Where the fields of snapshot.cpp lie.
constexpr std::size_t kToolBytes = 7 * 8 + 1, kCutAt = 2 * kToolBytes, kCountAt = kCutAt + 8,
                      kFirstContact = kCountAt + 8;
constexpr std::size_t kStateAt = 8, kPointAt = 9 + 8, kNormalAt = kPointAt + 3 * 8, kWallAt = kPointAt + 9 * 8,
                      kFaceAt = kWallAt + 4, kAnchorAt = kFaceAt + 4, kContactBytes = kAnchorAt + 6 * 8;

template <class T>
void put_at(Vector<std::uint8_t>& bytes, std::size_t offset, T value) {
  ASSERT_LE(offset + sizeof value, bytes.size());
  std::memcpy(bytes.data() + offset, &value, sizeof value);
}

TEST(ContactSnapshot, ImpossibleValuesAreCorrupt) {
  const Vector<std::uint8_t> good = kneaded(200).saved();
  const double nan = std::nan("");
  const auto damaged = [&](std::size_t offset, auto value) {
    Vector<std::uint8_t> bytes = good;
    put_at(bytes, offset, value);
    return code_of_load(bytes);
  };
  ASSERT_EQ((good.size() - kFirstContact) % kContactBytes, 0u);
  EXPECT_EQ(damaged(0, nan), Code::corrupt) << "position";
  EXPECT_EQ(damaged(24, std::numeric_limits<double>::infinity()), Code::corrupt) << "orientation";
  EXPECT_EQ(damaged(24, 2.0), Code::corrupt) << "orientation that is no rotation";
  EXPECT_EQ(damaged(56, std::uint8_t{8}), Code::corrupt) << "flags";
  EXPECT_EQ(damaged(kCountAt, std::uint64_t{601}), Code::corrupt) << "more contacts than nodes";
  EXPECT_EQ(damaged(kCountAt, ~std::uint64_t{0}), Code::corrupt) << "count";
  EXPECT_EQ(damaged(kFirstContact, std::uint32_t{600}), Code::corrupt) << "node";
  EXPECT_EQ(damaged(kFirstContact, std::uint32_t{10}), Code::corrupt) << "fixed node";
  EXPECT_EQ(damaged(kFirstContact + 4, std::uint32_t{2}), Code::corrupt) << "holder";
  EXPECT_EQ(damaged(kFirstContact + kStateAt, std::uint8_t{3}), Code::corrupt) << "released";
  EXPECT_EQ(damaged(kFirstContact + kStateAt, std::uint8_t{4}), Code::corrupt) << "attached";
  EXPECT_EQ(damaged(kFirstContact + kStateAt, std::uint8_t{5}), Code::corrupt) << "state";
  for (std::size_t k = 0; k < 9; ++k) EXPECT_EQ(damaged(kFirstContact + kPointAt + 8 * k, nan), Code::corrupt) << k;
  EXPECT_EQ(damaged(kFirstContact + kFaceAt, std::uint32_t{0}), Code::corrupt) << "face of a body without a surface";
  EXPECT_EQ(damaged(kFirstContact + kNormalAt, 1.5), Code::corrupt) << "normal that is no unit vector";
  for (std::size_t k = 0; k < 6; ++k) EXPECT_EQ(damaged(kFirstContact + kAnchorAt + 8 * k, nan), Code::corrupt) << k;
  EXPECT_EQ(damaged(kFirstContact + kAnchorAt + 24, 1.5), Code::corrupt) << "normal in the tool's frame";
  for (const std::uint32_t wall : {1u, 2u}) {
    Vector<std::uint8_t> bytes = good;
    put_at(bytes, kFirstContact + 4, kWorldHolder), put_at(bytes, kFirstContact + kWallAt, wall);
    EXPECT_EQ(code_of_load(bytes), wall == 2 ? std::optional(Code::corrupt) : std::nullopt);
  }
  std::uint32_t first_node = 0;
  std::memcpy(&first_node, good.data() + kFirstContact, sizeof first_node);
  EXPECT_EQ(damaged(kFirstContact + kContactBytes, first_node), Code::corrupt) << "a node with two holders";
}

// Whatever byte is wrong, loading answers or the steps that follow keep their promises.
TEST(ContactSnapshot, FlippedBytesAreRefusedOrHarmless) {
  const Kneading live = kneaded(200);
  const Vector<std::uint8_t> good = live.saved();
  Random random(42);
  int accepted = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    Vector<std::uint8_t> bytes = good;
    bytes[random.below(bytes.size())] ^= static_cast<std::uint8_t>(1u << random.below(8));
    Kneading damaged = live;
    ByteReader in(bytes, "snapshot");
    try {
      damaged.rig.contacts.load(in);
      ++accepted;
    } catch (const Error& error) {
      ASSERT_EQ(error.code(), Code::corrupt);
    }
    const AllocationCounter allocations;
    for (int i = 200; i < 203; ++i)
      damaged.rig.contacts.find(0, damaged.rig.nodes), damaged.rig.contacts.drop_released();
    ASSERT_EQ(allocations.count(), 0u);
    Vector<bool> seen(damaged.rig.nodes.positions.size());
    for (const NodeConstraint& c : damaged.rig.contacts.constraints()) {
      ASSERT_FALSE(seen[c.node]);
      seen[c.node] = true;
    }
  }
  EXPECT_GT(accepted, 100);
  EXPECT_LT(accepted, 2000);
}

// A snapshot is restored into a copy, whose vectors have lost their reserve.
TEST(ContactSteps, DoNotAllocateAfterARestoreIntoACopy) {
  if (!AllocationCounter::available()) GTEST_SKIP() << "malloc is not counted in this build";
  const Vector<std::uint8_t> bytes = kneaded(10).saved();
  const Kneading original;
  Kneading copy = original;
  copy.load(bytes);
  std::size_t contacts = 0;
  for (int i = 10; i < 200; ++i) {
    const Vector<Pose> poses = Kneading::poses(i);
    const AllocationCounter allocations;
    copy.rig.touch(poses);
    copy.rig.decide(ContactState::stick);
    ASSERT_EQ(allocations.count(), 0u) << "step " << i;
    contacts += copy.rig.contacts.constraints().size();
  }
  EXPECT_GT(contacts, 1000u);
}

TEST(ContactSteps, DoNotAllocate) {
  if (!AllocationCounter::available()) GTEST_SKIP() << "malloc is not counted in this build";
  {
    const AllocationCounter allocations;
    volatile std::size_t size = 100;
    const Vector<int> some(size);
    ASSERT_EQ(allocations.count(), 1u) << "the counter itself";
  }
  Kneading kneading;
  std::size_t contacts = 0;
  for (int i = 0; i < 500; ++i) {
    const Vector<Pose> poses = Kneading::poses(i);
    Random dice(i);
    const AllocationCounter allocations;
    kneading.rig.touch(poses);
    for (NodeConstraint& c : kneading.rig.contacts.constraints())
      c.state = static_cast<ContactState>(1 + dice.below(3));
    kneading.rig.contacts.drop_released();
    ASSERT_EQ(allocations.count(), 0u) << "step " << i;
    contacts += kneading.rig.contacts.constraints().size();
  }
  EXPECT_GT(contacts, 1000u);
}

}  // namespace
}  // namespace crumble
