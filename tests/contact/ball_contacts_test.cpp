#include <gtest/gtest.h>

#include <cstring>
#include <functional>

#include "contact/brute_balls.hpp"
#include "contact/crumb_rig.hpp"
#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/random.hpp"
#include "crumble/tetmesh/lattice_box.hpp"
#include "support/allocation_counter.hpp"

namespace crumble {
namespace {

using Ids = Vector<std::uint32_t>;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Vec3 random_vector(Random& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

// A small box that is cut at random, whose nodes wander and whose fragments sleep, wake and vanish: one that no solver
// would make, and all that the contract allows.
struct Turmoil {
  static constexpr double kSpacing = 0.004;

  explicit Turmoil(std::uint64_t seed)
      : random(seed), mesh(make_lattice_box(Vec3(3, 3, 3) * kSpacing, kSpacing)), balls(body().setup()) {
    x = mesh.positions;
    v.resize(x.size(), Vec3::Zero());
    intact.resize(mesh.springs.size(), 1);
    regroup({});
  }

  BruteBalls::Body body() {
    Random dice(3);
    BruteBalls::Body b{mesh.springs, {}, {}, {}, {}, {}, {}, {0.6, 0.4}, 1e-3};
    for (std::size_t i = 0; i < mesh.node_count(); ++i) {
      b.radii.push_back(kSpacing * dice.uniform(0.4, 0.6));
      b.masses.push_back(dice.uniform(2e-5, 8e-5));
      b.stiffnesses.push_back(dice.uniform(20, 40));
      b.stiffness_sums.push_back(dice.uniform(200, 400));
      b.on_surface.push_back(mesh.kinds[i] != NodeKind::inside);
      b.fixed.push_back(i % 17 == 0);
    }
    return b;
  }

  // Labels by the springs, states by the dice. What is removed stays so.
  void regroup(const Ids& cuts) {
    FragmentLabeler labeler(mesh.node_count(), mesh.springs);
    const std::size_t count = labeler.label(intact);
    labels.assign(labeler.labels().begin(), labeler.labels().end());
    const std::uint32_t victim =
        count > 8 && random.below(5) == 0 ? static_cast<std::uint32_t>(count - 2) : kNoFragment;
    removed.resize(labels.size());
    fragments.assign(count, {});
    for (std::uint32_t i = 0; i < labels.size(); ++i) {
      if (labels[i] == victim) removed[i] = true;
      if (removed[i]) {
        labels[i] = kNoFragment;
      } else {
        fragments[labels[i]].mass += labels[i] % 5 == 4 ? kInfinity : 5e-5;
      }
    }
    for (std::size_t id = 1; id < count; ++id) fragments[id].asleep = random.below(4) == 0;
    balls.update(cuts, labels, fragments);
    last_cuts = cuts;
  }

  void move() {
    const double pace = random.below(10) == 0 ? 3e-4 : 3e-5;
    for (std::size_t i = 0; i < x.size(); ++i) {
      v[i] = random_vector(random, pace) / 1e-3;
      x[i] += 1e-3 * v[i] - 0.002 * (x[i] - mesh.positions[i]);
    }
  }

  bool cut() {
    last_cuts.clear();
    if (random.below(4) > 0) return false;
    for (std::uint64_t n = random.below(8); n > 0; --n) {
      const auto spring = static_cast<std::uint32_t>(random.below(intact.size()));
      if (std::exchange(intact[spring], std::uint8_t{0})) last_cuts.push_back(spring);
    }
    regroup(Ids(last_cuts));
    return true;
  }

  void find() {
    VecArray at(balls.nodes().size()), speeds(balls.nodes().size());
    for (std::size_t i = 0; i < at.size(); ++i) at.set(i, x[balls.nodes()[i]]), speeds.set(i, v[balls.nodes()[i]]);
    balls.find(at, speeds);
  }

  void step() {
    move();
    cut();
    find();
  }

  std::uint64_t hash() const {
    Hash hash;
    balls.add_to(hash);
    for (std::size_t i = 0; i < balls.pushed().size(); ++i) {
      hash.add(std::uint64_t{balls.pushed()[i]});
      for (int axis = 0; axis < 3; ++axis) hash.add(balls.forces()[i][axis]);
    }
    return hash.value();
  }
  std::uint64_t state_hash() const {
    Hash hash;
    balls.add_to(hash);
    return hash.value();
  }
  Vector<std::uint8_t> saved() const {
    ByteWriter out;
    balls.save(out);
    return out.bytes();
  }

  Random random;
  TetMesh mesh;
  BallContacts balls;
  Vector<Vec3> x, v;
  Vector<std::uint8_t> intact;
  Vector<bool> removed;
  Ids labels, last_cuts;
  Vector<BallFragment> fragments;
};

TEST(BallContacts, FindsWhatAllPairsFind) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Turmoil t(seed);
    BruteBalls brute(t.body());
    brute.update({}, t.labels, t.fragments);
    std::size_t contacts = 0;
    for (int step = 0; step < 400; ++step) {
      t.move();
      if (t.cut()) brute.update(t.last_cuts, t.labels, t.fragments);
      t.find();
      const auto expected = brute.find(t.x, t.v);
      ASSERT_EQ(t.balls.contact_count(), expected.size()) << "seed " << seed << " step " << step;
      std::map<std::uint32_t, Vec3> sums;
      std::size_t k = 0;
      for (const auto& [pair, force] : expected) {
        const BallContact contact = t.balls.contact(k++);
        ASSERT_EQ(contact.first, pair.first);
        ASSERT_EQ(contact.second, pair.second);
        ASSERT_LE(norm(contact.force - force), 1e-12 * (norm(force) + 1e-3)) << "seed " << seed << " step " << step;
        sums.try_emplace(pair.first, Vec3::Zero()).first->second += force;
        sums.try_emplace(pair.second, Vec3::Zero()).first->second -= force;
      }
      std::erase_if(sums,
                    [&](const auto& sum) { return sum.first % 17 == 0 || t.fragments[t.labels[sum.first]].asleep; });
      ASSERT_EQ(t.balls.pushed().size(), sums.size());
      for (std::size_t i = 0; i < sums.size(); ++i) {
        ASSERT_LE(norm(t.balls.forces()[i] - sums.at(t.balls.pushed()[i])), 1e-12);
      }
      contacts += expected.size();
    }
    EXPECT_GT(contacts, 10000u);
    EXPECT_GT(brute.memory_count(), 1000u);
    EXPECT_LT(t.balls.searches(), 250u) << "a list is of use only if it lasts";
    EXPECT_EQ(t.balls.dropped_pairs(), 0u);
  }
}

// Nodes that dart through the others are searched for by themselves.
TEST(BallContacts, FastNodesAreFoundOneByOne) {
  Turmoil t(5);
  for (std::uint32_t s = 0; s < t.intact.size(); s += 2) t.intact[s] = 0, t.last_cuts.push_back(s);
  t.regroup(Ids(t.last_cuts));
  BruteBalls brute(t.body());
  brute.update(t.last_cuts, t.labels, t.fragments);
  std::size_t hits = 0;
  for (int step = 0; step < 600; ++step) {
    for (std::size_t i = 0; i < t.x.size(); ++i) {
      t.v[i] = random_vector(t.random, 0.02);
      t.x[i] += 1e-3 * t.v[i] - 0.1 * (t.x[i] - t.mesh.positions[i]);
    }
    for (int i = 2; i < 40; i += 15) t.x[i] = Vec3(-0.02 + 0.0025 * (step % (20 + i)), 0.006, 0.004 + 1e-4 * i);
    t.find();
    const auto expected = brute.find(t.x, t.v);
    ASSERT_EQ(t.balls.contact_count(), expected.size()) << step;
    std::size_t k = 0;
    for (const auto& [pair, force] : expected) {
      const BallContact contact = t.balls.contact(k++);
      ASSERT_EQ(std::pair(contact.first, contact.second), pair);
      ASSERT_LE(norm(contact.force - force), 1e-12 * (norm(force) + 1e-3)) << step;
      hits += pair.first == 2 || pair.second == 17 || pair.second == 32;
    }
  }
  EXPECT_GT(hits, 300u);
  EXPECT_LT(t.balls.searches(), 20u);
}

TEST(BallContacts, WholeBodyTakesNoPart) {
  Turmoil t(1);
  t.find();
  EXPECT_TRUE(t.balls.nodes().empty());
  t.balls.update(Ids{5}, t.labels, t.fragments);  // one fragment still: the ends of the cut alone
  ASSERT_EQ(t.balls.nodes().size(), 2u);
  EXPECT_EQ(t.balls.nodes()[0], t.mesh.springs[5][0]);
  t.balls.reset();
  EXPECT_TRUE(t.balls.nodes().empty());
}

// Two single nodes 4 mm apart with balls of 2.2 mm: nothing at the cut, and outward only.
TEST(BallContacts, CutGivesNoKick) {
  CrumbRig rig({.positions = {{0, 0, 0}, {0.004, 0, 0}}, .labels = {0, 1}, .springs = {{0, 1}}});
  const auto force_at = [&](double distance) {
    rig.positions.x[1] = distance;
    rig.find();
    return rig.balls->contact_count() == 0 ? 0 : rig.balls->contact(0).force.x();
  };
  EXPECT_EQ(force_at(0.004), 0);
  EXPECT_LT(force_at(0.0039), 0);
  const double at_first = force_at(0.0038);
  const double k = 5e-5 / 4 / 1e-6;  // of each one's mass: softer than the springs
  EXPECT_NEAR(at_first, -k * 0.0002, 1e-15);
  EXPECT_EQ(force_at(0.0042), 0);  // grows outward
  EXPECT_NEAR(force_at(0.0038), -k * 0.0004, 1e-15);
  EXPECT_EQ(force_at(0.0050), 0);  // to the sum of the radii
  EXPECT_NEAR(force_at(0.0038), -k * 0.0006, 1e-15);
}

TEST(BallContacts, ForcesOfAllSumToZero) {
  Random random(12);
  Vector<Vec3> nodes;
  Ids labels;
  for (std::uint32_t i = 0; i < 300; ++i) nodes.push_back(random_vector(random, 0.012)), labels.push_back(i / 2);
  CrumbRig rig({.positions = nodes, .labels = labels});
  rig.gravity.setZero(), rig.floor = false;
  // first seen where they are: apart, and together again
  for (const double scale : {2.0, 1.0}) {
    for (std::uint32_t i = 0; i < 300; ++i) {
      rig.positions.set(i, scale * nodes[i]);
      rig.velocities.set(i, random_vector(random, 0.1));
    }
    rig.find();
  }
  ASSERT_GT(rig.balls->contact_count(), 300u);
  Vec3 sum = Vec3::Zero();
  double size = 0;
  for (const Vec3& force : rig.balls->forces()) sum += force, size += norm(force);
  EXPECT_LT(norm(sum), 1e-14 * size);
}

TEST(BallContacts, SleepersAreRousedByAHit) {
  for (const double speed : {0.005, 0.02}) {
    CrumbRig rig({.positions = {{0, 0, 0}, {0.0045, 0, 0}}, .labels = {0, 1}});
    rig.gravity.setZero(), rig.floor = false;
    rig.crumbs[1].asleep = true;
    rig.crumbs[0].velocity.x() = speed;
    rig.balls->update({}, rig.labels, rig.fragments());
    Ids roused;
    for (int step = 0; step < 60 && roused.empty(); ++step) {
      rig.step();
      for (const std::uint32_t node : rig.balls->pushed()) EXPECT_EQ(node, 0u);
      roused.assign(rig.balls->roused().begin(), rig.balls->roused().end());
    }
    EXPECT_EQ(roused, speed > 0.01 ? Ids{1} : Ids{});
  }
}

TEST(BallContacts, SnapshotHasTheSameFuture) {
  Turmoil t(9);
  for (int step = 0; step < 150; ++step) t.step();
  Turmoil u = t;  // the same dice
  Turmoil fresh(9);
  for (int step = 0; step < 150; ++step) {
    u.move();
    u.cut();  // saved with cuts that find() has not seen
    if (step % 10 == 0) {
      const auto bytes = u.saved();
      ByteReader in(bytes, "snapshot");
      u.balls = BallContacts(fresh.balls);
      u.balls.load(in);
      EXPECT_EQ(in.left(), 0u);
      EXPECT_EQ(u.balls.contact_count(), 0u);
    }
    t.move();
    t.cut();
    ASSERT_EQ(u.state_hash(), t.state_hash()) << step;
    u.find();
    t.find();
    ASSERT_EQ(u.hash(), t.hash()) << step;
    ASSERT_EQ(u.saved(), t.saved());
  }
  EXPECT_GT(u.balls.contact_count(), 20u);
}

TEST(BallContacts, DamagedSnapshotsAreRefused) {
  Turmoil t(4);
  for (int step = 0; step < 100; ++step) t.step();
  const auto good = t.saved();
  const std::uint64_t hash = t.state_hash();
  const auto refuses = [&](std::span<const std::uint8_t> bytes) {
    ByteReader in(bytes, "snapshot");
    try {
      t.balls.load(in);
    } catch (const Error& error) {
      return error.code() == Code::corrupt && t.state_hash() == hash;
    }
    return false;
  };
  for (std::size_t size = 0; size < good.size(); size += 61) {
    EXPECT_TRUE(refuses(std::span(good).first(size))) << size;
  }
  auto bad = good;
  bad[3] = 9;  // a spring
  EXPECT_TRUE(refuses(bad));
  bad = good;
  ASSERT_GT(t.balls.contact_count(), 0u);
  std::memset(bad.data() + bad.size() - 40, 0xff, 4);  // the first node of the last pair
  EXPECT_TRUE(refuses(bad));
  bad = good;
  std::memset(bad.data() + bad.size() - 8, 0xff, 8);  // a shear
  EXPECT_TRUE(refuses(bad));
}

TEST(BallContacts, PairsBeyondTheRoomAreCounted) {
  Random random(2);
  Vector<Vec3> nodes;
  Ids labels;
  for (std::uint32_t i = 0; i < 40; ++i) nodes.push_back(random_vector(random, 1e-4)), labels.push_back(i);
  CrumbRig rig({.positions = nodes, .labels = labels});
  rig.find();
  EXPECT_EQ(rig.balls->dropped_pairs(), 40u * 39 / 2 - 40 * 16);
  for (std::uint32_t i = 0; i < 40; ++i) rig.positions.set(i, 40 * nodes[i]);
  rig.find();
  EXPECT_EQ(rig.balls->dropped_pairs(), 0u);
}

TEST(BallContacts, NoAllocationInTheStep) {
  if (!AllocationCounter::available()) GTEST_SKIP() << "allocations are not counted in this build";
  Turmoil t(6), ahead(6);
  BallContacts copy = t.balls;
  std::size_t allocations = 0, contacts = 0;
  for (int step = 0; step < 200; ++step) {
    ahead.move();
    ahead.cut();
    VecArray at(ahead.x.size()), speeds(ahead.x.size());
    for (std::size_t i = 0; i < ahead.balls.nodes().size(); ++i) {
      at.set(i, ahead.x[ahead.balls.nodes()[i]]), speeds.set(i, ahead.v[ahead.balls.nodes()[i]]);
    }
    AllocationCounter counter;
    copy.update(ahead.last_cuts, ahead.labels, ahead.fragments);
    copy.find(at, speeds);
    for (std::size_t k = 0; k < copy.contact_count(); ++k) contacts += copy.contact(k).first < copy.contact(k).second;
    if (step == 100) copy.reset();
    allocations += counter.count();
  }
  EXPECT_EQ(allocations, 0u);
  EXPECT_GT(contacts, 1000u);
}

TEST(BallContacts, AllProcessorsComputeTheSame) {
  Random random(8);
  BallBlock one{};
  for (auto* row : {&one.stiffness, &one.reach, &one.x, &one.y, &one.z, &one.vx, &one.vy, &one.vz, &one.shear_x,
                    &one.shear_y, &one.shear_z}) {
    for (double& value : *row) value = random.below(20) == 0 ? 0 : random.uniform(-3, 3);
  }
  for (double& value : one.reach) value = 6 + value;
  for (double& value : one.stiffness) value = 3 + value;
  BallBlock other = one;
  baseline_ball_law()(one, BallBlock::kSize, {0.7, 0.5}, 0.1);
  ball_law()(other, BallBlock::kSize, {0.7, 0.5}, 0.1);
  EXPECT_EQ(std::memcmp(&one, &other, sizeof one), 0);
}

TEST(BallContacts, RefusesWithTheFieldsName) {
  const BruteBalls::Body good = Turmoil(1).body();
  const auto refusal = [&](const std::function<void(BruteBalls::Body&)>& spoil) -> std::string {
    BruteBalls::Body body = good;
    spoil(body);
    try {
      BallContacts balls(body.setup());
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refusal([](auto&) {}), "accepted");
  EXPECT_NE(refusal([](auto& b) { b.radii[3] = 0; }).find("balls.radii[3]"), std::string::npos);
  EXPECT_NE(refusal([](auto& b) { b.masses[2] = -1; }).find("balls.masses[2]"), std::string::npos);
  EXPECT_NE(refusal([](auto& b) { b.fixed.pop_back(); }).find("balls.fixed"), std::string::npos);
  EXPECT_NE(refusal([](auto& b) { b.stiffness_sums[1] = kInfinity; }).find("balls.stiffness_sums[1]"),
            std::string::npos);
  EXPECT_NE(refusal([](auto& b) { b.friction = {0.1, 0.2}; }).find("friction"), std::string::npos);
  EXPECT_NE(refusal([](auto& b) { b.tau = 0; }).find("balls.tau"), std::string::npos);
  EXPECT_NE(refusal([](auto& b) { b.springs[0] = {0, 5000}; }).find("springs[0]"), std::string::npos);
}

}  // namespace
}  // namespace crumble
