// The adapter on the double, in ticks that the test runs.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>

#include "crumble/base/error.hpp"
#include "crumble/device/phantom.hpp"
#include "fakehd/rig.hpp"

namespace crumble {

inline PhantomOptions fake_options() {
  PhantomOptions options;
  options.library = FAKEHD_LIBRARY;
  return options;
}

/// The script of one device, calibrated, with its force at once, in manual ticks; `more` are further keys of the
/// device, `outer` of the whole, each ending in a comma.
inline std::string script(const std::string& more = "", const std::string& outer = "") {
  return R"({"manual": true, )" + outer + R"("devices": [{)" + more + R"("calibration": "none", "ramp_s": 0}]})";
}

class PhantomTest : public testing::Test {
 protected:
  void SetUp() override { reset(script()); }
  void TearDown() override {
    device.reset();
    EXPECT_EQ(FAKEHD(fakehd_open_devices)(), 0u);
    EXPECT_EQ(FAKEHD(fakehd_misuse)(), 0u) << FAKEHD(fakehd_misuse_text)();
    FAKEHD(fakehd_reset)(nullptr);
  }
  void reset(const std::string& text) {
    device.reset();
    ASSERT_EQ(FAKEHD(fakehd_reset)(text.c_str()), 0) << FAKEHD(fakehd_script_error)();
  }
  void open(const PhantomOptions& options = fake_options()) { device = open_phantom(options); }

  /// Starts the servo if it does not run, and runs `times` ticks with `what` in each.
  void tick(const std::function<void(Device&)>& what, int times = 1) {
    work = [this, what] { what(*device); };
    if (!started) {
      device->start_servo({[](void* self) noexcept {
                             static_cast<PhantomTest*>(self)->work();
                             return true;
                           },
                           this});
      started = true;
    }
    EXPECT_EQ(FAKEHD(fakehd_run_ticks)(times), times);
  }
  /// Reads in one tick, and writes `force`.
  ReadStatus read(DeviceSample& sample, const Vec3& force = Vec3::Zero()) {
    ReadStatus status{};
    tick([&](Device& d) {
      status = d.read(sample);
      d.write(force, Vec3::Zero());
    });
    return status;
  }
  static Vec3 applied(unsigned handle = 0) {
    double force[3];
    FAKEHD(fakehd_applied_force)(handle, force);
    return {force[0], force[1], force[2]};
  }

  std::unique_ptr<Device> device;
  std::function<void()> work;
  bool started = false;
};

inline Error error_of_opening(const PhantomOptions& options) {
  try {
    open_phantom(options);
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "it opened";
  return Error(Code{}, "");
}

inline bool mentions(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace crumble
