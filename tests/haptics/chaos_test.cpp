// A million ticks of a whole loop whose device and body go wrong at random: what reaches the hand obeys its limits.
#include <limits>

#include "crumble/base/random.hpp"
#include "haptics/loop_rig.hpp"
#include "support/long_lane.hpp"

namespace crumble {
namespace {

class Chaos {
 public:
  explicit Chaos(std::uint64_t seed)
      : random_(seed),
        rig_(
            [](LoopDef& def) {
              def.hands[0].clutch_buttons = 1;
              def.hands[0].passivity.controller = true;
              def.hands[0].safety.good_samples = 10;
              def.hands[0].safety.ramp_time = 0.02;
            },
            brittle()) {}

  void tick() {
    go_wrong();
    const Vec3 before = rig_.device.force;
    const double ramp = rig_.hand().ramp;
    const std::uint64_t writes = rig_.device.writes;
    rig_.tick();
    const HandStatus hand = rig_.hand();
    const Vec3& force = rig_.device.force;
    ASSERT_GT(rig_.device.writes, writes);
    ASSERT_TRUE(is_finite(force) && rig_.device.torque == Vec3::Zero());
    ASSERT_EQ(force, hand.force);
    ASSERT_LE(norm(force), 3 * (1 + 1e-12));
    ASSERT_LE(norm(force), norm(before) + 0.3 * (1 + 1e-9));
    ASSERT_TRUE(hand.state != HandState::faulted || force == Vec3::Zero()) << reason(hand.fault);
    ASSERT_EQ(hand.state == HandState::faulted, hand.fault != Fault::none);
    ASSERT_TRUE(hand.state != HandState::ramping || hand.ramp >= ramp || ramp == 0) << hand.ramp << ' ' << ramp;
    ASSERT_TRUE(hand.state != HandState::waiting || force == Vec3::Zero());
    pushed_ += force != Vec3::Zero();
    seen_ |= 1u << static_cast<unsigned>(hand.fault);
    if (hand.state == HandState::faulted && chance(20)) mend();
  }
  std::uint64_t pushed() const { return pushed_; }
  std::uint32_t seen() const { return seen_; }

 private:
  static SimulationDef brittle() {
    SimulationDef def = small_body(3);
    def.material.length_limit = 1.3;
    return def;
  }
  bool chance(std::uint64_t one_in) { return random_.below(one_in) == 0; }

  // The hand moves about at up to 0.3 m/s; now and then something happens.
  void go_wrong() {
    Puppet& device = rig_.device;
    device.sample.pose = Pose{};
    if (chance(300))
      goal_ = {random_.uniform(-0.01, 0.01), random_.uniform(-0.012, 0.004), random_.uniform(-0.01, 0.01)};
    const Vec3 way = goal_ - place_;
    place_ += way * std::min(1.0, 3e-4 / std::max(norm(way), 1e-12));
    device.sample.pose.position = place_;
    device.sample.flags = chance(5000) ? sample_flag::kUncalibrated : 0;
    device.sample.buttons = device.sample.buttons ? !chance(50) : chance(3000);
    if (chance(4000)) device.sample.pose.position[random_.below(3)] = std::numeric_limits<double>::quiet_NaN();
    if (chance(3000)) device.sample.pose.position += Vec3(0, 0.05, 0);  // a glitch
    if (chance(20000)) place_ += Vec3(0.05, 0, 0);                      // a teleport
    if (chance(20000)) device.sample.pose.orientation = Quat(3, 0, 0, 0);
    if (chance(20000)) device.sample.linear_velocity = Vec3::Constant(std::numeric_limits<double>::infinity());
    device.status = chance(20000) ? ReadStatus::lost : silent_ > 0 ? ReadStatus::no_new_sample : ReadStatus::ok;
    silent_ = silent_ > 0 ? silent_ - 1 : chance(5000) ? random_.below(40) : 0;
    if (chance(20000)) rig_.loop->halt();
    if (chance(20000)) {
      VecArray away(rig_.sim.mesh().node_count());
      for (std::size_t i = 0; i < away.size(); ++i) away.set(i, {1e12, 0, 0});
      rig_.sim.set_node_forces(away);
    }
  }
  void mend() {
    rig_.device.sample.linear_velocity = Vec3::Zero();
    if (rig_.sim.info().status != Code{} || chance(10)) rig_.sim.reset();
    rig_.loop->reset_fault(0);
  }

  Random random_;
  LoopRig rig_;
  Vec3 place_ = Vec3(0, 0.002, 0), goal_ = place_;
  std::uint64_t silent_ = 0, pushed_ = 0;
  std::uint32_t seen_ = 0;
};

TEST(Chaos, ManyTicksStayWithinTheirLimits) {
  Chaos chaos(77);
  for (int k = 0; k < in_long_lane(1'000'000) && !testing::Test::HasFatalFailure(); ++k) chaos.tick();
  EXPECT_GT(chaos.pushed(), 50'000u);
  for (const Fault fault : {Fault::not_finite, Fault::bad_pose, Fault::speed, Fault::silent, Fault::device_lost,
                            Fault::body, Fault::halted}) {
    EXPECT_TRUE(chaos.seen() >> static_cast<unsigned>(fault) & 1u) << to_string(fault);
  }
}

}  // namespace
}  // namespace crumble
