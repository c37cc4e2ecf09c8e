// A loop round a body, driven by the double of HDAPI with a simulated hand in it, and every fault that the double can
// make, at many ticks.
#include <array>
#include <atomic>
#include <chrono>
#include <thread>

#include "crumble/base/clock.hpp"
#include "fakehd/phantom_rig.hpp"
#include "haptics/loop_rig.hpp"

namespace crumble {
namespace {

// Waits above the body, touches it after 1.2 s, and presses 4 mm deep.
constexpr const char* kPressingHand =
    R"("hand": {"points": [{"t": 0, "y": 0.002}, {"t": 1.2, "y": 0.002}, {"t": 1.5, "y": -0.004}]}, )";

struct PhantomLoop {
  explicit PhantomLoop(const std::function<void(LoopDef&)>& change = {})
      : device(open_phantom(fake_options())), sim(small_body(4)) {
    LoopDef def;
    def.watchdog = false;  // the ticks do not follow the clock
    HandDef hand;
    hand.device = device.get();
    hand.workspace.pose.position = {0, kTop + kRadius, 0};
    def.hands = {hand};
    if (change) change(def);
    loop = std::make_unique<HapticLoop>(sim, def);
  }
  HandStatus hand() const { return loop->status().hands[0]; }
  void run(long ticks) { EXPECT_EQ(FAKEHD(fakehd_run_ticks)(ticks), ticks); }

  std::unique_ptr<Device> device;
  Simulation sim;
  std::unique_ptr<HapticLoop> loop;
};

class PhantomLoopTest : public PhantomTest {};

TEST_F(PhantomLoopTest, PressesAndIsPressedBack) {
  reset(script(kPressingHand));
  PhantomLoop rig;
  rig.loop->start();
  rig.run(1000);
  EXPECT_EQ(rig.hand().state, HandState::running);
  rig.run(1500);
  EXPECT_EQ(rig.hand().fault, Fault::none) << reason(rig.hand().fault);
  EXPECT_GT(rig.hand().force.y(), 0.05);
  EXPECT_LT((applied() - rig.hand().force).norm(), 1e-12) << "what the loop sends is what the motors get";
  EXPECT_LT(FAKEHD(fakehd_work)(0), 1e-6) << "the body gives the hand no energy";
  EXPECT_LE(FAKEHD(fakehd_peak_slew)(0), 0.3 + 1e-9) << "N a tick";
  EXPECT_EQ(rig.loop->status().ticks, 2500u);
  rig.loop->stop();
  EXPECT_EQ(applied(), Vec3(0, 0, 0));
}

TEST_F(PhantomLoopTest, NothingPushesBeforeItIsCalibrated) {
  reset(std::string(R"({"manual": true, "devices": [{)") + kPressingHand + R"("inkwell_at_s": 2, "ramp_s": 0}]})");
  PhantomLoop rig;
  rig.loop->start();
  for (int i = 0; i < 20; ++i) {
    rig.run(100);
    EXPECT_EQ(applied(), Vec3(0, 0, 0));
    EXPECT_EQ(rig.hand().state, HandState::waiting);
  }
  rig.run(1500);
  EXPECT_EQ(rig.hand().fault, Fault::none) << "the jump of the calibration is none of the hand's";
  EXPECT_EQ(FAKEHD(fakehd_calibrated)(0), 1);
}

// What the fault is, what the loop makes of it, and whether it may come back by itself.
struct Injected {
  const char* kind;
  Fault fault;  // none: it must be borne
};
void PrintTo(const Injected& injected, std::ostream* out) {
  *out << injected.kind;
}
class EveryTick : public PhantomLoopTest, public testing::WithParamInterface<Injected> {};

TEST_P(EveryTick, ZeroForceInTimeAReasonAndBackOnRequest) {
  const auto& [kind, fault] = GetParam();
  constexpr long kTicks = 2000;
  for (long at = 2; at < kTicks; at += 61) {
    SCOPED_TRACE(at);
    reset(script(kPressingHand,
                 R"("faults": [{"kind": ")" + std::string(kind) + R"(", "tick": )" + std::to_string(at) + "}], "));
    PhantomLoop rig;
    rig.loop->start();
    rig.run(at);
    const Vec3 now = applied();
    EXPECT_TRUE(is_finite(now));
    rig.run(2);  // a jump counts as one when it happens twice
    EXPECT_EQ(rig.hand().fault, fault) << reason(rig.hand().fault);
    if (fault != Fault::none) {
      EXPECT_EQ(applied(), Vec3(0, 0, 0));
      rig.run(200);
      EXPECT_EQ(rig.hand().fault, fault) << "it stays until somebody resets it";
      EXPECT_EQ(applied(), Vec3(0, 0, 0));
      rig.loop->reset_fault(0);
      rig.run(50);
      EXPECT_EQ(rig.hand().fault, fault == Fault::device_lost ? fault : Fault::none) << reason(rig.hand().fault);
      EXPECT_EQ(applied(), Vec3(0, 0, 0)) << "the interlock comes first";
    }
    EXPECT_LE(FAKEHD(fakehd_peak_force)(0), 3.0 + 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Faults, EveryTick,
    testing::Values(Injected{"comm_error", Fault::device_lost}, Injected{"timer_error", Fault::device_lost},
                    Injected{"device_fault", Fault::driver}, Injected{"exceeded_force", Fault::driver},
                    Injected{"exceeded_velocity", Fault::driver}, Injected{"nan_position", Fault::not_finite},
                    Injected{"inf_velocity", Fault::not_finite}, Injected{"bad_transform", Fault::bad_pose},
                    Injected{"teleport", Fault::none}, Injected{"freeze", Fault::none},
                    Injected{"warm_motors", Fault::none}),
    [](const auto& param) { return std::string(param.param.kind); });

TEST_F(PhantomLoopTest, ATeleportThatLastsLetsGo) {
  for (long at = 1; at < 2000; at += 113) {
    reset(
        script(kPressingHand, R"("faults": [{"kind": "teleport", "count": 5, "tick": )" + std::to_string(at) + "}], "));
    PhantomLoop rig;
    rig.loop->start();
    rig.run(at + 3);
    EXPECT_EQ(rig.hand().fault, at > 1 ? Fault::speed : Fault::none) << at;
    EXPECT_EQ(applied(), Vec3(0, 0, 0));
  }
}

TEST_F(PhantomLoopTest, HotMotorsGetLess) {
  reset(script(std::string(kPressingHand) + R"("continuous_force": 0.2, )",
               R"("faults": [{"kind": "warm_motors", "count": 100000, "tick": 2000}], )"));
  PhantomLoop rig([](LoopDef& def) { def.hands[0].workspace.force_gain = 20; });
  rig.loop->start();
  rig.run(1999);
  EXPECT_GT(applied().norm(), 0.4) << "more than the motors bear for long";
  rig.run(4000);
  EXPECT_GT(rig.hand().counters.heated, 1000u);
  EXPECT_LE(applied().norm(), 0.2 + 1e-9);
  EXPECT_EQ(rig.hand().fault, Fault::none);
}

/// A device whose n-th read takes 60 ms.
class Slow final : public Device {
 public:
  Slow(Device& device, int at) : device_(device), at_(at) {}
  const DeviceInfo& info() const noexcept override { return device_.info(); }
  ReadStatus read(DeviceSample& sample) noexcept override {
    const ReadStatus status = device_.read(sample);
    if (--at_ == 0) FAKEHD(fakehd_stall)(0.06);
    return status;
  }
  void write(const Vec3& force, const Vec3& torque) noexcept override { device_.write(force, torque); }
  void start_servo(const ServoTick& tick) override { device_.start_servo(tick); }
  void stop_servo() noexcept override { device_.stop_servo(); }

 private:
  Device& device_;
  int at_;
};

TEST_F(PhantomLoopTest, ATickThatTakesTooLongStopsTheMotors) {
  for (int at = 1; at < 2000; at += 199) {
    reset(script(kPressingHand, R"("stall_limit_s": 0.05, )"));
    std::unique_ptr<Slow> slow;
    PhantomLoop rig([&](LoopDef& def) {
      slow = std::make_unique<Slow>(*def.hands[0].device, at);
      def.hands[0].device = slow.get();
    });
    rig.loop->start();
    rig.run(at + 1);
    EXPECT_EQ(applied(), Vec3(0, 0, 0));
    rig.run(500);
    EXPECT_EQ(rig.hand().fault, Fault::driver);
    EXPECT_TRUE(mentions(rig.device->error_text(), "tick may have taken too long")) << rig.device->error_text();
    rig.loop.reset();
  }
}

TEST_F(PhantomLoopTest, TwoHandsOnOneThread) {
  reset(R"({"manual": true, "devices": [{"name": "left", "calibration": "none", "ramp_s": 0},
                                        {"name": "right", "calibration": "none", "ramp_s": 0}]})");
  PhantomOptions options = fake_options();
  options.name = "left";
  const auto left = open_phantom(options);
  options.name = "right";
  const auto right = open_phantom(options);
  SimulationDef body = small_body(4);
  body.tools.push_back(body.tools[0]);
  Simulation sim(std::move(body));
  LoopDef def;
  def.watchdog = false;
  HandDef hand;
  hand.device = left.get();
  hand.workspace.pose.position = {0, kTop + kRadius + 0.002, 0};
  def.hands = {hand, hand};
  def.hands[1].device = right.get();
  def.hands[1].holder = 1;
  def.hands[1].workspace.pose.position.x() = 0.5;
  HapticLoop loop(sim, def);
  loop.start();
  FAKEHD(fakehd_run_ticks)(1000);
  EXPECT_EQ(loop.status().hands[0].state, HandState::running);
  EXPECT_EQ(loop.status().hands[1].state, HandState::running);
  FAKEHD(fakehd_unplug)(1);
  FAKEHD(fakehd_run_ticks)(10);
  EXPECT_EQ(loop.status().hands[0].state, HandState::running) << "the other goes on";
  EXPECT_EQ(loop.status().hands[1].fault, Fault::device_lost);
}

template <class Done>
bool wait_for(Done&& done) {
  for (const double start = wall_seconds(); wall_seconds() - start < 20;) {
    if (done()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

// With threads, in the ways that a loop can be driven. Nothing here depends on how fast the machine is.
class PhantomThreads : public PhantomLoopTest, public testing::WithParamInterface<LoopDriver> {};

TEST_P(PhantomThreads, RunsIsUnpluggedAndIsOpenedAgain) {
  reset(R"({"devices": [{"calibration": "none", "ramp_s": 0}]})");
  for (int round = 0; round < 2; ++round) {
    PhantomLoop rig([&](LoopDef& def) {
      def.driver = GetParam();
      def.watchdog = true;
      def.hands[0].workspace.pose.position.y() += 0.002;
    });
    const unsigned handle = static_cast<unsigned>(round);
    rig.loop->start();
    const auto running = [&] {
      if (GetParam() == LoopDriver::host) rig.loop->tick();
      if (rig.hand().fault == Fault::stalled || rig.hand().fault == Fault::silent) rig.loop->reset_fault(0);
      return rig.hand().state == HandState::running;
    };
    EXPECT_TRUE(wait_for(running)) << reason(rig.hand().fault);
    FAKEHD(fakehd_unplug)(handle);
    EXPECT_TRUE(wait_for([&] {
      if (GetParam() == LoopDriver::host) rig.loop->tick();
      return rig.hand().fault == Fault::device_lost || rig.hand().fault == Fault::stalled;
    }));
    rig.loop->stop();
    EXPECT_EQ(applied(handle), Vec3(0, 0, 0));
    FAKEHD(fakehd_replug)(handle);
  }
}

INSTANTIATE_TEST_SUITE_P(Drivers, PhantomThreads,
                         testing::Values(LoopDriver::automatic, LoopDriver::own_thread, LoopDriver::host),
                         [](const auto& param) {
                           return param.param == LoopDriver::automatic    ? "Automatic"
                                  : param.param == LoopDriver::own_thread ? "OwnThread"
                                                                          : "Host";
                         });

}  // namespace
}  // namespace crumble
