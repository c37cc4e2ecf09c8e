// read and write must not allocate.
#include <gtest/gtest.h>

#include "crumble/device/hand.hpp"
#include "crumble/device/poke.hpp"
#include "crumble/device/recorder.hpp"
#include "crumble/device/replay.hpp"
#include "crumble/device/scripted.hpp"
#include "crumble/device/tremor.hpp"
#include "crumble/device/wander.hpp"
#include "device/samples.hpp"
#include "support/allocation_counter.hpp"

namespace crumble {
namespace {

std::size_t allocations_in_ticks(Device& device, int ticks) {
  DeviceSample sample;
  const AllocationCounter counter;
  for (int k = 0; k < ticks; ++k) {
    static_cast<void>(device.read(sample));
    device.write(sample.pose.position, sample.linear_velocity);
  }
  return counter.count();
}

TEST(RealTime, NoDeviceAllocatesInATick) {
  if (!AllocationCounter::available()) GTEST_SKIP() << "a sanitizer owns malloc";
  const Trajectory motion = random_trajectory(41, 500);
  EXPECT_EQ(allocations_in_ticks(*open_null({}, 1e-3), 1000), 0u);
  EXPECT_EQ(allocations_in_ticks(*open_press({.depth = 1e-3}, 1e-3), 5000), 0u);  // past its end
  const PathOptions path{.points = {{.time = 0.5, .move = {0, 0.01, 0}}, {.time = 1, .turn = {1, 2, 3}}}};
  EXPECT_EQ(allocations_in_ticks(*open_path(path, 1e-3), 2000), 0u);  // past its end
  HandOptions hand{.points = {{.time = 0.5, .move = {0, 0.01, 0}}, {.time = 1}}, .friction = 0.1, .delay = 7};
  EXPECT_EQ(allocations_in_ticks(*open_hand(hand, 1e-3), 2000), 0u);
  hand.encoder_step = 5e-5;
  EXPECT_EQ(allocations_in_ticks(*open_hand(hand, 1e-3), 2000), 0u);                                 // past its end
  EXPECT_EQ(allocations_in_ticks(*open_replay(motion, {}, 1e-3), 10000), 0u);                        // past its end
  EXPECT_EQ(allocations_in_ticks(*open_replay(motion, {.end = EndPolicy::loop}, 1e-3), 20000), 0u);  // several laps
  for (const ReplayClock clock : {ReplayClock::realtime, ReplayClock::fast}) {
    EXPECT_EQ(allocations_in_ticks(*open_replay(motion, {.end = EndPolicy::loop, .clock = clock}, 1e-3), 20000), 0u);
  }
  EXPECT_EQ(allocations_in_ticks(*open_poke({.count = 2}, 1e-3), 5000), 0u);      // past its end
  EXPECT_EQ(allocations_in_ticks(*open_tremor({.seconds = 2}, 1e-3), 3000), 0u);  // past its end
  EXPECT_EQ(allocations_in_ticks(*add_tremor(open_poke({}, 1e-3), {}), 3000), 0u);
  EXPECT_EQ(allocations_in_ticks(*open_wander({.max_turn = 1}, 1e-3), 20000), 0u);  // many moves
  Recorder recorder(open_null({}, 1e-3), 500);
  EXPECT_EQ(allocations_in_ticks(recorder, 1000), 0u);  // past its capacity
}

}  // namespace
}  // namespace crumble
