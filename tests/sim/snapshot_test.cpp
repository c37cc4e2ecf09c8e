#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <limits>

#include "crumble/base/file.hpp"
#include "crumble/base/hash.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/sim/recording.hpp"
#include "sim/press_rig.hpp"

namespace crumble {
namespace {

bool has_state(const Simulation& sim, ContactState state) {
  const auto contacts = sim.contacts();
  return std::any_of(contacts.begin(), contacts.end(), [&](const NodeConstraint& c) { return c.state == state; });
}

TEST(Snapshot, ContinuesWithTheSameHashesAfterCutsInContactWhileSticking) {
  for (const Preset preset : {Preset::standard, Preset::paper}) {
    PressRig rig("tofu_cube", preset, 0.01);
    rig.press_to(0.014);
    while (rig.sim.info().new_cuts == 0) rig.press();  // in the middle of a fade
    ASSERT_GT(rig.sim.counters().cuts, 20u);
    ASSERT_TRUE(has_state(rig.sim, ContactState::stick));
    ASSERT_TRUE(has_state(rig.sim, ContactState::slip));

    const auto bytes = rig.sim.snapshot();
    PressRig other("tofu_cube", preset, 0.01);
    other.press_to(0.003);
    other.sim.restore(bytes);
    EXPECT_EQ(other.sim.state_hash(), rig.sim.state_hash());
    EXPECT_EQ(other.sim.snapshot(), bytes);
    for (int step = 0; step < 600; ++step) {
      rig.press(), other.press();
      ASSERT_EQ(other.sim.state_hash(), rig.sim.state_hash()) << "step " << step;
    }
    EXPECT_EQ(other.sim.counters().cuts, rig.sim.counters().cuts);
  }
}

TEST(Snapshot, RestoringLeavesTheMeshWhereItIs) {
  PressRig rig;
  rig.press_to(0.001);
  const Vec3* positions = rig.sim.mesh().positions.data();
  const double* masses = rig.sim.network().masses.data();
  rig.sim.restore(rig.sim.snapshot());
  EXPECT_EQ(rig.sim.mesh().positions.data(), positions);
  EXPECT_EQ(rig.sim.network().masses.data(), masses);
}

TEST(Snapshot, ABadOneIsRefusedAndChangesNothing) {
  PressRig rig;
  rig.press_to(0.012);
  const auto good = rig.sim.snapshot();
  PressRig other;
  other.press_to(0.002);
  const std::uint64_t before = other.sim.state_hash();
  const auto refused = [&](Vector<std::uint8_t> bytes) {
    try {
      other.sim.restore(bytes);
    } catch (const Error& error) {
      EXPECT_EQ(other.sim.state_hash(), before);
      return error.code();
    }
    return Code{0};
  };
  for (std::size_t size = 0; size < good.size(); size += 97) {
    EXPECT_EQ(refused({good.begin(), good.begin() + static_cast<long>(size)}), Code::corrupt) << size;
  }
  for (std::size_t at = 16; at < good.size(); at += 1009) {
    auto damaged = good;
    damaged[at] ^= 0x10;
    EXPECT_EQ(refused(damaged), Code::corrupt) << at;
  }
  PressRig slab("tofu_slab");
  EXPECT_EQ(refused(slab.sim.snapshot()), Code::version);
  other.sim.restore(good);
  EXPECT_EQ(other.sim.state_hash(), rig.sim.state_hash());
}

// What a host indexes, shows or rounds must be possible even where the checksum is right.
TEST(Snapshot, OneThatIsWholeButImpossibleIsRefused) {
  PressRig rig;
  rig.press_to(0.014);
  while (rig.sim.info().new_cuts == 0) rig.press();
  const auto good = rig.sim.snapshot();
  const auto code_with = [&](std::size_t at, auto value) {
    auto bytes = good;
    std::memcpy(&bytes[at], &value, sizeof value);
    Hash hash;
    hash.add(std::span<const std::uint8_t>(bytes).first(bytes.size() - 8));
    const std::uint64_t sum = hash.value();
    std::memcpy(&bytes[bytes.size() - 8], &sum, sizeof sum);
    try {
      rig.sim.restore(bytes);
    } catch (const Error& error) {
      return error.code();
    }
    return Code{};
  };
  constexpr std::size_t kStatus = 16, kStep = 24, kTime = 32, kBadNode = 48;
  EXPECT_EQ(code_with(kStatus, std::int32_t{0}), Code{});
  EXPECT_EQ(code_with(kStatus, std::int32_t{-999}), Code::corrupt);
  EXPECT_EQ(code_with(kStep, rig.sim.info().step + 1), Code::corrupt);
  EXPECT_EQ(code_with(kStep, ~std::uint64_t{0}), Code::corrupt);
  for (const double time : {std::numeric_limits<double>::quiet_NaN(), 1e300, -1.0}) {
    EXPECT_EQ(code_with(kTime, time), Code::corrupt) << time;
  }
  EXPECT_EQ(code_with(kBadNode, static_cast<std::uint32_t>(rig.sim.mesh().node_count())), Code::corrupt);
  // Of an array, by its bytes. The last such: a list of springs may begin like that of the fading ones, which comes
  // before.
  const auto place_of = [&](const auto& values) {
    const auto* first = reinterpret_cast<const std::uint8_t*>(values.data());
    return static_cast<std::size_t>(std::find_end(good.begin(), good.end(), first, first + values.size_bytes()) -
                                    good.begin());
  };
  const std::size_t flags = place_of(rig.sim.intact());
  EXPECT_EQ(code_with(flags, std::uint8_t{2}), Code::corrupt);
  const std::uint64_t count = rig.sim.new_cuts().size();
  Vector<std::uint32_t> list{static_cast<std::uint32_t>(count), 0};  // its length, then the springs
  list.insert(list.end(), rig.sim.new_cuts().begin(), rig.sim.new_cuts().end());
  const std::size_t cuts = place_of(std::span<const std::uint32_t>(list)) + 8;
  EXPECT_EQ(code_with(cuts, static_cast<std::uint32_t>(rig.sim.intact().size())), Code::corrupt);
  EXPECT_EQ(code_with(cuts, rig.sim.new_cuts()[0]), Code{});
}

TEST(Reset, IsAFreshSimulation) {
  PressRig used, fresh;
  used.press_to(0.015);
  used.sim.reset();
  for (int step = 0; step < 1000; ++step) {
    used.press(), fresh.press();
    ASSERT_EQ(used.sim.state_hash(), fresh.sim.state_hash()) << step;
  }
}

class RecordingFile : public testing::Test {
 protected:
  std::filesystem::path path =
      std::filesystem::temp_directory_path() /
      ("crumble_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".crec");
  ~RecordingFile() override { std::filesystem::remove(path); }
};

TEST_F(RecordingFile, FromMidRunReplaysBitForBit) {
  PressRig rig("tofu_cube", Preset::standard, 0.02);
  rig.press_to(0.008);
  Recording recording(rig.sim);
  for (int step = 0; step < 400; ++step) {
    const Pose pose = rig.pose_at(rig.sim.info().step);
    rig.press();
    recording.add({&pose, 1}, rig.sim.state_hash());
  }
  recording.save(path);
  const Recording loaded = Recording::load(path);
  ASSERT_EQ(loaded.step_count(), 400u);
  Simulation again = loaded.start();
  EXPECT_FALSE(replay(loaded, again).has_value());
  EXPECT_EQ(again.state_hash(), rig.sim.state_hash());
}

TEST_F(RecordingFile, ADifferentStateIsFound) {
  PressRig rig;
  Recording recording(rig.sim);
  for (int step = 0; step < 200; ++step) {
    Pose pose = rig.pose_at(rig.sim.info().step);
    rig.press();
    if (step == 150) pose.position.y() += 1e-9;  // not what was done
    recording.add({&pose, 1}, rig.sim.state_hash());
  }
  Simulation again = recording.start();
  EXPECT_EQ(replay(recording, again), std::optional<std::size_t>(150));
}

TEST_F(RecordingFile, DamageIsRefusedWithItsName) {
  PressRig rig;
  Recording recording(rig.sim);
  for (int step = 0; step < 20; ++step) {
    const Pose pose = rig.pose_at(rig.sim.info().step);
    rig.press();
    recording.add({&pose, 1}, rig.sim.state_hash());
  }
  recording.save(path);
  const auto good = read_bytes(path);
  const auto code_of = [&](const Vector<std::uint8_t>& bytes) {
    write_bytes(path, bytes);
    try {
      Recording::load(path).start();
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("recording"), std::string::npos);
      return error.code();
    }
    return Code{0};
  };
  EXPECT_EQ(code_of(good), Code{0});
  EXPECT_EQ(code_of({}), Code::corrupt);
  for (std::size_t size = 1; size < good.size(); size += good.size() / 50) {
    EXPECT_EQ(code_of({good.begin(), good.begin() + static_cast<long>(size)}), Code::corrupt) << size;
  }
  auto other = good;
  other[0] ^= 1;
  EXPECT_EQ(code_of(other), Code::format);
  for (std::size_t at = 12; at < good.size(); at += 4001) {
    auto damaged = good;
    damaged[at] ^= 0x40;
    EXPECT_EQ(code_of(damaged), Code::corrupt) << at;
  }
}

}  // namespace
}  // namespace crumble
