// `crumble replay` and `crumble export`, on good recordings and on damaged ones.
#include "crumble/sim/recording.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "cli/ply.hpp"
#include "crumble/base/file.hpp"
#include "crumble/base/hash.hpp"
#include "crumble/base/random.hpp"
#include "render/temporary_folder.hpp"
#include "scenes/scene.hpp"

namespace crumble::cli {
namespace {

using nlohmann::json;
using render::TemporaryFolder;
using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kSteps = 501;
constexpr std::size_t kStepBytes = 7 * 8;  // a pose

// Half a second of a fast press on the slab, in which springs are cut.
class RecordingTest : public testing::Test {
 protected:
  void SetUp() override {
    const Scene scene = load_scene("tofu_slab", Preset::standard);
    PressOptions press = scene.press;
    press.speed = 0.015;
    const auto device = open_press(press, scene.def.step.tau);
    Simulation sim(scene.def);
    Recording made(sim);
    DeviceSample sample;
    for (std::size_t step = 0; step < kSteps; ++step) {
      ASSERT_NE(device->read(sample), ReadStatus::lost);
      sim.step({&sample.pose, 1});
      made.add({&sample.pose, 1}, sim.state_hash());
    }
    made.save(recording);
    bytes = read_bytes(recording);
    hash = sim.state_hash();
    cuts = sim.counters().cuts;
    ASSERT_GT(cuts, 10u);
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
  // Where the pose of a step begins; the hashes and the checksum stand behind the poses.
  std::size_t pose_at(std::size_t step) const { return bytes.size() - 16 - kSteps * 8 - (kSteps - step) * kStepBytes; }

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
  damaged[damaged.size() - 16 - 8 * 100] ^= 0x10;
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

TEST_F(RecordingTest, GivesItsSurfaceAtAnyTime) {
  for (const char* name : {"rest.ply", "late.ply"}) {
    const bool rest = std::string(name) == "rest.ply";
    const std::string path = folder.file(name).string();
    const Outcome outcome = crumble({"export", recording, "--at", rest ? "0" : "0.5", "--out", path});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const PlyFile surface = read_ply(path);
    EXPECT_EQ(surface.unmatched_edges, 0u);
    EXPECT_EQ(surface.vertices == 382, rest) << "cut faces have vertices of their own";
    EXPECT_NEAR(surface.volume, 9e-6, rest ? 1e-8 : 5e-6);
  }
  for (const char* extension : {".obj", ".stl", ".glb"}) {
    const std::string path = folder.file("surface").string() + extension;
    EXPECT_EQ(crumble({"export", recording, "--at", "0.2", "--out", path}).code, 0);
    EXPECT_GT(std::filesystem::file_size(path), 1000u);
  }
}

TEST_F(RecordingTest, RefusesTimesAndNamesThatItDoesNotHave) {
  const std::string ply = folder.file("surface.ply").string();
  const std::vector<std::vector<std::string>> refused{
      {"--at must lie in [0, 0.501], is 0.6", "export", recording, "--at", "0.6", "--out", ply},
      {"--at must lie in [0, 0.501], is -0.1", "export", recording, "--at", "-0.1", "--out", ply},
      {"--at must be finite, is nan", "export", recording, "--at", "nan", "--out", ply},
      {"surface.xyz' must end in one of .glb .obj .ply .stl", "export", recording, "--at", "0.1", "--out",
       folder.file("surface.xyz").string()},
      {"must end in one of", "export", recording, "--at", "0.1", "--out", folder.file("surface").string()},
      {"none/surface.ply", "export", recording, "--at", "0.1", "--out", folder.file("none/surface.ply").string()},
      {"none.crec", "export", folder.file("none.crec").string(), "--at", "0.1", "--out", ply},
      {"none.crec", "replay", folder.file("none.crec").string()},
      {"is not a recording", "replay", CRUMBLE_SOURCE_DIR "/examples/scenes/tofu_cube.json"},
  };
  for (const std::vector<std::string>& row : refused) {
    const Outcome outcome = crumble({row.begin() + 1, row.end()});
    EXPECT_EQ(outcome.code, 1) << row[0];
    EXPECT_NE(outcome.err.find(row[0]), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(folder.size(), 1u) << "nothing half-written";
}

}  // namespace
}  // namespace crumble::cli
