// The paper's cube under its stick, ready to press; scenes come from the scene library.
#pragma once

#include "crumble/sim/simulation.hpp"
#include "scenes/scene.hpp"

namespace crumble {

struct PressRig {
  Scene scene;
  Simulation sim;
  double speed;  // m/s, downwards

  explicit PressRig(const std::string& name = "tofu_cube", Preset preset = Preset::standard, double speed_given = 0.01,
                    bool audit = false)
      : scene(load(name, preset, audit)), sim(scene.def), speed(speed_given) {}

  static Scene load(const std::string& name, Preset preset, bool audit) {
    Scene scene = load_scene(name, preset);
    scene.def.step.energy_audit = audit;
    return scene;
  }
  Pose pose_at(std::uint64_t step) const {
    Pose pose = scene.motions[0].start;
    pose.position.y() -= speed * static_cast<double>(step) * scene.def.step.tau;
    return pose;
  }
  /// Steps once, the stick where it is due.
  const StepInfo& press() {
    const Pose pose = pose_at(sim.info().step);
    return sim.step({&pose, 1});
  }
  void press_to(double depth) {
    while (speed * sim.info().time < depth) press();
  }
};

}  // namespace crumble
