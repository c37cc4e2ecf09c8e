// Loops that cannot be: which code, which field in the text, and nothing made.
#include <cstring>

#include "capi/loop_rig.hpp"
#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

class LoopMisuse : public LoopTest {
 protected:
  void SetUp() override {
    LoopTest::SetUp();
    hand_def.device = device = strings.open();
    good_loop = loop_def, good_hand = hand_def;
  }
  void expect_bad(crumble_result expected, const Vector<std::string>& words) {
    crumble_loop made = nullptr;
    expect_failure(expected, crumble_loop_create(sim, &loop_def, &hand_def, 1, &made), words);
    EXPECT_EQ(made, nullptr);
    loop_def = good_loop, hand_def = good_hand;
    ASSERT_OK(crumble_sim_fix_below(sim, 1e-6)) << "no loop has it";
  }
  crumble_loop_def good_loop{};
  crumble_hand_def good_hand{};
};

TEST_F(LoopMisuse, BadLoopFieldsAreNamed) {
  loop_def.coupling = 3, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"crumble_loop_create", "coupling", "3"});
  loop_def.driver = 4, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"driver", "4"});
  loop_def.body_thread = 2, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"body_thread", "2"});
  loop_def.watchdog = 2, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"watchdog", "2"});
  loop_def.lock_memory = 2, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"lock_memory", "2"});
  loop_def.priority = -1, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"priority", "-1"});
  loop_def.priority = 100, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"priority", "100"});
  loop_def.processor = -2, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"processor", "-2"});
  loop_def.reserved = 1, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"reserved", "1"});
  loop_def.tick = kNan, expect_bad(CRUMBLE_E_INVALID_VALUE, {"tick"});
  loop_def.tick = 0.02, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"tick", "0.02"});
  loop_def.tick = 0.002, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"0.002", "0.001"});  // not the simulation's tau
  loop_def.body_ticks = 0, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"body_ticks", "0"});
  loop_def.body_ticks = 2, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"body_ticks", "2"});  // direct
  loop_def.body_thread = 1, expect_bad(CRUMBLE_E_STATE, {"body_thread"});
  loop_def.driver = CRUMBLE_DRIVER_DEVICE, expect_bad(CRUMBLE_E_UNSUPPORTED, {"driver"});
}

TEST_F(LoopMisuse, BadHandFieldsAreNamed) {
  const struct {
    double crumble_hand_def::*field;
    const char* name;
  } fields[] = {{&crumble_hand_def::workspace_scale, "workspace_scale"},
                {&crumble_hand_def::force_gain, "force_gain"},
                {&crumble_hand_def::coupling_stiffness, "coupling_stiffness"},
                {&crumble_hand_def::delay, "delay"},
                {&crumble_hand_def::max_damping, "max_damping"},
                {&crumble_hand_def::energy_credit, "energy_credit"},
                {&crumble_hand_def::max_force, "max_force"},
                {&crumble_hand_def::max_torque, "max_torque"},
                {&crumble_hand_def::max_speed, "max_speed"},
                {&crumble_hand_def::max_jump, "max_jump"},
                {&crumble_hand_def::max_slew, "max_slew"},
                {&crumble_hand_def::ramp_time, "ramp_time"},
                {&crumble_hand_def::workspace_margin, "workspace_margin"}};
  for (const auto& [field, name] : fields) {
    hand_def.*field = kNan, expect_bad(CRUMBLE_E_INVALID_VALUE, {"hands[0]", name});
    hand_def.*field = -1, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"hands[0]", name, "-1"});
  }
  hand_def.tool = 1, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"hands[0]", "1"});
  hand_def.coupling = 2, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"hands[0].coupling", "2"});
  hand_def.inject_damping = 2, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"hands[0].inject_damping"});
  hand_def.controller = 2, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"hands[0].controller"});
  hand_def.reserved = 2, expect_bad(CRUMBLE_E_OUT_OF_RANGE, {"hands[0].reserved"});
  hand_def.workspace.position[0] = kNan, expect_bad(CRUMBLE_E_BAD_POSE, {"hands[0]", "workspace must"});
  hand_def.workspace_mount[0] = 0, expect_bad(CRUMBLE_E_BAD_POSE, {"hands[0]", "workspace_mount"});
}

TEST_F(LoopMisuse, BadDevicesAreNamed) {
  hand_def.device = nullptr, expect_bad(CRUMBLE_E_NULL, {"hands[0].device must not be NULL"});
  hand_def.device = reinterpret_cast<crumble_device>(sim), expect_bad(CRUMBLE_E_BAD_HANDLE, {"hands[0].device"});
  Strings other;
  const crumble_device gone = other.open();
  ASSERT_OK(crumble_device_destroy(gone));
  hand_def.device = gone, expect_bad(CRUMBLE_E_STALE_HANDLE, {"hands[0].device has been destroyed"});
}

TEST_F(LoopMisuse, HandsMustBeSomeFewAndDistinct) {
  Vector<crumble_hand_def> hands(5, hand_def);
  crumble_loop made = nullptr;
  EXPECT_RESULT(CRUMBLE_E_EMPTY, crumble_loop_create(sim, &loop_def, nullptr, 0, &made));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_loop_create(sim, &loop_def, nullptr, 1, &made));
  expect_failure(CRUMBLE_E_TOO_LARGE, crumble_loop_create(sim, &loop_def, hands.data(), 5, &made), {"hand_count", "5"});
  expect_failure(CRUMBLE_E_STATE, crumble_loop_create(sim, &loop_def, hands.data(), 2, &made), {"hands[1]"});
  ASSERT_OK(crumble_sim_add_tool(sim, &tool, nullptr));
  hands[1].tool = 1;
  expect_failure(CRUMBLE_E_STATE, crumble_loop_create(sim, &loop_def, hands.data(), 2, &made), {"hands[1]", "device"});
  hands[1].struct_size -= 8;
  expect_failure(CRUMBLE_E_VERSION, crumble_loop_create(sim, &loop_def, hands.data(), 2, &made), {"hands[1]"});
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_loop_create(sim, &loop_def, &hand_def, 1, nullptr));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_loop_create(nullptr, &loop_def, &hand_def, 1, &made));
  EXPECT_EQ(made, nullptr);
}

TEST_F(LoopMisuse, WhatALoopNeedsCannotGoOrChange) {
  ASSERT_OK(crumble_loop_create(sim, &loop_def, &hand_def, 1, &loop));
  expect_failure(CRUMBLE_E_IN_USE, crumble_device_destroy(device), {"crumble_device_destroy", "1 loops"});
  expect_failure(CRUMBLE_E_IN_USE, crumble_sim_destroy(sim), {"crumble_sim_destroy", "loop"});
  expect_failure(CRUMBLE_E_IN_USE, crumble_sim_add_tool(sim, &tool, nullptr), {"crumble_sim_add_tool", "loop"});
  EXPECT_RESULT(CRUMBLE_E_STATE, crumble_sim_apply_paper_preset(sim)) << "another tau";
  const crumble_pose pose = pose_at(0);
  EXPECT_RESULT(CRUMBLE_OK, crumble_sim_step(sim, &pose, &wrench)) << "but it may be stepped, and reset";
  EXPECT_RESULT(CRUMBLE_OK, crumble_sim_reset(sim));
  ASSERT_OK(crumble_loop_destroy(loop));
  loop = nullptr;
  EXPECT_RESULT(CRUMBLE_OK, crumble_sim_add_tool(sim, &tool, nullptr));
}

TEST_F(LoopMisuse, HandlesAndNumbers) {
  crumble_loop_status out{};
  out.struct_size = sizeof out;
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_loop_start(nullptr));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_loop_get_status(nullptr, &out));
  EXPECT_RESULT(CRUMBLE_E_BAD_HANDLE, crumble_loop_halt(reinterpret_cast<crumble_loop>(device)));
  EXPECT_RESULT(CRUMBLE_E_BAD_HANDLE, crumble_loop_stop(reinterpret_cast<crumble_loop>(&out)));
  ASSERT_OK(crumble_loop_create(sim, &loop_def, &hand_def, 1, &loop));
  crumble_hand_status status_of_hand{};
  status_of_hand.struct_size = sizeof status_of_hand;
  expect_failure(CRUMBLE_E_OUT_OF_RANGE, crumble_loop_get_hand(loop, 1, &status_of_hand), {"hand is 1"});
  EXPECT_RESULT(CRUMBLE_E_OUT_OF_RANGE, crumble_loop_reset_fault(loop, 1));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_loop_get_hand(loop, 0, nullptr));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_loop_get_status(loop, nullptr));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_loop_is_running(loop, nullptr));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_loop_get_times(loop, nullptr));
  const crumble_loop gone = loop;
  ASSERT_OK(crumble_loop_destroy(loop));
  loop = nullptr;
  EXPECT_RESULT(CRUMBLE_E_STALE_HANDLE, crumble_loop_destroy(gone));
  EXPECT_RESULT(CRUMBLE_E_STALE_HANDLE, crumble_loop_get_status(gone, &out));
  EXPECT_RESULT(CRUMBLE_E_STALE_HANDLE, crumble_loop_tick(gone));
  EXPECT_RESULT(CRUMBLE_OK, crumble_loop_destroy(nullptr));
}

TEST_F(LoopMisuse, ABodysThreadMustBeStarted) {
  loop_def.coupling = CRUMBLE_COUPLING_LOCAL_MODEL;
  loop_def.body_thread = 1;
  ASSERT_OK(crumble_loop_create(sim, &loop_def, &hand_def, 1, &loop));
  expect_failure(CRUMBLE_E_STATE, crumble_loop_tick(loop), {"crumble_loop_tick", "body_thread"});
  ASSERT_OK(crumble_loop_start(loop));
  EXPECT_RESULT(CRUMBLE_OK, crumble_loop_tick(loop));
  ASSERT_OK(crumble_loop_stop(loop));
}

TEST_F(LoopMisuse, TextsComeIntoBuffers) {
  hand_def.coupling = 0;  // for a warning
  ASSERT_OK(crumble_loop_create(sim, &loop_def, &hand_def, 1, &loop));
  ASSERT_EQ(status().warning_count, 1u);
  std::uint64_t needed = 0;
  ASSERT_OK(crumble_loop_get_warning(loop, 0, nullptr, 0, &needed));
  Vector<char> text(needed, '?');
  EXPECT_RESULT(CRUMBLE_E_BUFFER_TOO_SMALL, crumble_loop_get_warning(loop, 0, text.data(), needed - 1, nullptr));
  EXPECT_EQ(text[0], '?');
  ASSERT_OK(crumble_loop_get_warning(loop, 0, text.data(), needed, nullptr));
  EXPECT_EQ(std::strlen(text.data()), needed - 1);
  EXPECT_NE(std::string(text.data()).find("without the virtual coupling"), std::string::npos);
  EXPECT_RESULT(CRUMBLE_E_OUT_OF_RANGE, crumble_loop_get_warning(loop, 1, nullptr, 0, &needed));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_loop_get_scheduling(loop, nullptr, 0, nullptr));
  ASSERT_OK(crumble_loop_get_scheduling(loop, text.data(), text.size(), &needed));
  EXPECT_EQ(needed, 1u);
  EXPECT_STREQ(text.data(), "");
  ASSERT_OK(crumble_loop_destroy(loop));
  loop_def.driver = CRUMBLE_DRIVER_OWN_THREAD;
  ASSERT_OK(crumble_loop_create(sim, &loop_def, &hand_def, 1, &loop));
  ASSERT_OK(crumble_loop_start(loop));
  text.assign(200, 0);
  ASSERT_OK(crumble_loop_get_scheduling(loop, text.data(), text.size(), nullptr));
  EXPECT_NE(std::string(text.data()), "") << "SCHED_FIFO 80, or why not";
  ASSERT_OK(crumble_loop_stop(loop));
}

TEST_F(LoopMisuse, FaultsHaveNamesAndReasons) {
  EXPECT_STREQ(crumble_fault_name(CRUMBLE_FAULT_NONE), "none");
  EXPECT_STREQ(crumble_fault_name(CRUMBLE_FAULT_STALLED), "stalled");
  EXPECT_STREQ(crumble_fault_name(10), "unknown");
  EXPECT_STREQ(crumble_fault_name(~0u), "unknown");
  for (std::uint32_t fault = 0; fault <= CRUMBLE_FAULT_DRIVER; ++fault) {
    EXPECT_NE(std::string(crumble_fault_reason(fault)), crumble_fault_reason(10)) << fault;
  }
}

// An array of hands of a program whose struct ends behind `coupling_stiffness`, and of one whose struct is longer.
TEST_F(LoopMisuse, OlderAndNewerPrograms) {
  Strings other;
  ASSERT_OK(crumble_sim_add_tool(sim, &tool, nullptr));
  const crumble_device second = other.open();
  const auto expect_two = [&](std::uint32_t size) {
    Vector<char> bytes(2 * size, '\xff');
    const auto at = [&](int i) { return reinterpret_cast<crumble_hand_def*>(bytes.data() + i * size); };
    for (int i = 0; i < 2; ++i) {
      ASSERT_OK(crumble_hand_def_init(at(i), size));
      at(i)->device = i == 0 ? device : second;
      at(i)->tool = static_cast<std::uint32_t>(i);
      at(i)->workspace.position[1] = 0.04 + 0.1 * i;
    }
    ASSERT_OK(crumble_loop_apply_paper_preset(&loop_def, at(0), 2));
    EXPECT_EQ(at(1)->struct_size, size);
    EXPECT_EQ(at(1)->coupling, 0u);
    ASSERT_OK(crumble_loop_create(sim, &loop_def, at(0), 2, &loop));
    tick(2);
    EXPECT_NEAR(hand(0).tool_pose.position[1], 0.042, 1e-12);
    EXPECT_NEAR(hand(1).tool_pose.position[1], 0.142, 1e-12);
    ASSERT_OK(crumble_loop_destroy(loop));
    loop = nullptr;
  };
  expect_two(offsetof(crumble_hand_def, inject_damping));
  expect_two(sizeof(crumble_hand_def) + 16);
  ASSERT_OK(crumble_device_destroy(second));

  crumble_loop_status small;
  std::memset(&small, 0xee, sizeof small);
  small.struct_size = offsetof(crumble_loop_status, steps);
  ASSERT_OK(crumble_loop_create(sim, nullptr, &hand_def, 1, &loop)) << "defaults";
  ASSERT_OK(crumble_loop_get_status(loop, &small));
  EXPECT_EQ(small.ticks, 0u);
  EXPECT_EQ(small.steps, 0xeeeeeeeeeeeeeeeeu);
}

TEST_F(LoopMisuse, AForgottenSizeIsToldApart) {
  crumble_loop_def no_loop{};
  crumble_hand_def no_hand{};
  crumble_loop_status no_status{};
  crumble_hand_status no_hand_status{};
  crumble_loop_times no_times{};
  crumble_loop made = nullptr;
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, crumble_loop_def_init(&no_loop, 0));
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, crumble_hand_def_init(&no_hand, 0));
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, crumble_loop_create(sim, &no_loop, &hand_def, 1, &made));
  expect_failure(CRUMBLE_E_UNINITIALIZED, crumble_loop_create(sim, &loop_def, &no_hand, 1, &made), {"hands[0]"});
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, crumble_loop_apply_paper_preset(&no_loop, &hand_def, 1));
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, crumble_loop_apply_paper_preset(&loop_def, &no_hand, 1));
  EXPECT_EQ(loop_def.coupling, std::uint32_t{CRUMBLE_COUPLING_DIRECT}) << "nothing was changed";
  ASSERT_OK(crumble_loop_create(sim, &loop_def, &hand_def, 1, &loop));
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, crumble_loop_get_status(loop, &no_status));
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, crumble_loop_get_hand(loop, 0, &no_hand_status));
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, crumble_loop_get_times(loop, &no_times));
}

}  // namespace
}  // namespace crumble
