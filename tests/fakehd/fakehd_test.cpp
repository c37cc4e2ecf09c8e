// Devices, errors, frames and what they tell. Numbers as the documents have them, typed here.
#include <cmath>

#include "rig.hpp"

namespace fakehd_test {
namespace {

TEST_F(FakeHd, FirstHandleIsZeroAndCurrent) {
  EXPECT_EQ(hd().current(), 0xFFFFFFFFu);
  EXPECT_EQ(hd().init(nullptr), 0u);
  EXPECT_EQ(hd().current(), 0u);
  EXPECT_EQ(FAKEHD(fakehd_open_devices)(), 1u);
  EXPECT_EQ(hd().error().code, 0u);
}

TEST_F(FakeHd, DeviceOpensOnceUnderAllItsNames) {
  reset(R"({"default_names": ["Default PHANToM"], "devices": [{"name": "left"}, {"name": "right"}]})");
  EXPECT_EQ(hd().init("left"), 0u);
  for (const char* name : {"left", "Default PHANToM", static_cast<const char*>(nullptr)}) {
    EXPECT_EQ(hd().init(name), 0xFFFFFFFFu);
    EXPECT_EQ(next_error(), 0x301u);
  }
  EXPECT_EQ(hd().init("Default Device"), 0xFFFFFFFFu);
  EXPECT_EQ(next_error(), 0x303u);
  EXPECT_EQ(hd().init("right"), 1u);
  EXPECT_EQ(hd().current(), 1u);
  hd().make_current(0);
  EXPECT_EQ(hd().current(), 0u);
}

TEST_F(FakeHd, NullNameMayFail) {
  reset(R"({"null_name_fails": true})");
  EXPECT_EQ(hd().init(nullptr), 0xFFFFFFFFu);
  EXPECT_EQ(next_error(), 0x303u);
  EXPECT_EQ(hd().init("Default Device"), 0u);
}

TEST_F(FakeHd, StaleHandleIsBadAndNeverComesBack) {
  misuse_expected = true;
  const unsigned first = hd().init(nullptr);
  hd().disable_device(first);
  EXPECT_EQ(hd().current(), 0xFFFFFFFFu);
  hd().begin(first);
  const Error bad = hd().error();
  EXPECT_EQ(bad.code, 0x104u);
  EXPECT_EQ(bad.device, first);
  EXPECT_NE(hd().init(nullptr), first);
}

TEST_F(FakeHd, ErrorsComeYoungestFirstAndCarryTheirDevice) {
  hd().init(nullptr);
  FAKEHD(fakehd_push_error)(0x100, 7, 3);
  FAKEHD(fakehd_push_error)(0x302, -28, 0);
  EXPECT_EQ(FAKEHD(fakehd_errors_pending)(), 2u);
  const Error youngest = hd().error();
  EXPECT_EQ(youngest.code, 0x302u);
  EXPECT_EQ(youngest.internal, -28);
  EXPECT_EQ(youngest.device, 0u);
  const Error oldest = hd().error();
  EXPECT_EQ(oldest.code, 0x100u);
  EXPECT_EQ(oldest.internal, 7);
  EXPECT_EQ(oldest.device, 3u);
  EXPECT_EQ(hd().error().code, 0u);
  EXPECT_EQ(FAKEHD(fakehd_errors_pushed)(), 2u);
  EXPECT_STREQ(hd().error_string(0x302), "fake: device does not answer");
  EXPECT_STREQ(hd().error_string(77), "fake: unknown error");
}

TEST_F(FakeHd, OneFrameForEachTick) {
  misuse_expected = true;
  const unsigned device = started();
  tick([&] {
    hd().begin(device);
    hd().begin(device);
    EXPECT_EQ(next_error(), 0x400u);
    hd().end(device);
    hd().end(device);
    EXPECT_EQ(next_error(), 0x401u);
    hd().begin(device);
    EXPECT_EQ(next_error(), 0x400u);
  });
  tick([&] {
    hd().disable(0x4004);
    for (int i = 0; i < 2; ++i) {
      hd().begin(device);
      hd().end(device);
    }
    EXPECT_EQ(next_error(), 0u);
  });
  EXPECT_EQ(FAKEHD(fakehd_frames)(device), 3u);
  EXPECT_EQ(FAKEHD(fakehd_misuse)(), 3u);
}

TEST_F(FakeHd, FramesOfTwoDevicesLieInEachOther) {
  reset(R"({"manual": true, "devices": [{"calibration": "none"}, {"calibration": "none", "name": "b"}]})");
  const unsigned a = hd().init(nullptr);
  const unsigned b = hd().init("b");
  const Vec up = {0, 1, 0}, down = {0, -1, 0};
  hd().start();
  tick([&] {
    hd().begin(a);
    EXPECT_EQ(hd().current(), a);
    hd().begin(b);
    EXPECT_EQ(hd().current(), b);
    hd().set_double(0x2700, down.data());
    hd().make_current(a);
    hd().set_double(0x2700, up.data());
    hd().end(a);
    hd().end(b);
    EXPECT_EQ(next_error(), 0u);
  });
  Vec force{};
  FAKEHD(fakehd_commanded_force)(a, force.data());
  EXPECT_EQ(force, up);
  FAKEHD(fakehd_commanded_force)(b, force.data());
  EXPECT_EQ(force, down);
}

TEST_F(FakeHd, SetNeedsAFrame) {
  misuse_expected = true;
  started();
  tick([&] {
    const Vec force = {1, 0, 0};
    hd().set_double(0x2700, force.data());
    EXPECT_EQ(next_error(), 0x402u);
  });
  EXPECT_STREQ(FAKEHD(fakehd_misuse_text)(), "hdSet outside a frame");
}

TEST_F(FakeHd, GetOutsideAFrameTellsTheLastOne) {
  const unsigned device = started();
  const Vec at = {0.010, 0.020, 0.030}, elsewhere = {-0.010, 0, 0};
  FAKEHD(fakehd_place)(device, at.data());
  frame(device);
  FAKEHD(fakehd_place)(device, elsewhere.data());
  tick([&] { EXPECT_NEAR(read(0x2050)[1], 20, 1e-9); });
  frame(device, [&] {
    EXPECT_NEAR(read(0x2050)[0], -10, 1e-9);
    EXPECT_NEAR(read(0x2250)[0], 10, 1e-9);
  });
}

TEST_F(FakeHd, WrongNameTypeAndPointer) {
  misuse_expected = true;
  hd().init(nullptr);
  Vec v{};
  int i = 0;
  hd().get_double(0x2999, v.data());
  EXPECT_EQ(next_error(), 0x100u);
  hd().get_integer(0x2050, &i);
  EXPECT_EQ(next_error(), 0x103u);
  hd().get_double(0x2000, v.data());
  EXPECT_EQ(next_error(), 0x103u);
  hd().get_double(0x2050, nullptr);
  EXPECT_EQ(next_error(), 0x101u);
  hd().set_double(0x2050, v.data());
  EXPECT_EQ(next_error(), 0x100u);
  hd().enable(0x4005);
  EXPECT_EQ(next_error(), 0x100u);
  EXPECT_EQ(hd().string(0x2050), nullptr);
  EXPECT_EQ(next_error(), 0x103u);
  EXPECT_EQ(FAKEHD(fakehd_misuse)(), 7u);
  hd().get_double(0x2621, v.data());  // exists, and is not modelled
  EXPECT_EQ(next_error(), 0x102u);
  EXPECT_EQ(FAKEHD(fakehd_misuse)(), 7u);
}

TEST_F(FakeHd, NothingCrashesWithoutADevice) {
  misuse_expected = true;
  for (unsigned name = 0; name < 0x6000; ++name) {
    hd().get_double(name, nullptr);
    hd().get_integer(name, nullptr);
    hd().set_double(name, nullptr);
    hd().string(name);
    hd().enable(name);
  }
  EXPECT_EQ(next_error(), 0x104u);
  hd().init(nullptr);
  for (unsigned name = 0; name < 0x6000; ++name) {
    hd().get_double(name, nullptr);
    hd().get_long(name, nullptr);
    hd().set_double(name, nullptr);
    hd().set_integer(name, nullptr);
    hd().string(name);
    hd().calibrate(name);
    hd().wait(name, name);
  }
  EXPECT_EQ(hd().schedule(nullptr, nullptr, 0), 0xFFFFFFFFu);
  EXPECT_EQ(next_error(), 0x101u);
}

TEST_F(FakeHd, TellsWhoItIs) {
  reset(R"({"devices": [{"model": "Desk", "serial": "S7"}]})");
  hd().init(nullptr);
  EXPECT_STREQ(hd().string(0x2501), "FAKE Desk");
  EXPECT_STREQ(hd().string(0x2504), "S7");
  for (const unsigned name : {0x2500u, 0x2502u, 0x2503u}) {
    EXPECT_NE(std::string(hd().string(name)).find("FAKE"), std::string::npos);
  }
}

TEST_F(FakeHd, TellsItsLimits) {
  hd().init(nullptr);
  double value = 0;
  float single = 0;
  int count = 0;
  hd().get_double(0x2602, &value);
  EXPECT_EQ(value, 0.5);
  hd().get_double(0x2603, &value);
  EXPECT_EQ(value, 3.3);
  hd().get_float(0x2604, &single);
  EXPECT_EQ(single, 0.88f);
  hd().get_integer(0x2553, &count);
  EXPECT_EQ(count, 6);
  hd().get_integer(0x2554, &count);
  EXPECT_EQ(count, 3);
  hd().get_integer(0x2600, &count);
  EXPECT_EQ(count, 1000);
  std::array<double, 6> box{};
  hd().get_double(0x2551, box.data());
  EXPECT_EQ(box, (std::array<double, 6>{-80, -60, -35, 80, 60, 35}));
  EXPECT_EQ(hd().error().code, 0u);
}

TEST_F(FakeHd, DefaultCapabilities) {
  hd().init(nullptr);
  EXPECT_EQ(hd().is_enabled(0x4000), 0);
  for (const unsigned on : {0x4001u, 0x4002u, 0x4003u, 0x4004u, 0x2606u, 0x2607u}) EXPECT_EQ(hd().is_enabled(on), 1);
  hd().enable(0x4000);
  EXPECT_EQ(FAKEHD(fakehd_enabled)(0, 0x4000), 1);
}

TEST_F(FakeHd, TransformIsColumnMajorAndNotQuiteARotation) {
  const unsigned device = started();
  const Vec at = {0.001, 0.002, 0.003};
  FAKEHD(fakehd_place)(device, at.data());
  std::array<double, 16> m{};
  frame(device, [&] { hd().get_double(0x2052, m.data()); });
  EXPECT_NEAR(m[12], 1, 1e-9);
  EXPECT_NEAR(m[13], 2, 1e-9);
  EXPECT_NEAR(m[14], 3, 1e-9);
  EXPECT_EQ(m[15], 1);
  EXPECT_NEAR(std::hypot(m[0], m[1], m[2]) - 1, 1e-4, 1e-9);
  EXPECT_NEAR(m[0] * m[4] + m[1] * m[5] + m[2] * m[6], 1e-4, 1e-7);
}

TEST_F(FakeHd, ButtonsAndSwitches) {
  const unsigned device = started();
  FAKEHD(fakehd_press_button)(device, 5);
  FAKEHD(fakehd_inkwell)(device, 1);
  frame(device, [&] {
    int buttons = 0;
    unsigned char outside = 9;
    std::array<long, 6> encoders{};
    hd().get_integer(0x2000, &buttons);
    hd().get_boolean(0x2002, &outside);
    hd().get_long(0x2010, encoders.data());
    EXPECT_EQ(buttons, 5);
    EXPECT_EQ(outside, 0) << "0 is in the inkwell";
    EXPECT_NE(encoders[1], 0);
    EXPECT_EQ(next_error(), 0u);
  });
}

TEST_F(FakeHd, LicenseMayBeRefused) {
  EXPECT_EQ(hd().license("v", "a", "p"), 1);
  EXPECT_STREQ(FAKEHD(fakehd_license_application)(), "a");
  reset(R"({"license_refused": true})");
  EXPECT_EQ(hd().license("v", "a", "p"), 0);
  EXPECT_EQ(next_error(), 0x600u);
  EXPECT_EQ(FAKEHD(fakehd_license_vendor)(), nullptr);
}

TEST_F(FakeHd, CallsThatBreakARuleAreCounted) {
  misuse_expected = true;
  const unsigned device = started();
  EXPECT_EQ(FAKEHD(fakehd_misuse)(), 0u);
  hd().calibration();  // from here, while the scheduler runs
  EXPECT_STREQ(FAKEHD(fakehd_misuse_text)(), "a device call outside the servo thread while the scheduler runs");
  tick([&] { hd().begin(device); });
  EXPECT_EQ(FAKEHD(fakehd_misuse)(), 2u);
  hd().error();  // takes what belongs to the servo
  EXPECT_EQ(FAKEHD(fakehd_misuse)(), 3u);
  hd().stop();
  hd().calibration();
  hd().error();
  EXPECT_EQ(FAKEHD(fakehd_misuse)(), 3u);
}

}  // namespace
}  // namespace fakehd_test
