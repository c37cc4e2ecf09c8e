// From the commanded force to the motors and the hand.
#include <cmath>
#include <limits>

#include "rig.hpp"

namespace fakehd_test {
namespace {

double size(const Vec& v) {
  return std::hypot(v[0], v[1], v[2]);
}

TEST_F(FakeHd, ForceLastsForItsFrame) {
  const unsigned device = started();
  frame_with_force(device, {1, 2, 0});
  EXPECT_EQ(applied(device), (Vec{1, 2, 0}));
  frame(device, [] { EXPECT_EQ(read(0x2800), (Vec{1, 2, 0})); });  // nothing set
  EXPECT_EQ(applied(device), (Vec{0, 0, 0}));
  frame_with_force(device, {1, 0, 0});
  FAKEHD(fakehd_run_ticks)(1);  // no frame
  EXPECT_EQ(applied(device), (Vec{0, 0, 0}));
  Vec integral{};
  FAKEHD(fakehd_force_integral)(device, integral.data());
  EXPECT_NEAR(integral[0], 0.002, 1e-12);
  EXPECT_NEAR(integral[1], 0.002, 1e-12);
}

TEST_F(FakeHd, NoForceUnlessEnabledAndRunning) {
  const unsigned device = hd().init(nullptr);
  hd().start();
  frame_with_force(device, {1, 0, 0});
  EXPECT_EQ(applied(device), (Vec{0, 0, 0}));
  tick([] { hd().enable(0x4000); });
  frame_with_force(device, {1, 0, 0});
  EXPECT_EQ(applied(device), (Vec{1, 0, 0}));
  frame(device, [&] {
    const Vec force = {1, 0, 0};
    hd().disable(0x4000);
    hd().set_double(0x2700, force.data());
  });
  EXPECT_EQ(applied(device), (Vec{0, 0, 0}));
  tick([] { hd().enable(0x4000); });
  tick([&] {
    const Vec force = {1, 0, 0};
    hd().begin(device);
    hd().set_double(0x2700, force.data());
    hd().end(device);
    EXPECT_EQ(applied(device), (Vec{1, 0, 0}));
    hd().disable(0x4000);
    EXPECT_EQ(applied(device), (Vec{0, 0, 0})) << "at once";
    hd().enable(0x4000);
  });
  frame_with_force(device, {1, 0, 0});
  EXPECT_EQ(applied(device), (Vec{1, 0, 0}));
  hd().stop();
  EXPECT_EQ(applied(device), (Vec{0, 0, 0}));
}

TEST_F(FakeHd, ClampKeepsTheDirection) {
  reset(R"({"manual": true, "devices": [{"calibration": "none", "ramp_s": 0, "impulse_limit": 1000}]})");
  const unsigned device = started();
  frame_with_force(device, {30, 40, 0});
  EXPECT_NEAR(applied(device)[0], 1.98, 1e-12);
  EXPECT_NEAR(applied(device)[1], 2.64, 1e-12);
  EXPECT_NEAR(FAKEHD(fakehd_peak_force)(device), 3.3, 1e-12);
  Vec asked{};
  FAKEHD(fakehd_commanded_force)(device, asked.data());
  EXPECT_EQ(asked, (Vec{30, 40, 0}));
}

TEST_F(FakeHd, WithoutTheClampTooMuchTurnsItOff) {
  const unsigned device = started();
  tick([] { hd().disable(0x4001); });
  frame(device, [] {
    const Vec force = {3.4, 0, 0};
    hd().set_double(0x2700, force.data());
  });
  tick([] { EXPECT_EQ(next_error(), 0x201u); });
  EXPECT_EQ(applied(device), (Vec{0, 0, 0}));
  for (int i = 0; i < 98; ++i) frame_with_force(device, {1, 0, 0});
  EXPECT_EQ(applied(device), (Vec{0, 0, 0})) << "amplifiers are off for a tenth of a second";
  frame_with_force(device, {1, 0, 0});
  EXPECT_EQ(applied(device), (Vec{1, 0, 0}));
}

TEST_F(FakeHd, ForceRampsAfterTheStartAndAfterAFault) {
  reset(R"({"manual": true, "devices": [{"calibration": "none", "ramp_s": 0.01}],
            "faults": [{"tick": 20, "kind": "exceeded_force"}]})");
  const unsigned device = started();
  double before = 0;
  for (int i = 1; i <= 19; ++i) {
    frame_with_force(device, {1, 0, 0});
    EXPECT_NEAR(applied(device)[0], std::min(1.0, i * 0.1), 1e-12);
    EXPECT_GE(applied(device)[0], before);
    before = applied(device)[0];
  }
  tick([] { EXPECT_EQ(next_error(), 0x201u); });
  for (int i = 1; i <= 99; ++i) frame_with_force(device, {1, 0, 0});
  EXPECT_EQ(applied(device)[0], 0);
  frame_with_force(device, {1, 0, 0});
  EXPECT_NEAR(applied(device)[0], 0.1, 1e-12);
}

TEST_F(FakeHd, ForceThatChangesTooFast) {
  const unsigned device = started();
  frame_with_force(device, {2, 0, 0});
  EXPECT_EQ(FAKEHD(fakehd_errors_pending)(), 0u);
  frame_with_force(device, {-1.4, 0, 0});  // 3.4 N/ms; 3.3 by default
  EXPECT_EQ(applied(device), (Vec{0, 0, 0}));
  tick([] { EXPECT_EQ(next_error(), 0x202u); });
  EXPECT_NEAR(FAKEHD(fakehd_peak_slew)(device), 2, 1e-12);
}

TEST_F(FakeHd, HandThatMovesTooFast) {
  reset(R"({"manual": true, "devices": [{"calibration": "none", "velocity_limit": 100, "hand":
            {"points": [{"t": 0, "x": 0}, {"t": 0.1, "x": 0.03}]}}]})");
  const unsigned device = started();
  double fastest = 0;
  while (FAKEHD(fakehd_errors_pending)() == 0 && FAKEHD(fakehd_ticks)() < 200) {
    frame(device, [&] { fastest = std::max(fastest, size(read(0x2051))); });
  }
  tick([] { EXPECT_EQ(next_error(), 0x203u); });
  EXPECT_GT(fastest, 100);
}

TEST_F(FakeHd, MotorsWarmWithTheSquareOfTheForce) {
  const unsigned device = started();
  for (int i = 0; i < 101; ++i) frame_with_force(device, {0.88, 1.76, 0});
  std::array<double, 3> warm{};
  frame(device, [&] { hd().get_double(0x2605, warm.data()); });
  EXPECT_NEAR(warm[0], 0.6 * 0.101 / 60, 1e-5);
  EXPECT_NEAR(warm[1] / warm[0], 4, 1e-9);
  FAKEHD(fakehd_run_ticks)(100);
  EXPECT_LT(FAKEHD(fakehd_temperature)(device), warm[1]);
  FAKEHD(fakehd_set_temperature)(device, 0.95);
  frame(device, [] { EXPECT_EQ(next_error(), 0u); });
  frame_with_force(device, {0.1, 0, 0});
  tick([] { EXPECT_EQ(next_error(), 0x200u); });
}

TEST_F(FakeHd, TorqueNeedsSixMotors) {
  misuse_expected = true;
  const Vec torque = {1, 2, 3};
  frame(started(), [&] {
    hd().set_double(0x2704, torque.data());
    EXPECT_EQ(next_error(), 0x102u);
  });
  reset(R"({"manual": true, "devices": [{"calibration": "none", "output_dof": 6}]})");
  const unsigned device = started();
  frame(device, [&] { hd().set_double(0x2704, torque.data()); });
  Vec sent{};
  FAKEHD(fakehd_last_torque)(device, sent.data());
  EXPECT_EQ(sent, torque);
}

TEST_F(FakeHd, JointTorqueTakesThePlaceOfTheForce) {
  const unsigned device = started();
  const Vec v = {1, 1, 1};
  frame(device, [&] {
    hd().set_double(0x2700, v.data());
    hd().set_double(0x2703, v.data());
  });
  EXPECT_EQ(applied(device), (Vec{0, 0, 0}));
}

TEST_F(FakeHd, ForceThatIsNoNumber) {
  misuse_expected = true;
  const unsigned device = started();
  frame_with_force(device, {std::numeric_limits<double>::quiet_NaN(), 0, 0});
  tick([] { EXPECT_EQ(next_error(), 0x204u); });
  EXPECT_EQ(applied(device), (Vec{0, 0, 0}));
  EXPECT_EQ(FAKEHD(fakehd_misuse)(), 1u);
}

TEST_F(FakeHd, ForcePushesTheHandAgainstItsGrip) {
  const unsigned device = started();
  for (int i = 0; i < 2000; ++i) frame_with_force(device, {0, 0.3, 0});
  EXPECT_NEAR(position(device)[1], 0.3 / 150, 1e-9);  // a spring of 150 N/m
  frame(device, [] { EXPECT_NEAR(read(0x2050)[1], 2, 1e-6); });
  EXPECT_NEAR(FAKEHD(fakehd_work)(device), 0.3 * 0.3 / 150, 1e-9);
}

TEST_F(FakeHd, HandFollowsItsPoints) {
  reset(R"({"manual": true, "devices": [{"calibration": "none", "hand": {"stiffness": 5000, "damping": 40,
            "points": [{"t": 0.1, "x": 0.01}, {"t": 0.3, "x": 0.03}]}}]})");
  const unsigned device = started();
  FAKEHD(fakehd_run_ticks)(100);
  EXPECT_NEAR(position(device)[0], 0.01, 1e-9);
  FAKEHD(fakehd_run_ticks)(100);
  // Half the way at the highest speed, 15/8 of the mean, and behind by damping / stiffness.
  EXPECT_NEAR(position(device)[0], 0.02 - 0.1 * 1.875 * 40 / 5000, 1e-4);
  double velocity[3];
  FAKEHD(fakehd_velocity)(device, velocity);
  EXPECT_NEAR(velocity[0], 0.1 * 1.875, 0.01);
  FAKEHD(fakehd_run_ticks)(1000);
  EXPECT_NEAR(position(device)[0], 0.03, 1e-9);
}

TEST_F(FakeHd, StallTurnsTheForceOff) {
  reset(R"({"manual": true, "stall_limit_s": 0.05, "devices": [{"calibration": "none", "ramp_s": 0}]})");
  const unsigned device = started();
  frame(device, [&] {
    FAKEHD(fakehd_stall)(0.04);
    EXPECT_NEAR(hd().time_stamp(), 0.04, 1e-12);
    EXPECT_EQ(next_error(), 0u);
  });
  frame(device, [&] {
    FAKEHD(fakehd_stall)(0.06);
    EXPECT_EQ(next_error(), 0x300u);
    const Vec force = {1, 0, 0};
    hd().set_double(0x2700, force.data());
  });
  EXPECT_EQ(applied(device), (Vec{0, 0, 0}));
  FAKEHD(fakehd_run_ticks)(99);
  frame_with_force(device, {1, 0, 0});
  EXPECT_EQ(applied(device), (Vec{1, 0, 0})) << "it comes back by itself";
}

}  // namespace
}  // namespace fakehd_test
