// Devices and a loop through C, over the cube of rig.hpp.
#pragma once

#include <atomic>

#include "capi/rig.hpp"

namespace crumble {

/// A custom device that tells what the test wants and keeps what it is sent.
struct Strings {
  crumble_device_callbacks callbacks() {
    crumble_device_callbacks table{};
    EXPECT_RESULT(CRUMBLE_OK, crumble_device_callbacks_init(&table, sizeof table));
    table.user = this;
    table.read = [](crumble_device_sample* sample, void* user) { return static_cast<Strings*>(user)->read(*sample); };
    table.write = [](const double* force, const double* torque, void* user) {
      return static_cast<Strings*>(user)->write(force, torque);
    };
    table.name = "strings";
    table.mass = 0.075;
    table.max_force = 3.3;
    return table;
  }
  crumble_device open() { return open(callbacks()); }
  static crumble_device open(const crumble_device_callbacks& table) {
    crumble_device_def def{};
    EXPECT_RESULT(CRUMBLE_OK, crumble_device_def_init(&def, sizeof def));
    def.kind = CRUMBLE_DEVICE_CUSTOM;
    def.callbacks = &table;
    crumble_device device = nullptr;
    EXPECT_RESULT(CRUMBLE_OK, crumble_device_open(&def, &device)) << crumble_last_error();
    return device;
  }

  crumble_result read(crumble_device_sample& sample) {
    const std::uint64_t now = reads++;
    if (now >= fails_at) return answer;
    sample.status = status;
    sample.time = 1e-3 * static_cast<double>(now);
    sample.pose.position[1] = height;
    sample.buttons = buttons;
    return CRUMBLE_OK;
  }
  crumble_result write(const double* force, const double*) {
    ++writes;
    last_force = force[1];
    if (force[0] != 0 || force[1] != 0 || force[2] != 0) ++pushes;
    return write_answer;
  }

  // told; device frame
  std::atomic<double> height = 0.002;
  std::atomic<std::uint32_t> status = CRUMBLE_READ_OK, buttons = 0;
  std::atomic<std::uint64_t> fails_at = ~std::uint64_t{0};  // read
  std::atomic<crumble_result> answer = CRUMBLE_E_IO, write_answer = CRUMBLE_OK;
  // kept
  std::atomic<std::uint64_t> reads = 0, writes = 0, pushes = 0;
  std::atomic<double> last_force = 0;
};

class LoopTest : public CapiTest {
 protected:
  void SetUp() override {
    CapiTest::SetUp();
    ASSERT_OK(crumble_loop_def_init(&loop_def, sizeof loop_def));
    loop_def.driver = CRUMBLE_DRIVER_HOST;
    ASSERT_OK(crumble_hand_def_init(&hand_def, sizeof hand_def));
    hand_def.workspace.position[1] = 0.034;  // the device's origin: touching
  }
  void TearDown() override {
    close();
    CapiTest::TearDown();
  }
  /// Before a device of the test's own goes, which is told to rest once more.
  void close() {
    EXPECT_RESULT(CRUMBLE_OK, crumble_loop_destroy(loop));
    EXPECT_RESULT(CRUMBLE_OK, crumble_device_destroy(device));
    loop = nullptr, device = nullptr;
  }
  /// A hand that waits above the body and then goes 6 mm into it.
  crumble_device_def pressing_hand() {
    crumble_device_def out{};
    EXPECT_RESULT(CRUMBLE_OK, crumble_device_def_init(&out, sizeof out));
    out.kind = CRUMBLE_DEVICE_HAND;
    out.start.position[1] = 0.002;
    out.points = kPoints;
    out.point_count = std::size(kPoints);
    return out;
  }
  void make_loop(crumble_device with) {
    device = with;
    hand_def.device = device;
    ASSERT_OK(crumble_loop_create(sim, &loop_def, &hand_def, 1, &loop));
  }
  void tick(int times = 1) {
    for (int i = 0; i < times; ++i) ASSERT_OK(crumble_loop_tick(loop));
  }
  crumble_hand_status hand(std::uint32_t index = 0) {
    crumble_hand_status out{};
    out.struct_size = sizeof out;
    EXPECT_RESULT(CRUMBLE_OK, crumble_loop_get_hand(loop, index, &out));
    return out;
  }
  crumble_loop_status status() {
    crumble_loop_status out{};
    out.struct_size = sizeof out;
    EXPECT_RESULT(CRUMBLE_OK, crumble_loop_get_status(loop, &out));
    return out;
  }
  bool running() {
    std::uint32_t out = 9;
    EXPECT_RESULT(CRUMBLE_OK, crumble_loop_is_running(loop, &out));
    return out == 1;
  }
  /// Ticks until the whole force is let in, then puts the hand 3 mm into the body.
  void press() {
    tick(800);
    ASSERT_EQ(hand().state, std::uint32_t{CRUMBLE_HAND_RUNNING});
    for (int i = 0; i < 500; ++i) {
      strings.height = 0.002 - 1e-5 * i;
      tick();
    }
    ASSERT_GT(strings.last_force, 0.05);
  }

  static constexpr crumble_motion_point kPoints[] = {{0.7, {0, 0, 0}, {}}, {1.2, {0, -0.008, 0}, {}}};
  crumble_loop_def loop_def{};
  crumble_hand_def hand_def{};
  Strings strings;  // outlives the loop
  crumble_device device = nullptr;
  crumble_loop loop = nullptr;
};

}  // namespace crumble
