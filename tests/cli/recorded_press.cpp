#include "cli/recorded_press.hpp"

#include <gtest/gtest.h>

#include "scenes/scene.hpp"

namespace crumble::cli {

Simulation record_press(const std::string& name, double speed, const std::string& recording) {
  const Scene scene = load_scene(name, Preset::standard);
  PressOptions press = scene.motions[0].press;
  press.speed = speed;
  const auto device = open_press(press, scene.def.step.tau);
  Simulation sim(scene.def);
  Recording made(sim);
  DeviceSample sample;
  for (std::size_t step = 0; step < kSteps; ++step) {
    EXPECT_NE(device->read(sample), ReadStatus::lost);
    sim.step({&sample.pose, 1});
    made.add({&sample.pose, 1}, sim.state_hash());
  }
  made.save(recording);
  EXPECT_GT(sim.counters().cuts, 10u);
  return sim;
}

}  // namespace crumble::cli
