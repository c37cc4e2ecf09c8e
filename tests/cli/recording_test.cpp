// `crumble replay`, on good recordings and on damaged ones.
#include "crumble/sim/recording.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "cli/recorded_press.hpp"
#include "crumble/base/file.hpp"
#include "crumble/base/hash.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/random.hpp"
#include "render/temporary_folder.hpp"

namespace crumble::cli {
namespace {

using nlohmann::json;
using render::TemporaryFolder;
using Bytes = Vector<std::uint8_t>;

constexpr std::size_t kStepBytes = 7 * 8;  // a pose
// The numbers of changes to fragments, forces, contact and definition, none; the checksum.
constexpr std::size_t kTail = 8 + 8 + 8 + 8 + 8;

class RecordingTest : public testing::Test {
 protected:
  void SetUp() override {
    const Simulation sim = record_press("tofu_slab", 0.015, recording);
    bytes = read_bytes(recording);
    hash = sim.state_hash();
    cuts = sim.counters().cuts;
  }
  // What `replay` says to a recording of these bytes.
  Outcome replay_of(const Bytes& damaged) {
    write_bytes(folder.file("damaged.crec"), damaged);
    return crumble({"replay", folder.file("damaged.crec").string()});
  }
  // The byte is at fault, not the checksum.
  static void repair_checksum(Bytes& damaged) {
    Hash hash;
    hash.add(std::span<const std::uint8_t>(damaged).first(damaged.size() - 8));
    const std::uint64_t value = hash.value();
    for (std::size_t i = 0; i < 8; ++i) damaged[damaged.size() - 8 + i] = static_cast<std::uint8_t>(value >> 8 * i);
  }
  // Where the pose of a step begins; the hashes and the tail stand behind the poses.
  std::size_t pose_at(std::size_t step) const {
    return bytes.size() - kTail - kSteps * 8 - (kSteps - step) * kStepBytes;
  }

  TemporaryFolder folder;
  const std::string recording = folder.file("good.crec").string();
  Bytes bytes;
  std::uint64_t hash = 0, cuts = 0;
};

TEST_F(RecordingTest, RunsAgainWithTheSameHashes) {
  const Outcome text = crumble({"replay", recording});
  EXPECT_EQ(text.code, 0) << text.err;
  EXPECT_NE(text.out.find("every state hash identical"), std::string::npos);
  const Outcome again = crumble({"replay", recording, "--json"});
  const json replayed = json::parse(again.out);
  EXPECT_EQ(replayed.at("steps"), kSteps);
  EXPECT_EQ(replayed.at("identical"), true);
  EXPECT_EQ(std::stoull(replayed.at("state_hash").get<std::string>(), nullptr, 16), hash);
  EXPECT_EQ(replayed.at("cuts"), cuts);
  EXPECT_EQ(replayed.at("precision"), "float64");
}

TEST_F(RecordingTest, RunsAgainWithEveryKernelAndNumberOfThreads) {
  for (const std::string& kernel : kernel_names()) {
    const Outcome outcome = crumble({"replay", recording, "--kernel", kernel, "--threads", "2", "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(json::parse(outcome.out).at("kernel"), kernel);
    EXPECT_EQ(json::parse(outcome.out).at("threads"), 2);
    EXPECT_EQ(json::parse(outcome.out).at("identical"), true);
  }
}

TEST_F(RecordingTest, IsRefusedWhenTruncatedOrDamaged) {
  Random random(1);
  for (const std::size_t size : {std::size_t{0}, std::size_t{5}, std::size_t{11}, std::size_t{19}, bytes.size() / 3,
                                 bytes.size() - 9, bytes.size() - 1}) {
    const Outcome outcome = replay_of({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)});
    EXPECT_EQ(outcome.code, 1) << size;
    EXPECT_NE(outcome.err.find("damaged.crec"), std::string::npos) << outcome.err;
  }
  for (int i = 0; i < 20; ++i) {
    Bytes damaged = bytes;
    damaged[random.below(bytes.size())] ^= static_cast<std::uint8_t>(1 + random.below(255));
    const Outcome outcome = replay_of(damaged);
    EXPECT_EQ(outcome.code, 1) << outcome.out;
    EXPECT_EQ(outcome.out, "");
    EXPECT_NE(outcome.err.find("damaged.crec"), std::string::npos) << outcome.err;
  }
}

TEST_F(RecordingTest, DiffersWhenAPoseWasChanged) {
  Bytes damaged = bytes;
  damaged[pose_at(400) + 8 + 5] ^= 1;  // high in the fraction of y, while the stick presses
  repair_checksum(damaged);
  const Outcome outcome = replay_of(damaged);
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.err.find("differs from the recorded one at step 400"), std::string::npos) << outcome.err;
  const Outcome told = crumble({"replay", folder.file("damaged.crec").string(), "--json"});
  EXPECT_EQ(told.code, 1);
  EXPECT_EQ(json::parse(told.out).at("identical"), false);
  EXPECT_EQ(json::parse(told.out).at("first_difference"), 400);
  // nor is a surface made of it
  const std::string ply = folder.file("surface.ply").string();
  EXPECT_EQ(crumble({"export", folder.file("damaged.crec").string(), "--at", "0.45", "--out", ply}).code, 1);
  EXPECT_FALSE(std::filesystem::exists(ply));
}

TEST_F(RecordingTest, DiffersWhenAHashWasChanged) {
  Bytes damaged = bytes;
  damaged[damaged.size() - kTail - 8 * 100] ^= 0x10;
  repair_checksum(damaged);
  const Outcome outcome = replay_of(damaged);
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.err.find("at step 401"), std::string::npos) << outcome.err;
}

// Neither a crash nor a claim that it is identical, whatever byte of the definition or the poses is wrong.
TEST_F(RecordingTest, IsNeverBelievedBlindly) {
  Random random(2);
  for (int i = 0; i < 40; ++i) {
    Bytes damaged = bytes;
    const std::size_t at = random.below(pose_at(0));
    damaged[at] ^= 0x80;
    repair_checksum(damaged);
    const Outcome outcome = replay_of(damaged);
    EXPECT_EQ(outcome.code, 1) << "byte " << at << ": " << outcome.out;
    EXPECT_NE(outcome.err, "");
  }
}

TEST_F(RecordingTest, IsRefusedWhenItIsNone) {
  const Outcome missing = crumble({"replay", folder.file("none.crec").string()});
  EXPECT_EQ(missing.code, 1);
  EXPECT_NE(missing.err.find("none.crec"), std::string::npos) << missing.err;
  const Outcome scene = crumble({"replay", CRUMBLE_SOURCE_DIR "/examples/scenes/tofu_cube.json"});
  EXPECT_EQ(scene.code, 1);
  EXPECT_NE(scene.err.find("is not a recording"), std::string::npos) << scene.err;
}

}  // namespace
}  // namespace crumble::cli
