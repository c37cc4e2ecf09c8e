// The loop as a whole: who gets a force, when, and from what.
#include "crumble/haptics/loop.hpp"

#include <algorithm>

#include "crumble/base/memory.hpp"
#include "crumble/base/random.hpp"
#include "crumble/device/recorder.hpp"
#include "crumble/device/replay.hpp"
#include "crumble/device/scripted.hpp"
#include "haptics/loop_rig.hpp"

namespace crumble {
namespace {

TEST(Loop, WaitsForGoodSamplesThenLetsTheForceInSmoothly) {
  LoopRig rig;
  rig.device.sample.pose.position.y() = 5e-6;  // hardly above the body
  rig.tick(99);
  EXPECT_EQ(rig.hand().state, HandState::waiting);
  rig.tick(2);
  EXPECT_EQ(rig.hand().state, HandState::ramping);
  double before = rig.hand().ramp;
  EXPECT_LE(before, 0.01);
  for (int k = 0; k < 520; ++k) {
    rig.tick();
    EXPECT_GE(rig.hand().ramp, before);
    EXPECT_LE(rig.hand().ramp - before, 1e-3 / 0.5 + 1e-12);
    before = rig.hand().ramp;
  }
  EXPECT_EQ(rig.hand().state, HandState::running);
  EXPECT_EQ(before, 1);
}

TEST(Loop, PressesBackOnceTheForceIsIn) {
  LoopRig rig;
  rig.let_in();
  EXPECT_EQ(rig.device.force, Vec3(0, 0, 0));
  rig.move_to(-0.003);
  EXPECT_GT(rig.device.force.y(), 0.1);
  EXPECT_GT(rig.hand().contacts, 0u);
  rig.move_to(0.003);
  EXPECT_EQ(rig.device.force, Vec3(0, 0, 0));
}

// At rest the spring of the coupling and the body balance: the hand feels what the body does.
TEST(Loop, AtRestTheHandFeelsWhatTheBodyDoes) {
  LoopRig rig;
  rig.let_in();
  rig.move_to(-0.003);
  rig.tick(3000);
  const HandStatus hand = rig.hand();
  EXPECT_NEAR(hand.force.y(), hand.body.force.y(), 1e-3 * hand.body.force.y());
  EXPECT_NEAR(hand.tool.position.y() - (kTop + kRadius - 0.003), hand.force.y() / hand.stiffness, 1e-9);
}

TEST(Loop, WithoutTheCouplingTheToolIsTheDevice) {
  LoopRig rig([](LoopDef& def) { def.hands[0].coupling.enabled = false; });
  EXPECT_EQ(rig.loop->warnings().size(), 1u);
  rig.let_in();
  rig.move_to(-0.003);
  rig.tick(10);
  EXPECT_NEAR(rig.hand().tool.position.y(), kTop + kRadius - 0.003, 1e-15);
  EXPECT_EQ(rig.device.force, rig.sim.wrench(0).force);  // at rest: no damping either
}

TEST(Loop, AToolThatStartsInTheBodyGetsNoForceUntilItHasBeenOutside) {
  LoopRig rig;
  rig.device.sample.pose.position.y() = -0.005;
  rig.tick(1000);
  EXPECT_EQ(rig.hand().state, HandState::waiting);
  EXPECT_EQ(rig.hand().contacts, 0u);
  EXPECT_EQ(rig.device.force, Vec3(0, 0, 0));
  rig.move_to(0.001);
  rig.tick(600);
  EXPECT_EQ(rig.hand().state, HandState::running);
}

TEST(Loop, WhileItWaitsNothingIsTouched) {
  LoopRig rig;
  rig.move_to(-0.004, 0.1);  // in 60 of the 100 ticks
  EXPECT_EQ(rig.sim.info().contacts, 0u);
  rig.tick(200);
  EXPECT_EQ(rig.sim.info().contacts, 0u);  // still inside
  EXPECT_EQ(rig.hand().state, HandState::waiting);
}

TEST(Loop, TheClutchFreezesTheToolAndReengagesOnlyOutside) {
  LoopRig rig([](LoopDef& def) { def.hands[0].clutch_buttons = 2; });
  rig.let_in();
  rig.move_to(-0.003);
  const Vec3 tool = rig.hand().tool.position;
  ASSERT_GT(norm(rig.device.force), 0.1);
  rig.device.sample.buttons = 3;
  rig.tick();
  EXPECT_EQ(rig.hand().state, HandState::clutched);
  EXPECT_EQ(rig.device.force, Vec3(0, 0, 0));  // it touches nothing any more
  rig.move_to(0.010);
  EXPECT_LT(norm(rig.hand().tool.position - tool), 1e-12);
  rig.device.sample.buttons = 1;
  rig.tick(1000);
  EXPECT_EQ(rig.hand().state, HandState::waiting);  // inside
  EXPECT_EQ(rig.device.force, Vec3(0, 0, 0));
  EXPECT_LT(norm(rig.hand().tool.position - tool), 1e-12);
  rig.move_to(0.015);  // 5 mm up from there: outside
  rig.tick(600);
  EXPECT_EQ(rig.hand().state, HandState::running);
  EXPECT_NEAR(rig.hand().tool.position.y(), tool.y() + 0.005, 1e-9);
  rig.move_to(0.009);  // where the tool has been before
  EXPECT_GT(rig.device.force.y(), 0.1);
}

// T, s and g: the same scene forces, scaled; power conserved with g = 1.
TEST(Loop, ScaleAndGainReachTheHand) {
  LoopRig plain([](LoopDef& def) { def.hands[0].coupling.enabled = false; });
  LoopRig scaled([](LoopDef& def) {
    def.hands[0].coupling.enabled = false;
    def.hands[0].workspace.scale = 0.5;
    def.hands[0].workspace.force_gain = 0.8;
  });
  plain.let_in(), scaled.let_in();
  plain.move_to(-0.002, 0.01), scaled.move_to(-0.004, 0.02);
  plain.tick(3000), scaled.tick(3000);
  EXPECT_NEAR(scaled.device.force.y(), 0.8 * 0.5 * plain.device.force.y(), 2e-3 * plain.device.force.y());
  EXPECT_NEAR(scaled.hand().stiffness, 0.8 * 0.25 * plain.hand().stiffness, 0.02 * plain.hand().stiffness);
}

TEST(Loop, ALocalModelAtTheRateOfTheBodyAgreesWithDirect) {
  LoopRig direct;
  LoopRig local([](LoopDef& def) { def.coupling = BodyCoupling::local_model; });
  direct.let_in(), local.let_in();
  direct.move_to(-0.004), local.move_to(-0.004);
  direct.tick(2000), local.tick(2000);
  EXPECT_NEAR(local.device.force.y(), direct.device.force.y(), 0.01 * direct.device.force.y());
}

// A body at 333 Hz: the model has to follow the hand between its steps.
TEST(Loop, TheLocalModelFollowsTheHandBetweenSteps) {
  SimulationDef body = small_body();
  body.step.tau = 3e-3;
  const auto setup = [](BodyCoupling coupling) {
    return [coupling](LoopDef& def) {
      def.coupling = coupling;
      def.body_ticks = 3;
      def.hands[0].coupling.enabled = def.hands[0].passivity.inject_damping = false;
    };
  };
  LoopRig local(setup(BodyCoupling::local_model), body), paper(setup(BodyCoupling::paper), body);
  local.let_in(), paper.let_in();
  local.move_to(-0.002), paper.move_to(-0.002);
  int local_changes = 0, paper_changes = 0;
  for (int k = 0; k < 90; ++k) {
    const Vec3 a = local.device.force, b = paper.device.force;
    local.device.sample.pose.position.y() -= 1e-5, paper.device.sample.pose.position.y() -= 1e-5;
    local.tick(), paper.tick();
    local_changes += local.device.force != a, paper_changes += paper.device.force != b;
  }
  EXPECT_EQ(local_changes, 90);
  EXPECT_EQ(paper_changes, 30);  // held
  EXPECT_EQ(local.loop->status().steps, local.loop->status().ticks / 3);
}

// A hand that holds still over a body that gives way: each model has a little less force than the one before, and the
// difference is spread over the ticks till the next.
TEST(Loop, TheLocalModelChangesWithoutSteps) {
  SimulationDef body = small_body();
  body.step.tau = 4e-3;
  LoopRig rig(
      [](LoopDef& def) {
        def.coupling = BodyCoupling::local_model;
        def.body_ticks = 4;
        def.hands[0].coupling.enabled = def.hands[0].passivity.inject_damping = false;
      },
      body);
  rig.let_in();
  rig.move_to(-0.003, 0.1);
  rig.tick(20);
  Vector<double> falls;
  for (int k = 0; k < 40; ++k) {
    const double before = rig.device.force.y();
    rig.tick();
    falls.push_back(before - rig.device.force.y());
  }
  const double least = *std::min_element(falls.begin(), falls.end()),
               most = *std::max_element(falls.begin(), falls.end());
  EXPECT_GT(least, 0);
  EXPECT_LT(most, 3 * least);
}

TEST(Loop, ThePaperCouplingReportsTheMeanOfFive) {
  const auto setup = [](LoopDef& def) { apply_paper_preset(def); };
  SimulationDef body = small_body(), meaning = small_body();
  meaning.step.mean_force = true;
  LoopRig own(setup, body), by_sim(setup, meaning);
  own.let_in(), by_sim.let_in();
  own.move_to(-0.003), by_sim.move_to(-0.003);
  EXPECT_GT(norm(own.device.force), 0.1);
  EXPECT_LT(norm(own.device.force - by_sim.device.force), 1e-12);
}

TEST(Loop, TwoHandsHaveABodyBetweenThem) {
  SimulationDef body = small_body();
  body.tools.push_back({make_round_stick(kRadius, 0.05, 16), {}});
  Puppet left, right;
  Simulation sim(body);
  LoopDef def;
  def.driver = LoopDriver::host;
  HandDef hand;
  hand.device = &left;
  hand.workspace.pose.position = {-0.015 - kRadius, 0.02, 0};
  def.hands.push_back(hand);
  hand.device = &right, hand.holder = 1;
  hand.workspace.pose.position = {0.015 + kRadius, 0.02, 0};
  def.hands.push_back(hand);
  HapticLoop loop(sim, def);
  left.sample.pose.position.x() = -0.001, right.sample.pose.position.x() = 0.001;
  for (int k = 0; k < 800; ++k) loop.tick();
  for (int k = 0; k < 300; ++k) {
    left.sample.pose.position.x() += 1e-5, right.sample.pose.position.x() -= 1e-5;
    loop.tick();
  }
  EXPECT_LT(left.force.x(), -0.05);
  EXPECT_GT(right.force.x(), 0.05);

  // one of them is lost: the other goes on
  right.status = ReadStatus::lost;
  loop.tick();
  EXPECT_EQ(right.force, Vec3(0, 0, 0));
  EXPECT_EQ(loop.status().hands[1].fault, Fault::device_lost);
  EXPECT_EQ(loop.status().hands[0].state, HandState::running);
  EXPECT_LT(left.force.x(), -0.02);
}

// The same motion by the same loop: forces and states to the last bit.
TEST(Loop, ReplayGivesTheSameBits) {
  const auto run = [](Device& device, Recording* recording, Vector<Vec3>& forces) {
    SimulationDef body = small_body();
    body.material.length_limit = 1.15;
    Simulation sim(body);
    LoopDef def;
    def.driver = LoopDriver::host;
    HandDef hand;
    hand.device = &device;
    hand.workspace.pose.position = {0, kTop + kRadius, 0};
    def.hands = {hand};
    HapticLoop loop(sim, def);
    loop.record_to(recording);
    for (int k = 0; k < 2500; ++k) {
      loop.tick();
      forces.push_back(loop.status().hands[0].force);
    }
    EXPECT_GT(sim.counters().cuts, 0u);
    return sim.state_hash();
  };
  PathOptions path;
  path.start.position.y() = 0.002;
  path.points = {{.time = 0.7}, {.time = 1.2, .move = {0.001, -0.012, 0.001}}, {.time = 2.4, .move = {0, 0.01, 0}}};
  Recorder first(open_path(path, 1e-3), 3000);
  Vector<Vec3> forces, again;
  SimulationDef body = small_body();
  body.material.length_limit = 1.15;
  const Simulation start(body);
  Recording recording(start);
  const std::uint64_t hash = run(first, &recording, forces);
  const auto second = open_replay(first.trajectory(), {}, 1e-3);
  EXPECT_EQ(run(*second, nullptr, again), hash);
  // the path ends before the replay has anything more to tell
  for (std::size_t k = 0; k < first.size(); ++k) ASSERT_EQ(forces[k], again[k]) << k;
  // and the simulation's own recording, suspensions and all
  Simulation verify = recording.start();
  EXPECT_EQ(replay(recording, verify), std::nullopt);
  EXPECT_EQ(verify.state_hash(), hash);
}

TEST(Loop, TellsPublishers) {
  LoopRig rig;
  StatePublisher publisher(rig.sim);
  rig.loop->publish_to(publisher);
  publisher.latest();
  rig.tick(40);
  EXPECT_GT(publisher.latest().step, 0u);
}

TEST(Loop, OthersAreWhereTheyArePlaced) {
  SimulationDef body = small_body();
  body.tools.push_back({make_round_stick(kRadius, 0.05, 16), {}});
  LoopRig rig({}, body);
  rig.loop->place(1, {{0.1, 0.2, 0.3}, Quat::Identity()});
  rig.tick(3);
  EXPECT_EQ(rig.sim.info().status, Code{});
  const auto code_of = [](const std::function<void()>& call) {
    try {
      call();
    } catch (const Error& error) {
      return error.code();
    }
    return Code{};
  };
  EXPECT_EQ(code_of([&] { rig.loop->place(0, {}); }), Code::state);
  EXPECT_EQ(code_of([&] { rig.loop->place(2, {}); }), Code::out_of_range);
  EXPECT_EQ(code_of([&] { rig.loop->place(1, {{NAN, 0, 0}, Quat::Identity()}); }), Code::bad_pose);
}

struct Refusal {
  const char* name;
  Code code;
  std::function<void(LoopDef&)> change;
  const char* mentions;
};

class LoopRefuses : public testing::TestWithParam<Refusal> {};

TEST_P(LoopRefuses, NamingWhatIsWrong) {
  try {
    LoopRig rig(GetParam().change);
    FAIL() << "was taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), GetParam().code) << error.what();
    EXPECT_NE(std::string(error.what()).find(GetParam().mentions), std::string::npos) << error.what();
  }
}

Puppet other_device;
const Refusal kRefusals[] = {
    {"NoHand", Code::empty, [](LoopDef& d) { d.hands.clear(); }, "hands"},
    {"FiveHands", Code::too_large, [](LoopDef& d) { d.hands.resize(5, d.hands[0]); }, "5"},
    {"NoDevice", Code::null, [](LoopDef& d) { d.hands[0].device = nullptr; }, "hands[0].device"},
    {"NoSuchHolder", Code::out_of_range, [](LoopDef& d) { d.hands[0].holder = 1; }, "hands[0].holder is 1"},
    {"OneHolderTwoHands", Code::state,
     [](LoopDef& d) {
       d.hands.push_back(d.hands[0]);
       d.hands[1].device = &other_device;
     },
     "hands[1]"},
    {"TickTooShort", Code::out_of_range, [](LoopDef& d) { d.tick = 1e-5; }, "tick"},
    {"TickNotANumber", Code::invalid_value, [](LoopDef& d) { d.tick = NAN; }, "tick"},
    {"OtherTime", Code::out_of_range, [](LoopDef& d) { d.tick = 2e-3; }, "0.002"},
    {"DirectWithTicks", Code::out_of_range, [](LoopDef& d) { d.body_ticks = 2; }, "body_ticks"},
    {"DirectWithThread", Code::state, [](LoopDef& d) { d.body_thread = true; }, "body_thread"},
    {"NobodyDrives", Code::unsupported, [](LoopDef& d) { d.driver = LoopDriver::device; }, "driver"},
    {"Force", Code::out_of_range, [](LoopDef& d) { d.hands[0].safety.max_force = 0; }, "hands[0].safety.max_force"},
    {"Slew", Code::invalid_value, [](LoopDef& d) { d.hands[0].safety.max_slew = NAN; }, "hands[0].safety.max_slew"},
    {"Ramp", Code::out_of_range, [](LoopDef& d) { d.hands[0].safety.ramp_time = -1; }, "hands[0].safety.ramp_time"},
    {"Delay", Code::out_of_range, [](LoopDef& d) { d.hands[0].passivity.delay = 65; }, "hands[0].passivity.delay"},
    {"Credit", Code::out_of_range, [](LoopDef& d) { d.hands[0].passivity.energy_credit = 0; },
     "hands[0].passivity.energy_credit"},
    {"Coupling", Code::out_of_range, [](LoopDef& d) { d.hands[0].coupling.stiffness = -1; },
     "hands[0].coupling.stiffness"},
    {"Scale", Code::out_of_range, [](LoopDef& d) { d.hands[0].workspace.scale = 0; }, "hands[0].workspace.scale"},
};
INSTANTIATE_TEST_SUITE_P(All, LoopRefuses, testing::ValuesIn(kRefusals),
                         [](const auto& param) { return std::string(param.param.name); });

// A device with a thread of its own, its hand touching the body. Returns whether the force came through.
bool feels(HapticLoop& loop, Caller& caller, const std::function<void()>& tick) {
  double& y = caller.sample.pose.position.y();
  for (int i = 0; i < 1200; ++i) {
    if (i > 800) y -= 1e-5;
    tick();
  }
  EXPECT_EQ(loop.status().hands[0].state, HandState::running);
  return caller.force.y() > 0.01;
}

TEST(Loop, ADeviceWithAThreadDrivesUnlessTheHostDoes) {
  for (const LoopDriver driver : {LoopDriver::automatic, LoopDriver::device, LoopDriver::host}) {
    Caller caller;
    caller.sample.pose.position.y() = 0.001;
    LoopRig rig([&](LoopDef& def) {
      def.driver = driver;
      def.watchdog = false;  // time stands still here
      def.hands[0].device = &caller;
    });
    const bool host = driver == LoopDriver::host;
    EXPECT_EQ(caller.servo.call != nullptr, host) << "a host's loop exchanges with it from the first";
    EXPECT_EQ(rig.loop->definition().hands[0].passivity.delay, host ? 2 : 1);
    rig.loop->start();
    EXPECT_TRUE(feels(*rig.loop, caller, [&] {
      caller.turn();
      if (host) rig.loop->tick();
    }));
    rig.loop->stop();
    caller.turn();  // one whose thread goes on gets the zero there
    EXPECT_EQ(caller.force, Vec3(0, 0, 0));
    EXPECT_EQ(rig.loop->status().ticks, 1200u);
  }
}

TEST(Loop, DevicesOfOneThreadGoTogetherAndOthersAreExchangedWith) {
  SimulationDef body = small_body();
  body.tools.push_back(body.tools[0]);
  int group = 0;
  for (const bool together : {true, false}) {
    Caller first(&group), second(together ? &group : nullptr);
    first.sample.pose.position.y() = 0.01;
    second.sample.pose.position.y() = 0.01;
    LoopRig rig(
        [&](LoopDef& def) {
          def.driver = LoopDriver::automatic;
          def.watchdog = false;
          def.hands[0].device = &first;
          def.hands.push_back(def.hands[0]);
          def.hands[1].device = &second;
          def.hands[1].holder = 1;
          def.hands[1].workspace.pose.position.x() = 1;
        },
        body);
    rig.loop->start();
    EXPECT_EQ(second.servo.call != nullptr, !together);
    for (int i = 0; i < 200; ++i) second.turn(), first.turn();
    EXPECT_EQ(first.reads, 200u);
    EXPECT_EQ(second.reads, 200u);
    EXPECT_EQ(rig.loop->status().hands[1].time, 0.199);
  }
}

TEST(Loop, TheDevicesRateMustBeTheTicks) {
  Caller caller;
  caller.info().rate = 500;
  const auto try_with = [&](LoopDriver driver) {
    LoopRig rig([&](LoopDef& def) {
      def.driver = driver;
      def.hands[0].device = &caller;
    });
  };
  try {
    try_with(LoopDriver::automatic);
    ADD_FAILURE() << "time would run at half its speed";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Code::out_of_range);
    EXPECT_NE(std::string(error.what()).find("500 Hz"), std::string::npos) << error.what();
  }
  EXPECT_NO_THROW(try_with(LoopDriver::host)) << "who polls has a time of their own";
}

TEST(Loop, WhatTheDriverTookStaysAway) {
  LoopRig rig;
  rig.let_in();
  rig.move_to(-0.002);
  EXPECT_GT(rig.device.force.y(), 0.01);
  rig.device.sample.flags = sample_flag::kForceOff;
  rig.tick();
  EXPECT_EQ(rig.device.force, Vec3(0, 0, 0));
  rig.device.sample.flags = 0;
  rig.tick(1000);
  EXPECT_EQ(rig.hand().fault, Fault::driver);
  EXPECT_EQ(rig.device.force, Vec3(0, 0, 0)) << "until somebody asks";
  rig.loop->reset_fault(0);
  rig.move_to(0.002);
  rig.tick(1000);
  EXPECT_EQ(rig.hand().state, HandState::running);
}

TEST(Loop, WarnsOfACouplingThatTheDeviceCannotBear) {
  LoopRig quiet, loud([](LoopDef&def) { def.hands[0].coupling.stiffness = 20000; });
  EXPECT_TRUE(quiet.loop->warnings().empty());
  ASSERT_EQ(loud.loop->warnings().size(), 1u);
  EXPECT_NE(loud.loop->warnings()[0].find("20000"), std::string::npos) << loud.loop->warnings()[0];
}

}  // namespace
}  // namespace crumble
