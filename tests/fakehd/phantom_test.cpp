// The PHANToM adapter against the double of HDAPI: what it says, in which units, and that it keeps the rules, which the
// double counts.
#include <cmath>
#include <limits>

#include "fakehd/phantom_rig.hpp"

namespace crumble {
namespace {

TEST_F(PhantomTest, TellsWhatTheDriverTells) {
  reset(script(R"("serial": "S-77", "max_damping": 0.004, "velocity_limit": 1500, )"));
  open();
  const DeviceInfo& info = device->info();
  EXPECT_EQ(info.kind, DeviceKind::phantom);
  EXPECT_TRUE(mentions(info.name, "FAKE Touch")) << info.name;
  EXPECT_FALSE(mentions(info.name, "S-77")) << "a recording tells the name to anybody";
  EXPECT_EQ(info.serial, "S-77");
  for (const char* part : {"HDAPI 3.4.0 FAKE", "driver 0.0.1 FAKE", FAKEHD_LIBRARY}) {
    EXPECT_TRUE(mentions(info.driver, part)) << info.driver;
  }
  EXPECT_TRUE(info.servo_driven);
  EXPECT_NE(info.servo_group, nullptr);
  EXPECT_EQ(info.rate, 1000);
  EXPECT_DOUBLE_EQ(info.max_force, 3.3);
  EXPECT_DOUBLE_EQ(info.continuous_force, 0.88);
  EXPECT_DOUBLE_EQ(info.max_stiffness, 500);
  EXPECT_DOUBLE_EQ(info.max_damping, 4);
  EXPECT_DOUBLE_EQ(info.max_speed, 1.5);
  EXPECT_EQ(info.max_torque, 0);
  EXPECT_DOUBLE_EQ(info.position_step, 5.5e-5);
  EXPECT_LT((info.workspace_low - Vec3(-0.08, -0.06, -0.035)).norm(), 1e-12);
  EXPECT_LT((info.workspace_high - Vec3(0.08, 0.06, 0.035)).norm(), 1e-12);
  EXPECT_EQ(info.measured, quantity::kPosition | quantity::kOrientation | quantity::kButtons)
      << "the driver's velocity is derived";
}

TEST_F(PhantomTest, SamplesAreInMetresAndTheirRotationIsOne) {
  reset(script("", R"("transform_skew": 0.001, )"));
  open();
  const double place[3] = {0.01, -0.02, 0.03};
  FAKEHD(fakehd_place)(0, place);
  FAKEHD(fakehd_press_button)(0, 2);
  DeviceSample sample;
  for (std::uint64_t i = 0; i < 3; ++i) {
    ASSERT_EQ(read(sample), ReadStatus::ok);
    EXPECT_EQ(sample.sequence, i);
  }
  EXPECT_LT((sample.pose.position - Vec3(0.01, -0.02, 0.03)).norm(), 1e-9);
  EXPECT_NEAR(sample.pose.orientation.norm(), 1, 1e-12);
  EXPECT_NEAR(std::abs(sample.pose.orientation.w()), 1, 1e-3) << "the double does not turn";
  EXPECT_EQ(sample.buttons, 2u);
  EXPECT_EQ(sample.flags, 0u);
  EXPECT_GE(sample.time, 0);
}

TEST_F(PhantomTest, TheTipTurnsWithTheStylus) {
  PhantomOptions options = fake_options();
  options.tip = {0, 0, -0.039};
  open(options);
  const double place[3] = {0, 0, 0};
  FAKEHD(fakehd_place)(0, place);
  DeviceSample sample;
  read(sample);
  const Vec3 arm = sample.pose.orientation * options.tip;
  EXPECT_LT((sample.pose.position - arm).norm(), 1e-9);
}

TEST_F(PhantomTest, AForceLastsATick) {
  open();
  DeviceSample sample;
  read(sample, {0.5, -1, 0.25});
  EXPECT_LT((applied() - Vec3(0.5, -1, 0.25)).norm(), 1e-12);
  tick([](Device& d) {
    DeviceSample s;
    EXPECT_EQ(d.read(s), ReadStatus::ok);  // and writes nothing
  });
  EXPECT_EQ(applied(), Vec3(0, 0, 0));
  read(sample, {0.5, 0, 0});
  tick([](Device&) {});  // a tick without a frame
  EXPECT_EQ(applied(), Vec3(0, 0, 0));
  read(sample, {std::nan(""), 0, 0});
  EXPECT_EQ(applied(), Vec3(0, 0, 0));
  tick([](Device& d) {
    DeviceSample s;
    static_cast<void>(d.read(s));
    d.write({1, 0, 0}, Vec3::Zero());
    d.write({2, 0, 0}, Vec3::Zero());  // the frame is over
  });
  EXPECT_EQ(applied(), Vec3(1, 0, 0));
  device->write({3, 0, 0}, Vec3::Zero());  // outside of any tick
  EXPECT_EQ(applied(), Vec3(1, 0, 0));
}

TEST_F(PhantomTest, TorqueOnlyOfSixMotorsAndOnRequest) {
  PhantomOptions options = fake_options();
  double torque[3];
  for (const bool asked : {false, true}) {
    reset(script(R"("output_dof": 6, )"));
    started = false;
    options.torque = asked;
    open(options);
    EXPECT_EQ(device->info().max_torque > 0, asked);
    tick([](Device& d) {
      DeviceSample s;
      static_cast<void>(d.read(s));
      d.write(Vec3::Zero(), {0.01, 0.02, -0.03});
    });
    FAKEHD(fakehd_last_torque)(0, torque);
    EXPECT_DOUBLE_EQ(torque[2], asked ? -30 : 0) << "mN m";
  }
}

TEST_F(PhantomTest, TriesTheNamesThatInstallersGive) {
  for (const char* name : {"Default Device", "Default PHANToM"}) {
    reset(std::string(R"({"manual": true, "null_name_fails": true, "default_names": [], "devices": [{"name": ")") +
          name + R"("}]})");
    EXPECT_NO_THROW(open()) << name;
  }
  reset(R"({"manual": true, "null_name_fails": true, "default_names": [], "devices": [{"name": "left"}]})");
  const Error none = error_of_opening(fake_options());
  EXPECT_EQ(none.code(), Code::device_lost);
  for (const char* part : {"first device: ", "'Default Device': ", "'Default PHANToM': ", "internal code"}) {
    EXPECT_TRUE(mentions(none.what(), part)) << none.what();
  }
  PhantomOptions named = fake_options();
  named.name = "left";
  EXPECT_NO_THROW(open(named));
  device.reset();
  named.name = "right";
  const Error error = error_of_opening(named);
  EXPECT_TRUE(mentions(error.what(), "'right'")) << error.what();
  EXPECT_FALSE(mentions(error.what(), "Default")) << "another one might be in somebody's hand";
}

TEST_F(PhantomTest, KeepsTheDriversRateWhereItTakesNoOther) {
  for (const char* quirk : {"value", "timer", "operation"}) {
    reset(script("", std::string(R"("rate_quirk": ")") + quirk + R"(", )"));
    PhantomOptions options = fake_options();
    options.rate = 4000;
    open(options);
    EXPECT_EQ(device->info().rate, 1000) << quirk;
    device.reset();
    options.rate = 500;
    open(options);
    EXPECT_EQ(device->info().rate, 500) << quirk;
    EXPECT_EQ(FAKEHD(fakehd_rate)(), 500u);
  }
}

TEST_F(PhantomTest, RefusesBadOptions) {
  PhantomOptions options = fake_options();
  options.rate = 100;
  EXPECT_TRUE(mentions(error_of_opening(options).what(), "phantom.rate")) << "before anything is opened";
  options.rate = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(error_of_opening(options).code(), Code::invalid_value);
  options.rate = 1000;
  options.tip.y() = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(mentions(error_of_opening(options).what(), "phantom.tip.y"));
  options = fake_options();
  options.reset_encoders = true;
  EXPECT_EQ(error_of_opening(options).code(), Code::unsupported) << "it has no such calibration";
  open();
  options = fake_options();
  options.library = "another.so";
  EXPECT_EQ(error_of_opening(options).code(), Code::state) << "a process has one";
}

TEST_F(PhantomTest, ALicenseIsGivenBeforeAndMayBeRefused) {
  PhantomOptions options = fake_options();
  options.license_vendor = "v", options.license_application = "a", options.license_password = "p";
  open(options);
  EXPECT_STREQ(FAKEHD(fakehd_license_vendor)(), "v");
  EXPECT_STREQ(FAKEHD(fakehd_license_application)(), "a");
  reset(script("", R"("license_refused": true, )"));
  EXPECT_EQ(error_of_opening(options).code(), Code::unsupported);
  EXPECT_NO_THROW(open()) << "who has none need not ask";
}

TEST_F(PhantomTest, AnInkwellCalibratesWhileItRuns) {
  reset(R"({"manual": true, "devices": [{"calibration": "inkwell", "inkwell_at_s": -1}]})");
  open();
  const double place[3] = {0.02, 0, 0};
  FAKEHD(fakehd_place)(0, place);
  DeviceSample sample;
  for (int i = 0; i < 50; ++i) read(sample);
  EXPECT_EQ(sample.flags, sample_flag::kUncalibrated);
  EXPECT_TRUE(mentions(device->error_text(), "inkwell")) << device->error_text();
  FAKEHD(fakehd_inkwell)(0, 1);
  for (int i = 0; i < 5; ++i) read(sample);
  EXPECT_EQ(sample.flags, 0u);
  EXPECT_STREQ(device->error_text(), "");
  EXPECT_LT((sample.pose.position - Vec3(0.02, 0, 0)).norm(), 1e-6) << "only now it tells where it is";
}

TEST_F(PhantomTest, AnAutomaticOneCalibratesByItself) {
  reset(R"({"manual": true, "devices": [{"calibration": "auto", "auto_after_s": 0.1}]})");
  open();
  DeviceSample sample;
  read(sample);
  EXPECT_EQ(sample.flags, sample_flag::kUncalibrated);
  EXPECT_TRUE(mentions(device->error_text(), "move")) << device->error_text();
  for (int i = 0; i < 150; ++i) read(sample);
  EXPECT_EQ(sample.flags, 0u);
}

TEST_F(PhantomTest, EncodersAreResetOnlyWhenSomebodySaysSo) {
  const char* premium = R"({"manual": true, "devices": [{"model": "Premium 1.5", "calibration": "encoder_reset"}]})";
  reset(premium);
  open();
  DeviceSample sample;
  for (int i = 0; i < 300; ++i) read(sample);
  EXPECT_EQ(sample.flags, sample_flag::kUncalibrated) << "the arm may be anywhere";
  EXPECT_TRUE(mentions(device->error_text(), "phantom.reset_encoders")) << device->error_text();
  EXPECT_DOUBLE_EQ(device->info().position_step, 3e-5);
  reset(premium);
  started = false;
  PhantomOptions options = fake_options();
  options.reset_encoders = true;
  open(options);
  read(sample);
  EXPECT_EQ(sample.flags, 0u);
}

TEST_F(PhantomTest, UnpluggedMeansLostForGood) {
  open();
  DeviceSample sample;
  read(sample, {1, 0, 0});
  FAKEHD(fakehd_unplug)(0);
  EXPECT_EQ(read(sample, {1, 0, 0}), ReadStatus::lost);
  EXPECT_EQ(applied(), Vec3(0, 0, 0));
  EXPECT_TRUE(mentions(device->error_text(), "HD_COMM_ERROR, internal code -28")) << device->error_text();
  FAKEHD(fakehd_replug)(0);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(read(sample, {1, 0, 0}), ReadStatus::lost) << "only on request";
  EXPECT_EQ(applied(), Vec3(0, 0, 0));
  device.reset();
  started = false;
  open();
  EXPECT_EQ(read(sample), ReadStatus::ok);
}

// Codes as in the reference, and what they are to us.
struct DriverError {
  unsigned code;
  ReadStatus status;
  std::uint32_t flags;
  double temperature;
};
void PrintTo(const DriverError& error, std::ostream* out) {
  *out << error.code;
}
class EveryError : public PhantomTest, public testing::WithParamInterface<DriverError> {};

TEST_P(EveryError, IsHotLetGoOrLost) {
  const DriverError& e = GetParam();
  reset(script("", R"("faults": [{"tick": 3, "kind": "error", "code": )" + std::to_string(e.code) + "}], "));
  open();
  DeviceSample sample;
  read(sample), read(sample);
  EXPECT_EQ(read(sample), e.status);
  if (e.status == ReadStatus::ok) {
    EXPECT_EQ(sample.flags, e.flags);
    EXPECT_DOUBLE_EQ(sample.motor_temperature, e.temperature);
  }
  const bool told = e.flags != 0 || e.status == ReadStatus::lost;
  EXPECT_EQ(std::string(device->error_text()).empty(), !told) << device->error_text();
  read(sample);
  EXPECT_EQ(e.status == ReadStatus::ok ? sample.flags : 0, 0u) << "told once";
}

constexpr auto kOk = ReadStatus::ok, kLost = ReadStatus::lost;
constexpr auto kOff = sample_flag::kForceOff;
INSTANTIATE_TEST_SUITE_P(
    HD, EveryError,
    testing::Values(DriverError{0x100, kOk, kOff, 0}, DriverError{0x101, kOk, kOff, 0},
                    DriverError{0x102, kOk, kOff, 0}, DriverError{0x103, kOk, kOff, 0}, DriverError{0x104, kLost, 0, 0},
                    DriverError{0x200, kOk, 0, 1}, DriverError{0x201, kOk, kOff, 0}, DriverError{0x202, kOk, kOff, 0},
                    DriverError{0x203, kOk, kOff, 0}, DriverError{0x204, kOk, kOff, 0},
                    DriverError{0x300, kOk, kOff, 0}, DriverError{0x301, kOk, kOff, 0}, DriverError{0x302, kLost, 0, 0},
                    DriverError{0x303, kLost, 0, 0}, DriverError{0x304, kLost, 0, 0}, DriverError{0x400, kOk, kOff, 0},
                    DriverError{0x401, kOk, kOff, 0}, DriverError{0x402, kOk, kOff, 0}, DriverError{0x500, kLost, 0, 0},
                    DriverError{0x501, kLost, 0, 0}, DriverError{0x600, kLost, 0, 0}, DriverError{0x999, kOk, kOff, 0}),
    [](const auto& param) { return "Code" + std::to_string(param.param.code); });

TEST_F(PhantomTest, HotMotorsAreToldEveryTick) {
  open();
  DeviceSample sample;
  FAKEHD(fakehd_set_temperature)(0, 0.75);
  read(sample);
  EXPECT_NEAR(sample.motor_temperature, 0.75, 0.01);
}

TEST_F(PhantomTest, WrongValuesPassAsTheyAreToThoseWhoGuard) {
  reset(script("", R"("faults": [{"tick": 2, "kind": "nan_position"}, {"tick": 3, "kind": "bad_transform"},
                                 {"tick": 4, "kind": "teleport"}], )"));
  open();
  DeviceSample sample;
  read(sample);
  const Vec3 before = sample.pose.position;
  EXPECT_EQ(read(sample), ReadStatus::ok);
  EXPECT_FALSE(is_finite(sample.pose.position));
  EXPECT_EQ(read(sample), ReadStatus::ok);
  EXPECT_FALSE(is_valid(sample.pose)) << "no rotation";
  EXPECT_EQ(read(sample), ReadStatus::ok);
  EXPECT_NEAR((sample.pose.position - before).norm(), 0.05, 1e-9);
}

TEST_F(PhantomTest, TwoDevicesShareTheThreadAndHaveErrorsOfTheirOwn) {
  reset(R"({"manual": true, "devices": [{"name": "left", "calibration": "none", "ramp_s": 0},
                                        {"name": "right", "calibration": "none", "ramp_s": 0}]})");
  PhantomOptions options = fake_options();
  options.name = "left";
  open(options);
  options.name = "right";
  auto right = open_phantom(options);
  EXPECT_EQ(device->info().servo_group, right->info().servo_group);
  EXPECT_EQ(error_of_opening(options).code(), Code::device_lost) << "is open already";
  ReadStatus status[2];
  DeviceSample samples[2];
  const auto both = [&](Device& left) {
    status[0] = left.read(samples[0]), status[1] = right->read(samples[1]);
    left.write({1, 0, 0}, Vec3::Zero()), right->write({0, 2, 0}, Vec3::Zero());
  };
  tick(both, 3);
  EXPECT_EQ(applied(0), Vec3(1, 0, 0));
  EXPECT_EQ(applied(1), Vec3(0, 2, 0));
  EXPECT_EQ(error_of_opening(options).code(), Code::state) << "the thread runs";

  FAKEHD(fakehd_push_error)(0x201, 0, 1);
  tick(both);
  EXPECT_EQ(samples[0].flags, 0u);
  EXPECT_EQ(samples[1].flags, sample_flag::kForceOff);
  FAKEHD(fakehd_unplug)(1);
  tick(both, 2);
  EXPECT_EQ(status[0], ReadStatus::ok);
  EXPECT_EQ(status[1], ReadStatus::lost);
  EXPECT_EQ(applied(0), Vec3(1, 0, 0)) << "the other hand goes on";
  EXPECT_EQ(applied(1), Vec3(0, 0, 0));
  right.reset();  // while the thread runs: it stays with the driver until that stands
  EXPECT_EQ(FAKEHD(fakehd_open_devices)(), 2u);
  tick([&](Device& left) {
    EXPECT_EQ(left.read(samples[0]), ReadStatus::ok);
    left.write(Vec3::Zero(), Vec3::Zero());
  });
  device->stop_servo();
  EXPECT_EQ(FAKEHD(fakehd_open_devices)(), 1u);
}

TEST_F(PhantomTest, TicksOfTwoDevicesStopOneByOne) {
  reset(R"({"devices": [{"name": "left", "calibration": "none"}, {"name": "right", "calibration": "none"}]})");
  PhantomOptions options = fake_options();
  options.name = "left";
  open(options);
  options.name = "right";
  auto right = open_phantom(options);
  std::atomic<int> lefts{0}, rights{0};
  const auto count = [](void* n) noexcept { return ++*static_cast<std::atomic<int>*>(n), true; };
  device->start_servo({count, &lefts});
  right->start_servo({count, &rights});
  while (lefts < 5 || rights < 5) std::this_thread::yield();
  right->stop_servo();
  const int after = rights;
  for (const int now = lefts; lefts < now + 5;) std::this_thread::yield();
  EXPECT_EQ(rights, after);
  device->stop_servo();
  EXPECT_FALSE(FAKEHD(fakehd_scheduler_running)());
  EXPECT_EQ(FAKEHD(fakehd_scheduled)(), 0u);
}

TEST_F(PhantomTest, ATickThatEndsItselfIsNotCalledAgain) {
  open();
  int calls = 0;
  device->start_servo({[](void* n) noexcept { return ++*static_cast<int*>(n) < 3; }, &calls});
  FAKEHD(fakehd_run_ticks)(10);
  EXPECT_EQ(calls, 3);
  device->stop_servo();
  device->stop_servo();
  started = true;
}

TEST_F(PhantomTest, OpensAFifthOnlyWhenOneIsClosed) {
  reset(R"({"manual": true, "devices": [{"name": "a"}, {"name": "b"}, {"name": "c"}, {"name": "d"}, {"name": "e"}]})");
  std::vector<std::unique_ptr<Device>> open;
  PhantomOptions options = fake_options();
  for (const char* name : {"a", "b", "c", "d"}) {
    options.name = name;
    open.push_back(open_phantom(options));
  }
  options.name = "e";
  EXPECT_EQ(error_of_opening(options).code(), Code::too_large);
  open.pop_back();
  EXPECT_NO_THROW(open.push_back(open_phantom(options)));
}

TEST_F(PhantomTest, CanBeLeftEnabledForDriversThatCrash) {
  PhantomOptions options = fake_options();
  options.disable_on_close = false;
  open(options);
  device.reset();
  EXPECT_EQ(FAKEHD(fakehd_open_devices)(), 1u);
  FAKEHD(fakehd_reset)(nullptr);
}

}  // namespace
}  // namespace crumble
