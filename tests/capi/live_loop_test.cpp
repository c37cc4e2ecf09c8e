// Changes in mid-run while a loop has the simulation.
#include <atomic>
#include <thread>

#include "capi/rig.hpp"

namespace crumble {
namespace {

class LiveLoop : public CapiTest {
 protected:
  void SetUp() override {
    CapiTest::SetUp();
    crumble_device_def which{};
    ASSERT_OK(crumble_device_def_init(&which, sizeof which));
    ASSERT_OK(crumble_hand_def_init(&hand, sizeof hand));
    ASSERT_OK(crumble_loop_def_init(&how, sizeof how));
    which.kind = CRUMBLE_DEVICE_PRESS;
    which.start.position[1] = 0.036;
    which.press_speed = 0.01, which.press_depth = 0.006;
    ASSERT_OK(crumble_device_open(&which, &hand.device));
    hand.coupling = 0, hand.ramp_time = 0;
    how.watchdog = 0;  // a machine that stands still for 20 ms is no fault here
  }
  void TearDown() override {
    EXPECT_RESULT(CRUMBLE_OK, crumble_loop_destroy(loop));
    EXPECT_RESULT(CRUMBLE_OK, crumble_device_destroy(hand.device));
    CapiTest::TearDown();
  }
  crumble_hand_status felt() {
    crumble_hand_status status{};
    status.struct_size = sizeof status;
    EXPECT_RESULT(CRUMBLE_OK, crumble_loop_get_hand(loop, 0, &status));
    return status;
  }
  crumble_hand_def hand{};
  crumble_loop_def how{};
  crumble_loop loop = nullptr;
};

TEST_F(LiveLoop, TicksOfTheHostFeelTheNewStiffness) {
  how.driver = CRUMBLE_DRIVER_HOST;
  ASSERT_OK(crumble_loop_create(sim, &how, &hand, 1, &loop));
  ASSERT_OK(crumble_loop_start(loop));
  for (int tick = 0; tick < 500; ++tick) ASSERT_OK(crumble_loop_tick(loop));
  const double soft = felt().body.force[1];
  ASSERT_GT(soft, 0.01);
  def.stiffness = 60;
  ASSERT_OK(crumble_loop_configure(loop, &def));
  EXPECT_EQ(felt().body.force[1], soft) << "not before the next step";
  ASSERT_OK(crumble_loop_tick(loop));
  EXPECT_NEAR(felt().body.force[1] / soft, 2, 0.3);
  ASSERT_OK(crumble_loop_set_friction(loop, 0, 0, 0));
  def.gravity[0] = 2;
  ASSERT_OK(crumble_loop_configure(loop, &def));
  ASSERT_OK(crumble_loop_stop(loop));  // makes what waits
  crumble_sim_def now{};
  now.struct_size = sizeof now;
  ASSERT_OK(crumble_sim_get_def(sim, &now));
  EXPECT_EQ(now.stiffness, 60);
  EXPECT_EQ(now.gravity[0], 2);
  def.stiffness = 90;
  ASSERT_OK(crumble_loop_configure(loop, &def));  // at once
  ASSERT_OK(crumble_sim_get_def(sim, &now));
  EXPECT_EQ(now.stiffness, 90);
}

TEST_F(LiveLoop, ManyChangesFromOtherThreadsWhileItRunsByItself) {
  ASSERT_OK(crumble_loop_create(sim, &how, &hand, 1, &loop));
  ASSERT_OK(crumble_loop_start(loop));
  std::atomic<int> refused{0};
  const auto turn = [&](double from) {
    crumble_sim_def mine = def;
    for (int i = 0; i < 10; ++i) {
      mine.stiffness = from + i;
      if (crumble_loop_configure(loop, &mine) != CRUMBLE_OK) ++refused;
      if (crumble_loop_set_friction(loop, 0, 1, 0.5) != CRUMBLE_OK) ++refused;
    }
  };
  std::thread one(turn, 30.0), two(turn, 60.0);
  one.join(), two.join();
  ASSERT_OK(crumble_loop_stop(loop));
  EXPECT_EQ(refused, 0);
  crumble_sim_def now{};
  now.struct_size = sizeof now;
  ASSERT_OK(crumble_sim_get_def(sim, &now));
  EXPECT_TRUE(now.stiffness == 39 || now.stiffness == 69) << now.stiffness;
}

TEST_F(LiveLoop, RefusalsNameTheFieldAndChangeNothing) {
  how.driver = CRUMBLE_DRIVER_HOST;
  ASSERT_OK(crumble_loop_create(sim, &how, &hand, 1, &loop));
  ASSERT_OK(crumble_loop_start(loop));
  ASSERT_OK(crumble_loop_tick(loop));
  crumble_sim_def bad = def;
  bad.tau = 0.002;
  expect_failure(CRUMBLE_E_STATE, crumble_loop_configure(loop, &bad), {"crumble_loop_configure", "tau"});
  bad = def, bad.mass = 0;
  expect_failure(CRUMBLE_E_OUT_OF_RANGE, crumble_loop_configure(loop, &bad), {"mass"});
  expect_failure(CRUMBLE_E_OUT_OF_RANGE, crumble_loop_set_tool(loop, 4, &tool), {"tool is 4"});
  expect_failure(CRUMBLE_E_NULL, crumble_loop_set_tool(loop, 0, nullptr), {"def"});
  for (int i = 0; i < 64; ++i) ASSERT_OK(crumble_loop_set_friction(loop, 0, 1, 0.5));
  expect_failure(CRUMBLE_E_STATE, crumble_loop_set_friction(loop, 0, 1, 0.5), {"64 changes wait"});
  EXPECT_RESULT(CRUMBLE_E_BUSY, crumble_sim_configure(sim, &def));
  ASSERT_OK(crumble_loop_tick(loop));
  ASSERT_OK(crumble_loop_set_friction(loop, 0, 1, 0.5));
}

}  // namespace
}  // namespace crumble
