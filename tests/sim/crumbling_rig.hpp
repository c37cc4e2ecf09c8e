// The paper's cube from a weaker material, which falls to pieces under a fast stick.
#pragma once

#include "sim/press_rig.hpp"

namespace crumble {

struct CrumblingRig {
  Scene scene;
  Simulation sim{scene.def};
  Pose pose = scene.motions[0].start;

  static Scene weak_cube(bool balls = true) {
    Scene scene = load_scene("tofu_cube", Preset::standard);
    scene.def.material.length_limit = 1.1;
    scene.def.gravity = {0, -9.81, 0};
    scene.def.step.ball_contact = balls;
    return scene;
  }
  explicit CrumblingRig(bool balls = true) : scene(weak_cube(balls)) {
    pose.position.y() += 5e-4;  // free of the body, so that contact begins in a step
  }

  /// 20 mm/s down, or up.
  const StepInfo& press() { return move(-2e-5); }
  const StepInfo& lift() { return move(2e-5); }
  const StepInfo& move(double way) {
    pose.position.y() += way;
    return sim.step({&pose, 1});
  }
};

}  // namespace crumble
