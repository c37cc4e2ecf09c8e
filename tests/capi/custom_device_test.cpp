// Devices by callbacks: what they may tell and what becomes of those that fail.
#include <stdexcept>

#include "capi/loop_rig.hpp"
#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

class CustomDevices : public testing::Test {
 protected:
  void TearDown() override { EXPECT_RESULT(CRUMBLE_OK, crumble_device_destroy(device)); }
  crumble_result read() {
    sample.struct_size = sizeof sample;
    return crumble_device_read(device, &sample);
  }
  crumble_result push(double y) {
    const double force[3] = {0, y, 0};
    return crumble_device_write(device, force, nullptr);
  }
  crumble_device_info info() {
    crumble_device_info out{};
    out.struct_size = sizeof out;
    EXPECT_RESULT(CRUMBLE_OK, crumble_device_get_info(device, &out));
    return out;
  }
  Strings strings;
  crumble_device device = nullptr;
  crumble_device_sample sample{};
};

TEST_F(CustomDevices, TellAndAreTold) {
  device = strings.open();
  strings.height = 0.005, strings.buttons = 3;
  ASSERT_OK(read());
  ASSERT_OK(read());
  EXPECT_EQ(sample.status, std::uint32_t{CRUMBLE_READ_OK});
  EXPECT_EQ(sample.sequence, 1u);
  EXPECT_EQ(sample.time, 1e-3);
  EXPECT_EQ(sample.pose.position[1], 0.005);
  EXPECT_EQ(sample.pose.orientation[0], 1);
  EXPECT_EQ(sample.buttons, 3u);
  ASSERT_OK(push(1.5));
  EXPECT_EQ(strings.last_force, 1.5);
  strings.status = CRUMBLE_READ_NO_NEW_SAMPLE, strings.buttons = 0;
  ASSERT_OK(read());
  EXPECT_EQ(sample.status, std::uint32_t{CRUMBLE_READ_NO_NEW_SAMPLE});
  EXPECT_EQ(sample.buttons, 3u) << "as it was";
  strings.status = CRUMBLE_READ_FINISHED;
  ASSERT_OK(read());
  EXPECT_EQ(sample.status, std::uint32_t{CRUMBLE_READ_FINISHED});
  EXPECT_EQ(sample.flags, std::uint32_t{CRUMBLE_SAMPLE_FINISHED});
  EXPECT_EQ(sample.sequence, 2u);
}

TEST_F(CustomDevices, TheirTableAndNameAreCopied) {
  {
    std::string name(70, 'x');
    name.replace(62, 2, "\xc3\xa4");  // would be cut in half
    crumble_device_callbacks table = strings.callbacks();
    table.name = name.c_str();
    table.workspace_high[2] = 0.1;
    table.flags = CRUMBLE_DEVICE_STEP_LOCKED;
    table.measured = CRUMBLE_SENSES_POSITION | CRUMBLE_SENSES_BUTTONS;
    device = Strings::open(table);
    table.read = nullptr;
  }
  EXPECT_EQ(std::string(info().name), std::string(62, 'x'));
  EXPECT_EQ(info().kind, std::uint32_t{CRUMBLE_DEVICE_CUSTOM});
  EXPECT_EQ(info().flags, std::uint32_t{CRUMBLE_DEVICE_STEP_LOCKED});
  EXPECT_EQ(info().measured, 17u);
  EXPECT_EQ(info().mass, 0.075);
  EXPECT_EQ(info().max_force, 3.3);
  EXPECT_EQ(info().workspace_high[2], 0.1);
  EXPECT_EQ(info().callback_error, CRUMBLE_OK);
  EXPECT_RESULT(CRUMBLE_OK, read());
}

TEST_F(CustomDevices, AReadThatFailsLosesThemForGood) {
  device = strings.open();
  strings.fails_at = 2, strings.answer = CRUMBLE_E_IO;
  ASSERT_OK(read());
  ASSERT_OK(read());
  ASSERT_OK(push(1));
  sample.buttons = 77;
  expect_failure(CRUMBLE_E_DEVICE_LOST, read(), {"crumble_device_read", "callback `read` failed"});
  EXPECT_EQ(sample.buttons, 77u);
  EXPECT_EQ(info().callback_error, CRUMBLE_E_IO);
  strings.fails_at = ~0ull;
  EXPECT_RESULT(CRUMBLE_E_DEVICE_LOST, read());
  EXPECT_EQ(strings.reads, 3u) << "it is not asked any more";
  expect_failure(CRUMBLE_E_DEVICE_LOST, push(1), {"crumble_device_write", "lost"});
  EXPECT_EQ(strings.last_force, 0) << "but its motors are told to rest";
}

TEST_F(CustomDevices, SoDoWritesThatFailWrongStatusesAndExceptions) {
  device = strings.open();
  strings.write_answer = 5;  // any value but 0
  expect_failure(CRUMBLE_E_DEVICE_LOST, push(1), {"`write`"});
  EXPECT_EQ(info().callback_error, 5);
  EXPECT_RESULT(CRUMBLE_E_DEVICE_LOST, read());
  ASSERT_OK(crumble_device_destroy(device));

  Strings other;
  device = other.open();
  other.status = 3;
  expect_failure(CRUMBLE_E_DEVICE_LOST, read(), {"status"});
  ASSERT_OK(crumble_device_destroy(device));

  crumble_device_callbacks table = strings.callbacks();
  table.read = [](crumble_device_sample*, void*) -> crumble_result { throw std::runtime_error("C++"); };
  device = Strings::open(table);
  expect_failure(CRUMBLE_E_DEVICE_LOST, read(), {"`read`"});
  EXPECT_EQ(info().callback_error, CRUMBLE_E_INTERNAL);
}

TEST_F(CustomDevices, ACallIntoTheDeviceFromItsOwnCallbackIsBusy) {
  static crumble_device self;
  static crumble_result answer;
  crumble_device_callbacks table = strings.callbacks();
  table.read = [](crumble_device_sample*, void*) -> crumble_result {
    answer = crumble_device_destroy(self);
    return CRUMBLE_OK;
  };
  self = device = Strings::open(table);
  ASSERT_OK(read());
  EXPECT_RESULT(CRUMBLE_E_BUSY, answer);
}

TEST_F(CustomDevices, BadTablesAreRefused) {
  const auto expect = [&](crumble_result expected, auto change, const Vector<std::string>& words) {
    crumble_device_callbacks table = strings.callbacks();
    crumble_device_def def{};
    ASSERT_OK(crumble_device_def_init(&def, sizeof def));
    def.kind = CRUMBLE_DEVICE_CUSTOM;
    def.callbacks = &table;
    change(table);
    crumble_device made = nullptr;
    expect_failure(expected, crumble_device_open(&def, &made), words);
    EXPECT_EQ(made, nullptr);
  };
  using Table = crumble_device_callbacks;
  expect(CRUMBLE_E_NULL, [](Table& t) { t.read = nullptr; }, {"callbacks.read"});
  expect(CRUMBLE_E_NULL, [](Table& t) { t.write = nullptr; }, {"callbacks.write"});
  expect(CRUMBLE_E_NULL, [](Table& t) { t.flags = CRUMBLE_DEVICE_SERVO_DRIVEN; }, {"callbacks.start"});
  expect(CRUMBLE_E_OUT_OF_RANGE, [](Table& t) { t.flags = 4; }, {"callbacks.flags", "4"});
  expect(CRUMBLE_E_OUT_OF_RANGE, [](Table& t) { t.measured = 32; }, {"callbacks.measured", "32"});
  expect(CRUMBLE_E_OUT_OF_RANGE, [](Table& t) { t.reserved = 1; }, {"callbacks.reserved"});
  expect(CRUMBLE_E_OUT_OF_RANGE, [](Table& t) { t.mass = -1; }, {"callbacks.mass", "-1"});
  expect(CRUMBLE_E_INVALID_VALUE, [](Table& t) { t.position_step = kNan; }, {"callbacks.position_step"});
  expect(CRUMBLE_E_INVALID_VALUE, [](Table& t) { t.workspace_low[1] = kNan; }, {"callbacks.workspace_low.y"});
  expect(CRUMBLE_E_OUT_OF_RANGE, [](Table& t) { t.workspace_low[1] = 1; }, {"workspace_low.y", "workspace_high.y"});
  expect(CRUMBLE_E_UNINITIALIZED, [](Table& t) { t.struct_size = 0; }, {"callbacks.struct_size"});
  crumble_device_def def{};
  ASSERT_OK(crumble_device_def_init(&def, sizeof def));
  def.kind = CRUMBLE_DEVICE_CUSTOM;
  expect_failure(CRUMBLE_E_NULL, crumble_device_open(&def, &device), {"callbacks must not be NULL"});
}

}  // namespace
}  // namespace crumble
