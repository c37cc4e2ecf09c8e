#include "grid/grid.hpp"

#include <cmath>

#include "crumble/sim/simulation.hpp"
#include "scenes/scene.hpp"

namespace crumble::grid {
namespace {

constexpr double kTau = 2.9e-3;

struct Press {
  std::uint64_t cuts, guarded;
  bool diverged;
};

Press press(const Scene& scene, const Material& material, double tau, TimeStepPolicy policy) {
  SimulationDef def = scene.def;
  def.material = material;
  def.step.tau = tau;
  def.step.policy = policy;
  Simulation sim(std::move(def));
  const auto device = open_press(scene.motions[0].press, tau);
  const auto steps = static_cast<std::size_t>(scene.motions[0].press.depth / scene.motions[0].press.speed / tau) + 1;
  DeviceSample sample;
  for (std::size_t step = 0; step < steps && sim.info().status == Code{}; ++step) {
    if (device->read(sample) == ReadStatus::ok) sim.step({&sample.pose, 1});
  }
  return {sim.counters().cuts, sim.counters().guarded_nodes, sim.info().status != Code{}};
}

}  // namespace

Material material_at(std::size_t point) {
  Material material;  // the mass is that of the 30 g cube
  material.stiffness = 10.0 * static_cast<double>(point / 50 + 1);
  material.damping_ratio = 5.0 * static_cast<double>(point / 5 % 10 + 1);
  material.length_limit = (11.0 + static_cast<double>(point % 5)) / 10;
  return material;
}

std::size_t point_at(int stiffness, int damping_ratio, double length_limit) {
  const auto tenths = static_cast<std::size_t>(std::lround(10 * length_limit));
  return static_cast<std::size_t>(stiffness / 10 - 1) * 50 + static_cast<std::size_t>(damping_ratio / 5 - 1) * 5 +
         (tenths - 11);
}

PointResult run_point(std::size_t point, TimeStepPolicy policy) {
  static const Scene scene = load_scene("tofu_cube", Preset::standard);
  const Material material = material_at(point);
  const Press once = press(scene, material, kTau, policy);
  const Press third = press(scene, material, kTau / 3, policy);
  return {once.cuts, third.cuts, once.guarded, once.diverged || third.diverged};
}

}  // namespace crumble::grid
