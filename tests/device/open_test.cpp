#include "crumble/device/open.hpp"

#include <gtest/gtest.h>

#include "device/samples.hpp"

namespace crumble {
namespace {

TEST(Open, OpensEveryKindThatItLists) {
  DeviceDef def;
  def.path.points = {{.time = 1}};
  def.hand.points = {{.time = 1}};
  def.trajectory = std::string(CRUMBLE_SOURCE_DIR) + "/examples/trajectories/press_1mm_s.ctraj";
  for (const DeviceKind kind : available_devices()) {
    if (kind == DeviceKind::phantom) continue;   // needs a driver: tests/fakehd
    if (kind == DeviceKind::inverse3) continue;  // needs a service: tests/inverse3
    def.kind = kind;
    const auto device = open_device(def);
    EXPECT_EQ(device->info().kind, kind);
    EXPECT_EQ(device->info().rate, 1000);
    DeviceSample sample;
    EXPECT_EQ(device->read(sample), ReadStatus::ok);
    EXPECT_FALSE(device->info().servo_driven);  // nor can it be started
    const Error error = error_of([&] { device->start_servo({}); });
    EXPECT_EQ(error.code(), Code::unsupported) << to_string(kind);
    EXPECT_TRUE(mentions(error, device->info().name)) << error.what();
    device->stop_servo();
    EXPECT_STREQ(device->error_text(), "");
  }
}

TEST(Open, RefusesTheRestWithTheListOfWhatThereIs) {
  for (const DeviceKind kind : {DeviceKind::custom, static_cast<DeviceKind>(77)}) {
    const Error error = error_of([&] { open_device({.kind = kind}); });
    EXPECT_EQ(error.code(), Code::unsupported);
    EXPECT_TRUE(mentions(error, to_string(kind))) << error.what();
    EXPECT_TRUE(mentions(error, "null, press, replay, phantom, path, hand, poke, tremor, wander")) << error.what();
  }
  EXPECT_EQ(error_of([] { open_device({.kind = DeviceKind::replay, .trajectory = "none.ctraj"}); }).code(), Code::io);
}

TEST(Open, NamesComeBack) {
  for (const char* name :
       {"null", "press", "replay", "phantom", "custom", "path", "hand", "poke", "tremor", "wander", "inverse3"})
    EXPECT_STREQ(to_string(device_kind(name)), name);
  const Error error = error_of([] { device_kind("mouse"); });
  EXPECT_EQ(error.code(), Code::unsupported);
  EXPECT_TRUE(mentions(error, "mouse"));
  EXPECT_TRUE(mentions(error, "null, press, replay, phantom, custom, path, hand, poke, tremor, wander, inverse3"))
      << error.what();
}

}  // namespace
}  // namespace crumble
