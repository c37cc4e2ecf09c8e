// Snapshots and recordings through C, and what damaged ones are answered.
#include <filesystem>

#include "capi/rig.hpp"
#include "crumble/base/file.hpp"
#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

class State : public CapiTest {
 protected:
  void SetUp() override {
    CapiTest::SetUp();
    const std::string test = testing::UnitTest::GetInstance()->current_test_info()->name();
    path = (std::filesystem::path(testing::TempDir()) / ("crumble_capi_" + test + ".rec")).string();
    std::filesystem::remove(path);
  }
  void TearDown() override {
    std::filesystem::remove(path);
    CapiTest::TearDown();
  }
  Vector<std::uint8_t> snapshot() {
    std::uint64_t needed = 0;
    EXPECT_RESULT(CRUMBLE_OK, crumble_sim_snapshot(sim, nullptr, 0, &needed));
    Vector<std::uint8_t> bytes(needed);
    EXPECT_RESULT(CRUMBLE_OK, crumble_sim_snapshot(sim, bytes.data(), needed, nullptr));
    return bytes;
  }
  void expect_verdict(crumble_result expected) {
    std::uint64_t steps = 77, equal = 77;
    expect_failure(expected, crumble_verify_recording(path.c_str(), &steps, &equal),
                   {"crumble_verify_recording", path});
    EXPECT_EQ(steps, 77u);
    EXPECT_EQ(equal, 77u);
  }
  void record(int first, int last) {
    ASSERT_OK(crumble_sim_begin_recording(sim));
    press(first, last);
    ASSERT_OK(crumble_sim_save_recording(sim, path.c_str()));
    ASSERT_OK(crumble_sim_end_recording(sim));
  }
  std::string path;
};

TEST_F(State, ARestoredSimulationGoesOnWithTheSameBits) {
  press(1, 250);
  ASSERT_GT(counters().cuts, 0u);
  ASSERT_GT(info().contacts, 0u);
  const Vector<std::uint8_t> saved = snapshot();
  press(251, 400);
  const std::uint64_t live = hash();
  const crumble_wrench live_wrench = wrench;

  ASSERT_OK(crumble_sim_restore(sim, saved.data(), saved.size()));
  EXPECT_EQ(info().step, 250u);
  EXPECT_NE(hash(), live);
  press(251, 400);
  EXPECT_EQ(hash(), live);
  EXPECT_EQ(wrench.force[1], live_wrench.force[1]);

  // another simulation of the same definition
  crumble_sim first = sim;
  sim = make_sim();
  ASSERT_OK(crumble_sim_restore(sim, saved.data(), saved.size()));
  press(251, 400);
  EXPECT_EQ(hash(), live);
  EXPECT_RESULT(CRUMBLE_OK, crumble_sim_destroy(first));
}

TEST_F(State, DamagedSnapshotsChangeNothing) {
  press(1, 250);
  const Vector<std::uint8_t> saved = snapshot();
  press(251, 260);
  const std::uint64_t before = hash();
  for (const std::size_t size : {std::size_t{0}, std::size_t{7}, std::size_t{40}, saved.size() - 1}) {
    EXPECT_RESULT(CRUMBLE_E_CORRUPT, crumble_sim_restore(sim, saved.data(), size));
  }
  for (std::size_t byte = 16; byte < saved.size(); byte += 997) {
    Vector<std::uint8_t> bad = saved;
    bad[byte] ^= 4;
    EXPECT_RESULT(CRUMBLE_E_CORRUPT, crumble_sim_restore(sim, bad.data(), bad.size()));
  }
  EXPECT_EQ(hash(), before);
  std::uint64_t needed = 0;
  Vector<std::uint8_t> small(100, 0xab);
  EXPECT_RESULT(CRUMBLE_E_BUFFER_TOO_SMALL, crumble_sim_snapshot(sim, small.data(), small.size(), &needed));
  EXPECT_EQ(needed, snapshot().size());
  EXPECT_EQ(small, Vector<std::uint8_t>(100, 0xab));

  ASSERT_OK(crumble_sim_reset(sim));
  def.mass = 0.031;
  ASSERT_OK(crumble_sim_configure(sim, &def));
  expect_failure(CRUMBLE_E_VERSION, crumble_sim_restore(sim, saved.data(), saved.size()), {"definition"});
}

TEST_F(State, ResetGoesBackToTheStart) {
  const std::uint64_t start = hash();
  press(1, 300);
  const std::uint64_t end = hash();
  ASSERT_OK(crumble_sim_reset(sim));
  EXPECT_EQ(hash(), start);
  EXPECT_EQ(info().step, 0u);
  EXPECT_EQ(counters().cuts, 0u);
  press(1, 300);
  EXPECT_EQ(hash(), end);
}

TEST_F(State, ARecordingRunsAgain) {
  press(1, 100);
  record(101, 300);
  std::uint64_t steps = 0, equal = 0;
  ASSERT_OK(crumble_verify_recording(path.c_str(), &steps, &equal));
  EXPECT_EQ(steps, 200u);
  EXPECT_EQ(equal, 200u);
}

TEST_F(State, ARecordingKnowsItsStates) {
  const crumble_pose bad{{kNan, 0, 0}, {1, 0, 0, 0}};
  ASSERT_OK(crumble_sim_begin_recording(sim));
  press(1, 20);
  EXPECT_RESULT(CRUMBLE_E_BAD_POSE, crumble_sim_step(sim, &bad, &wrench));  // moves nothing, is not recorded
  press(21, 30);
  EXPECT_RESULT(CRUMBLE_E_STATE, crumble_sim_begin_recording(sim));
  EXPECT_RESULT(CRUMBLE_E_STATE, crumble_sim_reset(sim));
  EXPECT_RESULT(CRUMBLE_E_STATE, crumble_sim_restore(sim, &bad, sizeof bad));
  ASSERT_OK(crumble_sim_save_recording(sim, path.c_str()));
  ASSERT_OK(crumble_sim_end_recording(sim));
  EXPECT_RESULT(CRUMBLE_E_STATE, crumble_sim_end_recording(sim));
  EXPECT_RESULT(CRUMBLE_E_STATE, crumble_sim_save_recording(sim, path.c_str()));
  std::uint64_t steps = 0, equal = 0;
  ASSERT_OK(crumble_verify_recording(path.c_str(), &steps, &equal));
  EXPECT_EQ(steps, 30u);
  EXPECT_EQ(equal, 30u);

  ASSERT_OK(crumble_sim_reset(sim));
  ASSERT_OK(crumble_sim_begin_recording(sim));
  EXPECT_RESULT(CRUMBLE_E_STATE, crumble_sim_add_tool(sim, &tool, nullptr)) << "a recording begins with its tools";
  EXPECT_RESULT(CRUMBLE_E_IO, crumble_sim_save_recording(sim, "/no/such/folder/x.rec"));
}

TEST_F(State, DamagedRecordingsAreToldApart) {
  record(1, 30);
  const Vector<std::uint8_t> good = read_bytes(path);
  std::filesystem::remove(path);
  expect_verdict(CRUMBLE_E_IO);
  const auto expect_bytes = [&](crumble_result expected, Vector<std::uint8_t> bytes) {
    write_bytes(path, bytes);
    expect_verdict(expected);
  };
  expect_bytes(CRUMBLE_E_CORRUPT, {});
  for (std::size_t size = 12; size < good.size(); size += good.size() / 7) {
    expect_bytes(CRUMBLE_E_CORRUPT, {good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)});
  }
  for (std::size_t byte = 12; byte < good.size(); byte += good.size() / 23) {
    Vector<std::uint8_t> bad = good;
    bad[byte] ^= 1;
    expect_bytes(CRUMBLE_E_CORRUPT, bad);
  }
  Vector<std::uint8_t> bad = good;
  bad[0] ^= 1;
  expect_bytes(CRUMBLE_E_FORMAT, bad);
  bad = good;
  bad[8] = 200;
  expect_bytes(CRUMBLE_E_VERSION, bad);
}

}  // namespace
}  // namespace crumble
