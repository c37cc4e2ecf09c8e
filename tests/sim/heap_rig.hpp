// The paper's cube, weak and loose on a rough floor between four walls, and an upright bar that stirs it to crumbs.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "crumble/bubblemesh/presets.hpp"
#include "crumble/sim/simulation.hpp"

namespace crumble {

struct HeapRig {
  static constexpr double kHalfWidth = 0.025;                   // between the walls, metres
  static constexpr double kBarLength = 0.05, kLowest = 0.0015;  // of the bar; the floor stays free

  Simulation sim;
  double stirred = 0;  // s

  explicit HeapRig(Precision precision = Precision::float64) : sim(definition(precision)) {}

  static SimulationDef definition(Precision precision) {
    SimulationDef def;
    def.mesh = generate_paper_body(PaperBody::cube).mesh;
    def.material.length_limit = 1.05;
    def.walls[0].friction = {0.6, 0.5};
    for (const Vec3& inward : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 0, 1}, Vec3{0, 0, -1}}) {
      def.walls.push_back({{inward, -kHalfWidth}, {0.3, 0.3}});
    }
    def.tools = {{make_bar({0.006, kBarLength, 0.006}), {0.5, 0.5}}};
    def.step.precision = precision;
    return def;
  }

  /// The bar hangs above all.
  void wait(int steps) {
    for (int s = 0; s < steps; ++s) step(Vec3(0, 0.2, 0));
  }
  /// The bar comes down into the cube while it goes to and fro, 0.2 m/s at most: what is hit harder is thrown.
  void stir() {
    stirred += sim.definition().step.tau;
    step(bar());
  }
  void stir_until(std::size_t fragments, double longest) {
    while (fragment_count() < fragments && stirred < longest) stir();
  }
  /// Up at 70 mm/s, still to and fro.
  void lift() {
    for (int s = 0; s < 1000; ++s) {
      stirred += sim.definition().step.tau;
      step(bar() + Vec3(0, 7e-5 * s, 0));
    }
  }

  std::size_t fragment_count() const {
    std::size_t count = 0;
    for (std::uint32_t f = 0; f < sim.fragments().count(); ++f) count += sim.fragments().record(f).node_count > 0;
    return count;
  }

 private:
  Vec3 bar() const {
    constexpr double kReach = 0.019;
    const double above = std::max(0.0, 0.035 - 0.01 * stirred);
    return {kReach * std::sin(10.6 * stirred), kBarLength / 2 + kLowest + above, kReach * std::sin(6.2 * stirred)};
  }
  void step(const Vec3& at) {
    Pose pose;
    pose.position = at;
    sim.step({&pose, 1});
  }
};

}  // namespace crumble
