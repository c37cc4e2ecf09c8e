// What goes wrong, and what the hand feels of it: nothing, in time, with a reason.
#include <atomic>
#include <thread>

#include "crumble/base/clock.hpp"
#include "crumble/geometry/support_solid.hpp"
#include "haptics/loop_rig.hpp"

namespace crumble {
namespace {

/// Pressing, with the force in.
struct Pressing : LoopRig {
  explicit Pressing(const std::function<void(LoopDef&)>& change = {}) : LoopRig(change) {
    let_in();
    move_to(-0.003);
    EXPECT_GT(norm(device.force), 0.1);
  }
  void expect_faulted(Fault fault) {
    EXPECT_EQ(hand().state, HandState::faulted);
    EXPECT_EQ(hand().fault, fault) << reason(hand().fault);
    EXPECT_EQ(device.force, Vec3(0, 0, 0));
    EXPECT_EQ(device.torque, Vec3(0, 0, 0));
    EXPECT_GT(std::string(reason(hand().fault)).size(), 10u);
  }
  /// It stays until it is reset, and then comes in by interlock and ramp.
  void expect_latched_until_reset(Fault fault) {
    tick(300);
    expect_faulted(fault);
    loop->reset_fault(0);
    tick();
    EXPECT_EQ(hand().state, HandState::waiting);
    move_to(0.002);
    tick(50);
    EXPECT_EQ(device.force, Vec3(0, 0, 0));
    tick(800);
    EXPECT_EQ(hand().state, HandState::running);
    move_to(-0.002);
    EXPECT_GT(norm(device.force), 0.05);
    EXPECT_EQ(hand().counters.faults, 1u);
  }
};

TEST(Faults, NotANumber) {
  for (int what = 0; what < 4; ++what) {
    Pressing rig;
    const DeviceSample good = rig.device.sample;
    DeviceSample& s = rig.device.sample;
    if (what == 0) s.pose.position.x() = NAN;
    if (what == 1) s.linear_velocity.y() = INFINITY;
    if (what == 2) s.angular_velocity.z() = NAN;
    if (what == 3) s.pose.orientation.w() = NAN;
    rig.tick();
    rig.expect_faulted(Fault::not_finite);
    s = good;
    rig.expect_latched_until_reset(Fault::not_finite);
    EXPECT_EQ(rig.sim.counters().bad_poses, 0u);
  }
}

TEST(Faults, BadSamplesBreakTheRow) {
  LoopRig rig;
  for (int k = 0; k < 10; ++k) {
    rig.device.sample.pose.position.x() = 0;
    rig.tick(60);
    rig.device.sample.pose.position.x() = k % 2 ? 0.1 : NAN;
    rig.tick();
    rig.loop->reset_fault(0);
    rig.device.sample.pose.position.x() = 0;
    rig.tick(3);
  }
  EXPECT_EQ(rig.hand().state, HandState::waiting);
}

TEST(Faults, NoRotation) {
  Pressing rig;
  rig.device.sample.pose.orientation = Quat(2, 0, 0, 0);
  rig.tick();
  rig.expect_faulted(Fault::bad_pose);
}

TEST(Faults, OneJumpIsAGlitch) {
  Pressing rig;
  const Vec3 before = rig.device.force;
  rig.device.sample.pose.position.x() += 0.02;
  rig.tick();
  EXPECT_EQ(rig.hand().state, HandState::running);
  EXPECT_EQ(rig.hand().counters.held, 1u);
  EXPECT_NEAR(rig.hand().tool.position.x(), 0, 1e-4);
  EXPECT_LT(norm(rig.device.force - before), 0.05);
  rig.device.sample.pose.position.x() -= 0.02;
  rig.tick(50);
  EXPECT_EQ(rig.hand().state, HandState::running);
}

TEST(Faults, TwoJumpsAreATeleport) {
  Pressing rig;
  rig.device.sample.pose.position.x() += 0.02;
  rig.tick(2);
  rig.expect_faulted(Fault::speed);
}

TEST(Faults, TooFast) {
  Pressing rig([](LoopDef& def) { def.hands[0].safety.max_speed = 0.05; });
  for (int k = 0; k < 3; ++k) rig.device.sample.pose.position.x() += 4.9e-5, rig.tick();
  EXPECT_EQ(rig.hand().state, HandState::running);
  for (int k = 0; k < 3; ++k) rig.device.sample.pose.position.x() += 6e-5, rig.tick();
  rig.expect_faulted(Fault::speed);
}

TEST(Faults, Lost) {
  Pressing rig;
  rig.device.status = ReadStatus::lost;
  rig.tick();
  rig.expect_faulted(Fault::device_lost);
  rig.loop->reset_fault(0);
  rig.tick();
  rig.expect_faulted(Fault::device_lost);  // it is still gone
  EXPECT_EQ(rig.hand().counters.faults, 2u);
}

TEST(Faults, Silent) {
  Pressing rig;
  rig.device.status = ReadStatus::no_new_sample;
  rig.tick(18);
  EXPECT_EQ(rig.hand().state, HandState::running);
  EXPECT_GT(norm(rig.device.force), 0.05);
  rig.tick(2);
  rig.expect_faulted(Fault::silent);
  EXPECT_EQ(rig.hand().counters.unanswered, 20u);
}

TEST(Faults, Halt) {
  Pressing rig;
  rig.loop->halt();
  rig.tick();
  rig.expect_faulted(Fault::halted);
  rig.expect_latched_until_reset(Fault::halted);
}

TEST(Faults, Uncalibrated) {
  Pressing rig;
  rig.device.sample.flags = sample_flag::kUncalibrated;
  rig.tick();
  EXPECT_EQ(rig.hand().state, HandState::waiting);
  EXPECT_EQ(rig.device.force, Vec3(0, 0, 0));
  rig.device.sample.pose.position = {0.05, 0.05, 0.05};  // calibration moves it
  rig.tick(10);
  rig.device.sample.flags = 0;
  rig.tick(50);
  EXPECT_EQ(rig.hand().state, HandState::waiting);
  rig.tick(700);
  EXPECT_EQ(rig.hand().state, HandState::running);
}

TEST(Faults, TheBodyLeavesTheWorld) {
  Pressing rig;
  rig.sim.set_node_force(3, {1e11, 0, 0});
  for (int k = 0; k < 5000 && rig.sim.info().status == Code{}; ++k) rig.tick();
  if (rig.sim.info().status == Code{}) {  // held by its neighbours: all of them go
    VecArray forces(rig.sim.mesh().node_count());
    for (std::size_t i = 0; i < forces.size(); ++i) forces.set(i, {1e12, 0, 0});
    rig.sim.set_node_forces(forces);
    for (int k = 0; k < 5000 && rig.sim.info().status == Code{}; ++k) rig.tick();
  }
  ASSERT_EQ(rig.sim.info().status, Code::diverged);
  rig.expect_faulted(Fault::body);
  rig.sim.reset();
  rig.sim.set_node_forces(VecArray(rig.sim.mesh().node_count()));
  rig.expect_latched_until_reset(Fault::body);
}

// A model that does not come any more: full force for two steps, none after 20 ms, monotone between.
TEST(Faults, ABodyThatStopsAnsweringFadesOut) {
  SimulationDef body = small_body();
  Puppet device;
  Simulation sim(body);
  LoopDef def;
  def.driver = LoopDriver::host;
  def.coupling = BodyCoupling::local_model;
  def.body_thread = true;
  HandDef hand;
  hand.device = &device;
  hand.workspace.pose.position = {0, kTop + kRadius, 0};
  def.hands = {hand};
  HapticLoop loop(sim, def);
  device.sample.pose.position.y() = 0.002;
  loop.tick();
  for (int k = 0; k < 30; ++k) loop.tick();  // never started: no answer comes
  EXPECT_EQ(loop.status().hands[0].fault, Fault::stalled);
  EXPECT_EQ(device.force, Vec3(0, 0, 0));
}

// A tool whose support function sleeps makes one step take as long as we like.
struct Sleeper {
  std::atomic<double> seconds{0};
};
void support(void* context, const double direction[3], double point[3]) {
  auto& sleeper = *static_cast<Sleeper*>(context);
  const double wait = sleeper.seconds.exchange(0);
  const double until = wall_seconds() + wait;
  while (wait > 0 && wall_seconds() < until) std::this_thread::yield();
  const double size =
      std::sqrt(direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2]);
  for (int i = 0; i < 3; ++i) point[i] = kRadius * direction[i] / size;
}

/// A puppet that knows when it was last sent what.
class TimedPuppet : public Puppet {
 public:
  void write(const Vec3& f, const Vec3& t) noexcept override {
    Puppet::write(f, t);
    last_size = norm(f);
    last_time = wall_seconds();
  }
  std::atomic<double> last_size{0}, last_time{0};
};

TEST(Faults, AStepThatTakesForEverIsWatched) {
  Sleeper sleeper;
  SimulationDef body = small_body();
  body.tools = {{make_support_solid({support, &sleeper}, Vec3::Zero()), {}}};
  Simulation sim(body);
  TimedPuppet device;
  device.sample.pose.position.y() = 0.002;
  LoopDef def;
  def.driver = LoopDriver::host;
  HandDef hand;
  hand.device = &device;
  hand.workspace.pose.position = {0.003, kTop + kRadius, 0.003};  // above a node
  def.hands = {hand};
  HapticLoop loop(sim, def);
  for (int k = 0; k < 800; ++k) loop.tick();  // without the watchdog: a busy machine may take its time
  for (int k = 0; k < 300; ++k) device.sample.pose.position.y() -= 1e-5, loop.tick();
  ASSERT_GT(device.last_size, 0.02);

  loop.start();
  loop.tick();
  const double before = wall_seconds();
  sleeper.seconds = 0.4;
  std::thread ticker([&] { loop.tick(); });
  double zero_at = 0;
  while (wall_seconds() - before < 0.35) {
    if (zero_at == 0 && device.last_size == 0) zero_at = wall_seconds() - before;
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  ticker.join();
  EXPECT_GT(zero_at, 0) << "while the step was still going on";
  loop.tick();
  EXPECT_EQ(loop.status().hands[0].fault, Fault::stalled);
  EXPECT_EQ(loop.status().watchdog, 1u);
  EXPECT_EQ(device.last_size, 0);
  loop.stop();
}

TEST(Faults, AHostThatStopsTickingIsWatchedToo) {
  Pressing rig;
  rig.loop->start();
  rig.tick();
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  rig.tick();
  rig.expect_faulted(Fault::stalled);
  EXPECT_EQ(rig.loop->status().watchdog, 1u);
  rig.loop->stop();
}

TEST(Faults, StopSendsZero) {
  Pressing rig;
  rig.loop->start();
  rig.tick();
  rig.loop->stop();
  EXPECT_EQ(rig.device.force, Vec3(0, 0, 0));
  EXPECT_FALSE(rig.loop->running());
  EXPECT_EQ(rig.hand().state, HandState::waiting);
  rig.loop->stop();
  const Pose away{{0, 0.2, 0}, Quat::Identity()};
  rig.sim.step({&away, 1});
  EXPECT_TRUE(rig.sim.engaged(0));  // whoever steps it now touches again
  rig.loop->start();
  EXPECT_THROW(rig.loop->start(), Error);
  EXPECT_THROW(rig.loop->place(0, {}), Error);
}

}  // namespace
}  // namespace crumble
