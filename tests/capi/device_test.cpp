// Devices through C, against the same through C++.
#include <algorithm>
#include <cstring>
#include <filesystem>
#include <limits>

#include "capi/loop_rig.hpp"
#include "crumble/base/file.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/device/open.hpp"

namespace crumble {
namespace {

class Devices : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_OK(crumble_device_def_init(&def, sizeof def));
    def.start = {{0.01, 0.02, 0.03}, {0.8, 0, 0.6, 0}};
  }
  void TearDown() override { EXPECT_RESULT(CRUMBLE_OK, crumble_device_destroy(device)); }
  void open() { ASSERT_OK(crumble_device_open(&def, &device)); }
  crumble_device_sample read() {
    crumble_device_sample sample{};
    sample.struct_size = sizeof sample;
    EXPECT_RESULT(CRUMBLE_OK, crumble_device_read(device, &sample));
    return sample;
  }
  crumble_device_info info() {
    crumble_device_info out{};
    out.struct_size = sizeof out;
    EXPECT_RESULT(CRUMBLE_OK, crumble_device_get_info(device, &out));
    return out;
  }
  /// The same bits for `ticks` reads, each followed by a push.
  void expect_like(const DeviceDef& as, int ticks) {
    open();
    const std::unique_ptr<Device> other = open_device(as);
    EXPECT_EQ(info().name, other->info().name);
    EXPECT_EQ(info().kind, static_cast<std::uint32_t>(as.kind));
    EXPECT_EQ(info().flags, std::uint32_t{CRUMBLE_DEVICE_STEP_LOCKED});
    for (int k = 0; k < ticks; ++k) {
      DeviceSample expected;
      const ReadStatus status = other->read(expected);
      const crumble_device_sample got = read();
      ASSERT_EQ(got.status, static_cast<std::uint32_t>(status)) << k;
      ASSERT_EQ(got.time, expected.time);
      ASSERT_EQ(got.sequence, expected.sequence);
      ASSERT_EQ(got.flags, expected.flags);
      for (int axis = 0; axis < 3; ++axis) {
        ASSERT_EQ(got.pose.position[axis], expected.pose.position[axis]) << k;
        ASSERT_EQ(got.linear_velocity[axis], expected.linear_velocity[axis]) << k;
      }
      ASSERT_EQ(got.pose.orientation[2], expected.pose.orientation.y());
      const double force[3] = {0.1, 0.5, 0}, torque[3] = {0, 0, 0.01};
      ASSERT_OK(crumble_device_write(device, force, torque));
      other->write({0.1, 0.5, 0}, {0, 0, 0.01});
    }
  }
  void expect_bad(crumble_result expected, const Vector<std::string>& words) {
    crumble_device made = nullptr;
    expect_failure(expected, crumble_device_open(&def, &made), words);
    EXPECT_EQ(made, nullptr);
    ASSERT_OK(crumble_device_def_init(&def, sizeof def));
  }
  const Pose kStart{{0.01, 0.02, 0.03}, Quat(0.8, 0, 0.6, 0)};
  const std::string kTrajectory = std::string(CRUMBLE_SOURCE_DIR) + "/examples/trajectories/press_1mm_s.ctraj";
  crumble_device_def def{};
  crumble_device device = nullptr;
};

TEST_F(Devices, Null) {
  expect_like({.kind = DeviceKind::null, .rest = kStart}, 5);
}

TEST_F(Devices, Press) {
  def.kind = CRUMBLE_DEVICE_PRESS;
  def.tick = 2e-3;
  def.press_direction[0] = 1;
  def.press_speed = 0.1, def.press_depth = 0.01, def.press_hold = 0.02;
  expect_like({.kind = DeviceKind::press, .tick = 2e-3, .press = {kStart, {1, -1, 0}, 0.1, 0.01, 0.02}}, 100);
}

TEST_F(Devices, Path) {
  const crumble_motion_point points[] = {{0.01, {0, 0.1, 0}, {0, 0, 1}}, {0.03, {0.1, 0.1, 0}, {0, 2, 1}}};
  def.kind = CRUMBLE_DEVICE_PATH;
  def.points = points, def.point_count = 2;
  const PathOptions path{kStart, {{0.01, {0, 0.1, 0}, {0, 0, 1}}, {0.03, {0.1, 0.1, 0}, {0, 2, 1}}}};
  expect_like({.kind = DeviceKind::path, .path = path}, 40);
}

TEST_F(Devices, HandFeelsWhatIsWritten) {
  const crumble_motion_point points[] = {{0.05, {0, -0.01, 0}, {}}};
  def.kind = CRUMBLE_DEVICE_HAND;
  def.points = points, def.point_count = 1;
  def.hand_mass = 0.2, def.hand_stiffness = 80, def.hand_damping = 1, def.hand_friction = 0.01;
  def.hand_encoder_step = 1e-5, def.hand_delay = 2, def.hand_device_mass = 0.06;
  def.hand_max_force = 2, def.hand_max_stiffness = 900, def.hand_max_damping = 4;
  const HandOptions hand{kStart, {{0.05, {0, -0.01, 0}}}, 0.2, 80, 1, 0.01, 1e-5, 2, 0.06, 2, 900, 4};
  expect_like({.kind = DeviceKind::hand, .hand = hand}, 80);
  EXPECT_EQ(info().mass, 0.06);
  EXPECT_EQ(info().max_force, 2);
  EXPECT_EQ(info().max_stiffness, 900);
  EXPECT_EQ(info().max_damping, 4);
  EXPECT_EQ(info().position_step, 1e-5);
  EXPECT_GT(read().pose.position[0], 0.0101) << "pushed aside";
}

TEST_F(Devices, Replay) {
  def.kind = CRUMBLE_DEVICE_REPLAY;
  def.trajectory = kTrajectory.c_str();
  expect_like({.kind = DeviceKind::replay, .trajectory = kTrajectory}, 50);
}

TEST_F(Devices, ReplayOfAPartAgainAndAgain) {
  def.kind = CRUMBLE_DEVICE_REPLAY;
  def.trajectory = kTrajectory.c_str();
  def.replay_from = 0.1, def.replay_to = 0.13, def.replay_loop = 1;
  expect_like({.kind = DeviceKind::replay, .replay = {0.1, 0.13, EndPolicy::loop}, .trajectory = kTrajectory}, 100);
}

TEST_F(Devices, ReplayRowByRow) {
  def.kind = CRUMBLE_DEVICE_REPLAY;
  def.trajectory = kTrajectory.c_str();
  def.replay_clock = CRUMBLE_CLOCK_FAST;
  open();
  const std::unique_ptr<Device> other =
      open_device({.kind = DeviceKind::replay, .replay = {.clock = ReplayClock::fast}, .trajectory = kTrajectory});
  DeviceSample expected;
  for (int row = 0; row < 2; ++row) {
    EXPECT_EQ(other->read(expected), ReadStatus::ok);
    EXPECT_EQ(read().time, expected.time);
  }
}

TEST_F(Devices, Poke) {
  def.kind = CRUMBLE_DEVICE_POKE;
  def.press_direction[0] = 1;
  def.poke_depth = 0.02, def.poke_in = 0.03, def.poke_hold = 0.01, def.poke_out = 0.02, def.poke_rest = 0.04;
  def.poke_count = 2;
  expect_like({.kind = DeviceKind::poke, .poke = {kStart, {1, -1, 0}, 0.02, 0.03, 0.01, 0.02, 0.04, 2}}, 200);
}

TEST_F(Devices, Tremor) {
  def.kind = CRUMBLE_DEVICE_TREMOR;
  def.tremor_amplitude = 2e-4, def.tremor_low = 5, def.tremor_high = 20, def.seed = 7, def.seconds = 0.1;
  expect_like({.kind = DeviceKind::tremor, .tremor = {kStart, 2e-4, 5, 20, 7, 0.1}}, 200);
}

TEST_F(Devices, Wander) {
  def.kind = CRUMBLE_DEVICE_WANDER;
  def.wander_low[0] = -0.01, def.wander_high[2] = 0.03;
  def.wander_slowest = 0.1, def.wander_fastest = 0.2, def.wander_max_pause = 0.1, def.wander_max_turn = 1;
  def.seed = 1ull << 40, def.seconds = 2;
  const WanderOptions wander{kStart, {-0.01, -0.02, -0.02}, {0.02, 0.02, 0.03}, 0.1, 0.2, 0.1, 1, 1ull << 40, 2};
  expect_like({.kind = DeviceKind::wander, .wander = wander}, 3000);
}

TEST_F(Devices, WhatIsRecordedCanBeSavedAndPlayed) {
  const std::string path = (std::filesystem::temp_directory_path() / "crumble_recorded.ctraj").string();
  def.kind = CRUMBLE_DEVICE_TREMOR;
  open();
  expect_failure(CRUMBLE_E_STATE, crumble_device_save_trajectory(device, path.c_str()), {"record_capacity"});
  EXPECT_RESULT(CRUMBLE_OK, crumble_device_destroy(device));
  def.record_capacity = 20;
  open();
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_device_save_trajectory(device, nullptr));
  EXPECT_RESULT(CRUMBLE_E_EMPTY, crumble_device_save_trajectory(device, path.c_str()));
  const double force[3] = {1, 2, 3};
  double last = 0;
  for (int k = 0; k < 25; ++k) {
    const crumble_device_sample sample = read();
    if (k == 19) last = sample.pose.position[1];
    ASSERT_OK(crumble_device_write(device, force, nullptr));
  }
  ASSERT_OK(crumble_device_save_trajectory(device, path.c_str()));
  expect_failure(CRUMBLE_E_IO, crumble_device_save_trajectory(device, "/no/such/folder/a.ctraj"), {"/no/such/folder"});
  const Trajectory trajectory = read_trajectory(path);
  std::filesystem::remove(path);
  ASSERT_EQ(trajectory.rows.size(), 20u);
  EXPECT_EQ(trajectory.rows.back().pose.position.y(), last);
  EXPECT_EQ(trajectory.rows.back().force, Vec3(1, 2, 3));
  EXPECT_EQ(trajectory.value_of("dropped"), "5");
}

TEST_F(Devices, AnInverse3ThatIsNotThereIsRefusedInWords) {
  const auto kinds = available_devices();
  if (std::ranges::find(kinds, DeviceKind::inverse3) == kinds.end()) GTEST_SKIP() << "built without Boost.Beast";
  def.kind = CRUMBLE_DEVICE_INVERSE3;
  def.inverse3_host = "127.0.0.1";
  def.inverse3_port = 1;
  def.inverse3_timeout = 1;
  expect_bad(CRUMBLE_E_IO, {"127.0.0.1:1"});
  def.kind = CRUMBLE_DEVICE_INVERSE3;
  def.inverse3_port = 0;
  expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"port"});
  def.kind = CRUMBLE_DEVICE_INVERSE3;
  def.inverse3_timeout = kNan;
  expect_bad(CRUMBLE_E_INVALID_VALUE, {"timeout"});
}

TEST_F(Devices, TextIsEmptyWhereNothingIsWrong) {
  open();
  const char* text = nullptr;
  ASSERT_OK(crumble_device_get_text(device, &text));
  EXPECT_STREQ(text, "");
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_device_get_text(device, nullptr));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_device_get_text(nullptr, &text));
}

TEST_F(Devices, AttachedOnesAreCounted) {
  std::uint32_t count = 99;
  const crumble_result result = crumble_device_find_attached("/no/such/libHD.so", nullptr, 0, &count);
  EXPECT_EQ(result, count == 0 ? CRUMBLE_OK : CRUMBLE_E_BUFFER_TOO_SMALL) << "as many as are plugged in here";
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_device_find_attached(nullptr, nullptr, 0, nullptr));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_device_find_attached(nullptr, nullptr, 1, &count));
}

TEST_F(Devices, ALogOfHapiBecomesATrajectory) {
  const auto folder = std::filesystem::temp_directory_path();
  const std::string log = (folder / "crumble_hapi.log").string(), out = (folder / "crumble_hapi.ctraj").string();
  write_text(log, "TIME POSITION\n0 0 0 1000\n0.001 0 2 1000\n");
  ASSERT_OK(crumble_trajectory_import_hapi(log.c_str(), 1e-3, out.c_str()));
  const Trajectory trajectory = read_trajectory(out);
  ASSERT_EQ(trajectory.rows.size(), 2u);
  EXPECT_EQ(trajectory.rows[1].pose.position, Vec3(0, 0.002, 1));
  write_text(log, "TIME POSITION\n0 0 zero 1000\n");
  expect_failure(CRUMBLE_E_FORMAT, crumble_trajectory_import_hapi(log.c_str(), 1, out.c_str()), {"line 2", "zero"});
  EXPECT_RESULT(CRUMBLE_E_OUT_OF_RANGE, crumble_trajectory_import_hapi(log.c_str(), 0, out.c_str()));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_trajectory_import_hapi(nullptr, 1, out.c_str()));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_trajectory_import_hapi(log.c_str(), 1, nullptr));
  std::filesystem::remove(log), std::filesystem::remove(out);
}

TEST_F(Devices, KindsGoByName) {
  Vector<std::string> names;
  while (const char* name = crumble_device_kind_name(static_cast<std::uint32_t>(names.size()))) names.push_back(name);
  EXPECT_EQ(names, (Vector<std::string>{"null", "press", "replay", "phantom", "path", "hand", "poke", "tremor",
                                        "wander", "inverse3", "custom"}));
  EXPECT_EQ(crumble_device_kind_name(~0u), nullptr);
  std::uint32_t kind = 99;
  ASSERT_OK(crumble_device_kind("hand", &kind));
  EXPECT_EQ(kind, std::uint32_t{CRUMBLE_DEVICE_HAND});
  ASSERT_OK(crumble_device_kind("phantom", &kind));
  EXPECT_EQ(kind, std::uint32_t{CRUMBLE_DEVICE_PHANTOM});
  expect_failure(CRUMBLE_E_UNSUPPORTED, crumble_device_kind("Hand", &kind), {"'Hand'", "press", "hand"});
  EXPECT_EQ(kind, std::uint32_t{CRUMBLE_DEVICE_PHANTOM});
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_device_kind(nullptr, &kind));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_device_kind("hand", nullptr));
  def.kind = CRUMBLE_DEVICE_PHANTOM;
  def.phantom_library = "/no/such/libHD.so";
  expect_bad(CRUMBLE_E_UNSUPPORTED, {"crumble_device_open", "no HDAPI can be loaded", "/no/such/libHD.so"});
}

TEST_F(Devices, BadFieldsAreNamed) {
  const crumble_motion_point good[] = {{0.1, {0, 0, 0}, {}}};
  const crumble_motion_point backward[] = {{0.1, {0, 0, 0}, {}}, {0.1, {0, 0, 0}, {}}};
  def.kind = 11, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"kind", "11"});
  def.reserved2 = 1, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"reserved2"});
  def.replay_clock = 3, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"replay_clock", "3"});
  def.record_capacity = 10'000'001, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"record_capacity", "10000001"});
  def.inverse3_port = 65536, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"inverse3_port", "65536"});
  for (std::uint32_t crumble_device_def::*flag :
       {&crumble_device_def::phantom_torque, &crumble_device_def::phantom_reset_encoders,
        &crumble_device_def::phantom_keep_enabled}) {
    def.*flag = 2, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"phantom_", "2"});
  }
  def.kind = CRUMBLE_DEVICE_PHANTOM, def.phantom_rate = 10, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"phantom_rate", "10"});
  def.kind = CRUMBLE_DEVICE_POKE, def.poke_in = 0, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"poke_in"});
  def.kind = CRUMBLE_DEVICE_POKE, def.poke_count = 0, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"poke_count"});
  def.kind = CRUMBLE_DEVICE_TREMOR, def.tremor_high = kNan, expect_bad(CRUMBLE_E_INVALID_VALUE, {"tremor_high"});
  def.kind = CRUMBLE_DEVICE_WANDER, def.wander_low[1] = 1, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"wander_low"});
  def.reserved = 1, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"reserved"});
  def.replay_loop = 2, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"replay_loop", "2"});
  def.tick = 0, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"tick", "0"});
  def.tick = kNan, expect_bad(CRUMBLE_E_INVALID_VALUE, {"tick"});
  def.start.orientation[0] = 0, expect_bad(CRUMBLE_E_BAD_POSE, {"pose"});
  const auto press = [&] { def.kind = CRUMBLE_DEVICE_PRESS; };
  press(), def.press_speed = 0, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"press_speed"});
  press(), def.press_depth = kInfinity, expect_bad(CRUMBLE_E_INVALID_VALUE, {"press_depth"});
  press(), def.press_direction[1] = 0, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"press_direction"});
  press(), def.press_hold = -1, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"press_hold"});
  def.kind = CRUMBLE_DEVICE_PATH, expect_bad(CRUMBLE_E_EMPTY, {"points"});
  def.kind = CRUMBLE_DEVICE_PATH, def.point_count = 1, expect_bad(CRUMBLE_E_NULL, {"points"});
  def.kind = CRUMBLE_DEVICE_PATH, def.points = backward, def.point_count = 2;
  expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"points[1].time"});
  const auto hand = [&] { def.kind = CRUMBLE_DEVICE_HAND, def.points = good, def.point_count = 1; };
  hand(), def.hand_mass = 0, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"hand_mass"});
  hand(), def.hand_device_mass = 0.2, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"hand_device_mass"});
  hand(), def.hand_delay = 65, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"hand_delay"});
  hand(), def.hand_max_force = kNan, expect_bad(CRUMBLE_E_INVALID_VALUE, {"hand_max_force"});
}

TEST_F(Devices, BadTrajectoriesAreNamed) {
  const auto replay = [&](const char* path) { def.kind = CRUMBLE_DEVICE_REPLAY, def.trajectory = path; };
  replay(nullptr), expect_bad(CRUMBLE_E_NULL, {"trajectory"});
  replay("/nowhere/there.ctraj"), expect_bad(CRUMBLE_E_IO, {"/nowhere/there.ctraj"});
  const std::string text = std::string(CRUMBLE_SOURCE_DIR) + "/README.md";
  replay(text.c_str()), expect_bad(CRUMBLE_E_FORMAT, {"README.md"});
  replay(kTrajectory.c_str()), def.replay_from = -1, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"replay_from"});
  replay(kTrajectory.c_str()), def.replay_from = kNan, expect_bad(CRUMBLE_E_INVALID_VALUE, {"replay_from"});
  replay(kTrajectory.c_str()), def.replay_to = 1e9, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"replay_to"});
}

TEST_F(Devices, MisuseIsAnswered) {
  crumble_device_sample sample{};
  sample.struct_size = sizeof sample;
  crumble_device_info about{};
  const double force[3] = {0, 0, 0}, bad[3] = {0, kNan, 0};
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_device_open(nullptr, &device));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_device_open(&def, nullptr));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_device_read(nullptr, &sample));
  expect_failure(CRUMBLE_E_BAD_HANDLE, crumble_device_read(reinterpret_cast<crumble_device>(&sample), &sample),
                 {"crumble_device_read", "device"});
  open();
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_device_read(device, nullptr));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_device_write(device, nullptr, force));
  EXPECT_RESULT(CRUMBLE_OK, crumble_device_write(device, force, nullptr));
  expect_failure(CRUMBLE_E_INVALID_VALUE, crumble_device_write(device, bad, force), {"force.y"});
  expect_failure(CRUMBLE_E_INVALID_VALUE, crumble_device_write(device, force, bad), {"torque.y"});
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, crumble_device_get_info(device, &about));
  sample.struct_size = 0;
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, crumble_device_read(device, &sample));
  sample.struct_size = sizeof sample;
  EXPECT_EQ(read().sequence, 0u) << "calls that fail read nothing";
  const crumble_device gone = device;
  ASSERT_OK(crumble_device_destroy(device));
  device = nullptr;
  EXPECT_RESULT(CRUMBLE_E_STALE_HANDLE, crumble_device_read(gone, &sample));
  EXPECT_RESULT(CRUMBLE_E_STALE_HANDLE, crumble_device_destroy(gone));
  EXPECT_RESULT(CRUMBLE_OK, crumble_device_destroy(nullptr));
}

TEST_F(Devices, OlderAndNewerPrograms) {
  crumble_device_def older;
  std::memset(&older, 0xff, sizeof older);
  ASSERT_OK(crumble_device_def_init(&older, offsetof(crumble_device_def, press_speed)));
  older.kind = CRUMBLE_DEVICE_PRESS;
  ASSERT_OK(crumble_device_open(&older, &device));
  crumble_device_sample small;
  std::memset(&small, 0xee, sizeof small);
  small.struct_size = offsetof(crumble_device_sample, time);
  ASSERT_OK(crumble_device_read(device, &small));
  ASSERT_OK(crumble_device_read(device, &small));
  EXPECT_EQ(small.sequence, 1u);
  EXPECT_EQ(reinterpret_cast<unsigned char*>(&small)[offsetof(crumble_device_sample, time)], 0xee);
  EXPECT_EQ(read().linear_velocity[1], -1e-3) << "the default speed";

  struct {
    crumble_device_def def;
    double more;
  } newer;
  ASSERT_OK(crumble_device_def_init(&newer.def, sizeof newer));
  newer.more = 1;
  crumble_device made = nullptr;
  expect_failure(CRUMBLE_E_VERSION, crumble_device_open(&newer.def, &made), {"does not have"});
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, crumble_device_def_init(&def, 0));
  EXPECT_RESULT(CRUMBLE_E_VERSION, crumble_device_def_init(&def, 7));
  crumble_device_callbacks table{};
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, crumble_device_callbacks_init(&table, 0));
}

}  // namespace
}  // namespace crumble
