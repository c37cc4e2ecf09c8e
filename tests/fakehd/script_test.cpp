// What the script can ask for: calibration, faults, motion.
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "rig.hpp"

namespace fakehd_test {
namespace {

namespace fs = std::filesystem;

class TemporaryFolder {
 public:
  TemporaryFolder() {
    static int count = 0;  // the loader knows a library by its path, also when the file is another one
    path_ = fs::temp_directory_path() / ("fakehd_" + std::to_string(getpid()) + "_" + std::to_string(count++));
    fs::create_directories(path_);
  }
  ~TemporaryFolder() { fs::remove_all(path_); }
  fs::path write(const char* name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
    return path_ / name;
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

class Faults : public FakeHd {
 protected:
  /// Of one device, moving to the right at some speed, with one fault at tick 5.
  unsigned start_with(const std::string& fault) {
    reset((R"({"manual": true, "devices": [{"calibration": "none", "ramp_s": 0, "hand": {"points":
               [{"t": 0}, {"t": 1, "x": 0.1}]}}], "faults": [{"tick": 5, )" +
           fault + "}]}")
              .c_str());
    const unsigned device = started();
    FAKEHD(fakehd_run_ticks)(4);
    return device;
  }
};

TEST_F(FakeHd, InkwellCalibration) {
  reset(R"({"manual": true, "devices": [{"inkwell_at_s": 0.0105, "uncalibrated_mm": [1, 2, 3]}]})");
  const unsigned device = hd().init(nullptr);
  EXPECT_EQ(hd().calibration_style(), 4u);
  hd().start();
  frame(device, [] {
    EXPECT_EQ(hd().calibration(), 0x5002u);
    EXPECT_EQ(read(0x2050), (Vec{1, 2, 3}));
    EXPECT_EQ(read(0x2100), (Vec{0, 0, 0}));
    hd().calibrate(4);
    EXPECT_EQ(next_error(), 0x102u);
  });
  FAKEHD(fakehd_run_ticks)(10);
  frame(device, [] {
    unsigned char outside = 9;
    hd().get_boolean(0x2002, &outside);
    EXPECT_EQ(outside, 0);
    EXPECT_EQ(hd().calibration(), 0x5001u);
    hd().calibrate(4);
    EXPECT_EQ(hd().calibration(), 0x5000u);
    EXPECT_EQ(read(0x2050), (Vec{1, 2, 3})) << "of this frame";
  });
  frame(device, [] {
    EXPECT_EQ(read(0x2050), (Vec{0, 0, 0})) << "jumped";
    EXPECT_NE(read(0x2100)[1], 0);
  });
  EXPECT_EQ(FAKEHD(fakehd_calibrated)(device), 1);
}

TEST_F(FakeHd, StylusTakenOutTooEarly) {
  reset(R"({"manual": true, "devices": [{"inkwell_for_s": 0.01}]})");
  const unsigned device = hd().init(nullptr);
  hd().start();
  tick([] { EXPECT_EQ(hd().calibration(), 0x5001u); });
  FAKEHD(fakehd_run_ticks)(20);
  tick([] { EXPECT_EQ(hd().calibration(), 0x5002u); });
  FAKEHD(fakehd_inkwell)(device, 1);
  tick([] { EXPECT_EQ(hd().calibration(), 0x5001u); });
}

TEST_F(FakeHd, AutoCalibration) {
  reset(R"({"manual": true, "devices": [{"calibration": "auto", "auto_after_s": 0.0045}]})");
  hd().init(nullptr);
  EXPECT_EQ(hd().calibration_style(), 2u);
  hd().start();
  FAKEHD(fakehd_run_ticks)(3);
  tick([] { EXPECT_EQ(hd().calibration(), 0x5002u); });
  tick([] {
    EXPECT_EQ(hd().calibration(), 0x5001u);
    hd().calibrate(2);
    EXPECT_EQ(hd().calibration(), 0x5000u);
  });
}

TEST_F(FakeHd, EncoderReset) {
  misuse_expected = true;
  reset(R"({"devices": [{"calibration": "encoder_reset"}]})");
  hd().init(nullptr);
  EXPECT_EQ(hd().calibration_style(), 1u);
  EXPECT_EQ(hd().calibration(), 0x5002u);
  EXPECT_EQ(FAKEHD(fakehd_misuse)(), 0u);
  hd().calibrate(4);
  EXPECT_EQ(next_error(), 0x101u);
  hd().calibrate(1);
  EXPECT_EQ(hd().calibration(), 0x5000u);
}

TEST_F(FakeHd, ForceBeforeTheCalibrationIsMisuse) {
  misuse_expected = true;
  reset(R"({"manual": true})");
  frame_with_force(started(), {1, 0, 0});
  EXPECT_STREQ(FAKEHD(fakehd_misuse_text)(), "a force before the calibration");
}

TEST_F(Faults, CommunicationErrorStaysAndThePoseStands) {
  const unsigned device = start_with(R"("kind": "comm_error")");
  Vec last{};
  frame(device, [&] {
    const Error error = hd().error();
    EXPECT_EQ(error.code, 0x302u);
    EXPECT_EQ(error.device, device);
    EXPECT_EQ(error.internal, -28);
    last = read(0x2050);
  });
  FAKEHD(fakehd_run_ticks)(20);
  frame(device, [&] {
    EXPECT_EQ(next_error(), 0x302u);
    EXPECT_EQ(read(0x2050), last);
  });
  EXPECT_EQ(FAKEHD(fakehd_errors_pushed)(), 22u);
}

TEST_F(FakeHd, PulledPlugNeedsANewInit) {
  const unsigned device = started();
  FAKEHD(fakehd_unplug)(device);
  frame_with_force(device, {1, 0, 0});
  EXPECT_EQ(applied(device), (Vec{0, 0, 0}));
  FAKEHD(fakehd_replug)(device);
  tick([] {
    EXPECT_EQ(next_error(), 0x302u);
    EXPECT_EQ(next_error(), 0x302u);
  });
  hd().stop();
  hd().disable_device(device);
  FAKEHD(fakehd_unplug)(device);
  EXPECT_EQ(hd().init(nullptr), 0xFFFFFFFFu);
  EXPECT_EQ(next_error(), 0x302u);
  FAKEHD(fakehd_replug)(device);
  EXPECT_EQ(hd().init(nullptr), device + 1);
}

TEST_F(Faults, ErrorsComeForTheirTicks) {
  const std::pair<const char*, unsigned> kinds[] = {
      {R"("kind": "device_fault")", 0x300},       {R"("kind": "timer_error")", 0x304},
      {R"("kind": "warm_motors")", 0x200},        {R"("kind": "exceeded_force")", 0x201},
      {R"("kind": "exceeded_velocity")", 0x203},  {R"("kind": "error", "code": 1025)", 0x401},
      {R"("kind": "error", "code": 770)", 0x302},
  };
  for (const auto& [kind, code] : kinds) {
    const unsigned device = start_with(std::string(kind) + R"(, "count": 2)");
    EXPECT_EQ(FAKEHD(fakehd_errors_pushed)(), 0u);
    for (int i = 0; i < 2; ++i) frame(device, [c = code] { EXPECT_EQ(next_error(), c); });
    frame(device, [] { EXPECT_EQ(next_error(), 0u); });
  }
}

TEST_F(Faults, PositionIsNoNumber) {
  const unsigned device = start_with(R"("kind": "nan_position")");
  frame(device, [] {
    std::array<double, 16> m{};
    hd().get_double(0x2052, m.data());
    EXPECT_TRUE(std::isnan(read(0x2050)[1]));
    EXPECT_TRUE(std::isnan(m[13]));
  });
  frame(device, [] { EXPECT_FALSE(std::isnan(read(0x2050)[1])); });
}

TEST_F(Faults, VelocityIsInfinite) {
  const unsigned device = start_with(R"("kind": "inf_velocity")");
  frame(device, [] { EXPECT_TRUE(std::isinf(read(0x2051)[0])); });
  frame(device, [] { EXPECT_FALSE(std::isinf(read(0x2051)[0])); });
}

TEST_F(Faults, PositionJumpsAndStands) {
  const unsigned device = start_with(R"("kind": "teleport")");
  frame(device, [] { EXPECT_NEAR(read(0x2050)[0], 50, 1); });
  frame(device, [] { EXPECT_NEAR(read(0x2050)[0], 0, 1); });
  const unsigned other = start_with(R"("kind": "freeze", "count": 50)");
  Vec at{};
  frame(other, [&] { at = read(0x2050); });
  FAKEHD(fakehd_run_ticks)(48);
  frame(other, [&] { EXPECT_EQ(read(0x2050), at); });
  frame(other, [&] { EXPECT_NE(read(0x2050), at); });
}

TEST_F(Faults, TransformIsNone) {
  const unsigned device = start_with(R"("kind": "bad_transform")");
  frame(device, [] {
    std::array<double, 16> m{};
    hd().get_double(0x2052, m.data());
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(m[i], m[4 + i]);
  });
}

TEST_F(FakeHd, InitMayFailForAWhile) {
  reset(R"({"faults": [{"kind": "init_error", "count": 2}]})");
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(hd().init(nullptr), 0xFFFFFFFFu);
    EXPECT_EQ(next_error(), 0x300u);
  }
  EXPECT_EQ(hd().init(nullptr), 0u);
}

TEST_F(FakeHd, FollowsATrajectory) {
  const TemporaryFolder folder;
  const fs::path file = folder.write("turn.ctraj",
                                     "# crumble-traj 1\n"
                                     "# units: m s N N*m rad\n"
                                     "t,px,py,pz,qx,qy,qz,qw,buttons\n"
                                     "3,0,0,0,0,0,0,1,0\n"
                                     "3.1,0.1,0,0,0,0,1,0,2\n"
                                     "# end rows=2\n");
  reset((R"({"manual": true, "devices": [{"calibration": "none", "trajectory": ")" + file.string() + "\"}]}").c_str());
  const unsigned device = hd().init(nullptr);
  hd().start();
  frame(device, [] { EXPECT_NEAR(read(0x2051)[0], 1000.0 / 8, 1e-6) << "smoothed"; });
  frame(device, [] { EXPECT_NEAR(read(0x2051)[0], 1000.0 * (1 - 49.0 / 64), 1e-6); });
  FAKEHD(fakehd_run_ticks)(47);
  frame(device, [] {
    std::array<double, 16> m{};
    hd().get_double(0x2052, m.data());
    EXPECT_NEAR(read(0x2050)[0], 50, 1e-9);
    EXPECT_NEAR(read(0x2051)[0], 1000, 20);
    EXPECT_NEAR(m[0], 0, 1e-9);  // a quarter turn about z
    EXPECT_NEAR(m[1], 1, 1e-3);
  });
  FAKEHD(fakehd_run_ticks)(100);
  frame(device, [] {
    int buttons = 0;
    hd().get_integer(0x2000, &buttons);
    EXPECT_EQ(buttons, 2);
    EXPECT_NEAR(read(0x2050)[0], 100, 1e-9);
  });
}

TEST_F(FakeHd, ReadsTheRecordedMotionOfATouch) {
  const std::string file = CRUMBLE_SOURCE_DIR "/examples/trajectories/touch_motion.ctraj";
  reset((R"({"devices": [{"trajectory": ")" + file + "\"}]}").c_str());
}

TEST_F(FakeHd, BadScriptsAreRefused) {
  for (const char* bad : {"{", R"({"manuel": true})", R"({"devices": [{"calibration": "ink"}]})", "no such file",
                          R"({"devices": [{"output_dof": 4}]})", R"({"faults": [{"kind": "comm_error", "device": 7}]})",
                          R"({"devices": [{"trajectory": "no such file"}]})", R"({"rates": [0]})", "[]",
                          R"({"devices": [{"hand": {"mass": 0}}]})", R"({"devices": [{"hand": {"points": []}}]})"}) {
    EXPECT_EQ(FAKEHD(fakehd_reset)(bad), -1) << bad;
    EXPECT_STRNE(FAKEHD(fakehd_script_error)(), "");
    EXPECT_EQ(hd().init(nullptr), 0xFFFFFFFFu);
    EXPECT_EQ(next_error(), 0x303u);
  }
}

TEST_F(FakeHd, ScriptFromTheEnvironment) {
  const TemporaryFolder folder;
  const fs::path copy = folder.path() / "libcopy.so";  // another file, another state
  fs::copy_file(FAKEHD_LIBRARY, copy);
  const fs::path script = folder.write("script.json", R"({"devices": [{"model": "of the file"}]})");
  setenv("FAKEHD_SCRIPT", script.c_str(), 1);
  const Hd other{Library(copy.c_str())};
  EXPECT_EQ(other.init(nullptr), 0u);
  unsetenv("FAKEHD_SCRIPT");
  EXPECT_STREQ(other.string(0x2501), "FAKE of the file");
}

}  // namespace
}  // namespace fakehd_test
