// A small cube under a stick that a puppet's hand holds, and a loop that the test ticks.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include "crumble/haptics/loop.hpp"
#include "crumble/tetmesh/lattice_box.hpp"
#include "haptics/puppet.hpp"

namespace crumble {

inline constexpr double kTop = 0.03, kRadius = 0.004;  // m: of the cube, of the stick

inline SimulationDef small_body(std::uint32_t cells = 5) {
  SimulationDef def;
  def.mesh = make_lattice_box({0.03, kTop, 0.03}, 0.03 / cells);
  def.fixed_nodes = nodes_below(def.mesh, 1e-6);
  def.walls.clear();
  def.gravity = Vec3::Zero();
  def.tools = {{make_round_stick(kRadius, 0.05, 16), {}}};
  return def;
}

struct LoopRig {
  explicit LoopRig(const std::function<void(LoopDef&)>& change = {}, SimulationDef body = small_body())
      : sim(std::move(body)) {
    LoopDef def;
    def.driver = LoopDriver::host;
    HandDef hand;
    hand.device = &device;
    hand.workspace.pose.position = {0, kTop + kRadius, 0};  // the device's origin: touching
    def.hands = {hand};
    if (change) change(def);
    loop = std::make_unique<HapticLoop>(sim, std::move(def));
    device.sample.pose.position.y() = 0.002;
  }

  HandStatus hand(std::size_t index = 0) const { return loop->status().hands[index]; }
  void tick(int times = 1) {
    for (int i = 0; i < times; ++i) loop->tick();
  }
  /// Straight down or up to `height` (m above the first touch) at `speed` (m/s).
  void move_to(double height, double speed = 0.02) {
    double& y = device.sample.pose.position.y();
    const double step = speed * loop->definition().tick;
    while (std::abs(height - y) > step) {
      y += height > y ? step : -step;
      loop->tick();
    }
    y = height;
    loop->tick();
  }
  /// Past the interlock, with the whole force let in.
  void let_in() {
    tick(800);
    ASSERT_EQ(hand().state, HandState::running) << to_string(hand().state) << ' ' << reason(hand().fault);
  }

  Puppet device;
  Simulation sim;
  std::unique_ptr<HapticLoop> loop;
};

}  // namespace crumble
