// Loops with threads of their own. Nothing here depends on how fast the machine is.
#include <atomic>
#include <thread>

#include "crumble/base/clock.hpp"
#include "crumble/device/hand.hpp"
#include "haptics/loop_rig.hpp"

namespace crumble {
namespace {

HandOptions pressing_hand() {
  HandOptions options;
  options.start.position.y() = 0.001;
  options.points = {{.time = 0.7}, {.time = 1.0, .move = {0, -0.005, 0}}, {.time = 60, .move = {0, -0.006, 0}}};
  return options;
}

/// True as soon as `done()`, false when it was not for ten seconds.
template <class Done>
bool wait_for(Done&& done) {
  for (const double start = wall_seconds(); wall_seconds() - start < 10;) {
    if (done()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

struct ThreadedRig {
  explicit ThreadedRig(const std::function<void(LoopDef&)>& change) : hand(pressing_hand(), 1e-3), sim(small_body()) {
    LoopDef def;
    HandDef h;
    h.device = &hand;
    h.workspace.pose.position = {0, kTop + kRadius, 0};
    def.hands = {h};
    change(def);
    loop = std::make_unique<HapticLoop>(sim, def);
  }
  SimulatedHand hand;
  Simulation sim;
  std::unique_ptr<HapticLoop> loop;
};

void expect_presses(ThreadedRig& rig) {
  rig.loop->start();
  EXPECT_TRUE(rig.loop->running());
  EXPECT_TRUE(wait_for([&] {
    const HandStatus hand = rig.loop->status().hands[0];
    return hand.force.y() > 0.02 || hand.state == HandState::faulted;
  }));
  // on a machine that stood still for 20 ms the loop has done what it should: let go, with a reason
  const HandStatus hand = rig.loop->status().hands[0];
  EXPECT_TRUE(hand.fault == Fault::none || hand.fault == Fault::stalled) << reason(hand.fault);
  rig.loop->stop();
  EXPECT_FALSE(rig.loop->running());
  const LoopTimes times = rig.loop->times();
  EXPECT_GT(times.tick_wall.count, 300u);
  EXPECT_GE(times.tick_wall.max, times.tick_wall.p99);
  EXPECT_EQ(rig.loop->status().hands[0].force, Vec3(0, 0, 0));
  EXPECT_GT(rig.loop->status().steps, 50u);
}

TEST(Threads, OwnThread) {
  ThreadedRig rig([](LoopDef&) {});
  expect_presses(rig);
  EXPECT_FALSE(rig.loop->realtime().empty());  // given, or why not
  EXPECT_GT(rig.loop->times().tick_cpu.count, 300u);
}

TEST(Threads, BodyInAThreadOfItsOwn) {
  ThreadedRig rig([](LoopDef& def) {
    def.coupling = BodyCoupling::local_model;
    def.body_thread = true;
  });
  expect_presses(rig);
}

TEST(Threads, StatusAndCommandsFromOthersWhileItRuns) {
  ThreadedRig rig([](LoopDef&) {});
  StatePublisher publisher(rig.sim);
  rig.loop->publish_to(publisher);
  rig.loop->start();
  std::atomic<bool> stop{false};
  std::thread reader([&] {
    std::uint64_t before = 0;
    while (!stop) {
      const LoopStatus status = rig.loop->status();
      EXPECT_GE(status.ticks, before);
      before = status.ticks;
      publisher.latest();
      static_cast<void>(rig.loop->times());
    }
  });
  EXPECT_TRUE(wait_for([&] { return rig.loop->status().ticks > 50; }));
  rig.loop->halt();
  EXPECT_TRUE(wait_for([&] { return rig.loop->status().hands[0].state == HandState::faulted; }));
  rig.loop->reset_fault(0);
  EXPECT_TRUE(wait_for([&] { return rig.loop->status().hands[0].state != HandState::faulted; }));
  rig.loop->reset_fault(99);
  stop = true;
  reader.join();
  rig.loop->stop();
}

/// A device whose driver calls, as HDAPI's scheduler does.
class Driving final : public Puppet {
 public:
  Driving() { Puppet::info().servo_driven = true; }
  ~Driving() override { Driving::stop_servo(); }
  void start_servo(const ServoTick& tick) override {
    stopping_ = false;
    thread_ = std::thread([this, tick] {
      while (!stopping_ && tick.call(tick.context)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    });
  }
  void stop_servo() noexcept override {
    stopping_ = true;
    if (thread_.joinable()) thread_.join();
  }

 private:
  std::thread thread_;
  std::atomic<bool> stopping_{false};
};

TEST(Threads, TheDeviceDrives) {
  Driving device;
  device.sample.pose.position.y() = 0.002;
  Simulation sim(small_body());
  LoopDef def;
  def.driver = LoopDriver::device;
  HandDef hand;
  hand.device = &device;
  hand.workspace.pose.position = {0, kTop + kRadius, 0};
  def.hands = {hand};
  HapticLoop loop(sim, def);
  loop.start();
  EXPECT_TRUE(wait_for([&] { return loop.status().hands[0].state == HandState::running; }));
  loop.stop();
  const std::uint64_t ticks = loop.status().ticks;
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(loop.status().ticks, ticks);
  EXPECT_EQ(loop.times().tick_cpu.count, 0u);
  EXPECT_TRUE(loop.realtime().empty());
}

TEST(Threads, ADeviceThatStopsCallingIsToldAtOnceAndWhenItComesBack) {
  Caller caller;
  caller.sample.pose.position.y() = 0.002;
  LoopRig rig([&](LoopDef& def) {
    def.driver = LoopDriver::automatic;
    def.hands[0].device = &caller;
  });
  rig.loop->start();
  caller.turn(3);
  EXPECT_TRUE(wait_for([&] { return rig.loop->status().hands[0].fault == Fault::stalled; }));
  EXPECT_EQ(rig.loop->status().watchdog, 1u);
  const std::uint64_t writes = caller.writes;
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  EXPECT_EQ(caller.writes, writes) << "its calls belong to its own thread";
  caller.turn();
  EXPECT_EQ(rig.loop->status().hands[0].state, HandState::faulted);
  EXPECT_EQ(caller.force, Vec3(0, 0, 0));
}

TEST(Threads, ALoopThatGoesAwayStops) {
  auto rig = std::make_unique<ThreadedRig>([](LoopDef&) {});
  rig->loop->start();
  rig->loop.reset();
  rig->loop = nullptr;
}

}  // namespace
}  // namespace crumble
