// The measurements of docs/numerics.md, docs/contact.md and docs/paper.md that no report of the command line holds: the
// paper's 1 mm/s press of its cube under choices that the paper leaves open. scripts/press-curves builds and runs it.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>

#include "crumble/base/error.hpp"
#include "crumble/network/stability.hpp"
#include "sim/press_rig.hpp"

namespace crumble {
namespace {

constexpr std::array kDepths{2, 5, 10, 15, 20, 23, 26};  // mm, those of the prototype's curves

using Change = std::function<void(SimulationDef&)>;

PressRig make_rig(Preset preset, double speed, const Change& change, const char* scene = "tofu_cube") {
  PressRig rig(scene, preset, speed);
  change(rig.scene.def);
  rig.sim = Simulation(rig.scene.def);
  return rig;
}

Change friction(double at_rest, double sliding) {
  return [=](SimulationDef& def) { def.tools[0].friction = {at_rest, sliding}; };
}

// Of the paper's choices only those that concern the body: its masses and its time step.
Change paper_body(double at_rest, double sliding, ContactRule rule) {
  return [=](SimulationDef& def) {
    def.tools[0].friction = {at_rest, sliding};
    def.mass_rule = MassRule::equal;
    def.step.tau = 2.9e-3;
    def.step.contact_rule = rule;
  };
}

void print_curve(const char* name, Preset preset, const Change& change) {
  PressRig rig = make_rig(preset, 0.001, change);
  std::printf("%-44s", name);
  double peak = 0, first_cut = 0;
  const auto press = [&] {
    rig.press();
    peak = std::max(peak, norm(rig.sim.wrench(0).force));
    if (first_cut == 0 && rig.sim.counters().cuts > 0) first_cut = 1e3 * rig.speed * rig.sim.info().time;
  };
  for (const int depth : kDepths) {
    while (1e3 * rig.speed * rig.sim.info().time < depth) press();
    std::printf(" %5.2f", rig.sim.wrench(0).force.y());
  }
  std::printf("  %5.2f  %5.1f %5llu %5llu\n", peak, first_cut, static_cast<unsigned long long>(rig.sim.counters().cuts),
              static_cast<unsigned long long>(rig.sim.counters().guarded_nodes));
}

void print_curves() {
  std::printf("force upwards on the stick, N, at a depth of              peak, first cut,   cuts, guarded nodes\n%-44s",
              "");
  for (const int depth : kDepths) std::printf(" %2d mm", depth);
  std::printf("     N     mm\n");
  const auto keep = [](SimulationDef&) {};
  print_curve("default preset, friction 0", Preset::standard, friction(0, 0));
  print_curve("default preset (friction 0.5)", Preset::standard, keep);
  print_curve("default preset, friction 3.0 / 1.5", Preset::standard, friction(3, 1.5));
  print_curve("default preset, held (friction 1e6)", Preset::standard, friction(1e6, 1e6));
  constexpr ContactRule kNearest = ContactRule::nearest_surface, kAlong = ContactRule::along_motion;
  print_curve("equal masses, 2.9 ms, friction 0", Preset::standard, paper_body(0, 0, kNearest));
  print_curve("equal masses, 2.9 ms, held", Preset::standard, paper_body(1e6, 1e6, kNearest));
  print_curve("equal masses, 2.9 ms, along motion, friction 0", Preset::standard, paper_body(0, 0, kAlong));
  print_curve("equal masses, 2.9 ms, along motion, held", Preset::standard, paper_body(1e6, 1e6, kAlong));
  print_curve("paper preset", Preset::paper, keep);
}

// Greatest change of the force from one millisecond to the next, over both ways the stick can point and three speeds;
// the time step of all cases is 1 ms.
void print_jumps(const char* name, const Change& change) {
  std::printf("%-44s", name);
  for (const char* scene : {"tofu_cube", "tofu_cube_upright"}) {
    for (const double speed : {0.001, 0.005, 0.01}) {
      PressRig rig = make_rig(Preset::standard, speed, change, scene);
      Vec3 last = Vec3::Zero();
      double worst = 0;
      while (speed * rig.sim.info().time < 0.026) {
        rig.press();
        worst = std::max(worst, norm(rig.sim.wrench(0).force - last));
        last = rig.sim.wrench(0).force;
      }
      std::printf(" %6.3f", worst);
    }
  }
  std::printf("\n");
}

void print_all_jumps() {
  std::printf("\ngreatest change of the force within 1 ms, N, at         lying, mm/s          upright, mm/s\n%-44s",
              "");
  for (const int speed : {1, 5, 10, 1, 5, 10}) std::printf(" %6d", speed);
  std::printf("\n");
  print_jumps("default preset", [](SimulationDef&) {});
  print_jumps("default preset, cuts without fading", [](SimulationDef& def) { def.step.cut_fade = 0; });
  print_jumps("default preset, along-motion rule",
              [](SimulationDef& def) { def.step.contact_rule = ContactRule::along_motion; });
}

// The linear boundary by bisection; masses are equal, so all nodes have one drag.
double linear_limit(double eigenvalue, double drag, double mass) {
  double stable = 0, unstable = 1;
  for (int i = 0; i < 60; ++i) {
    const double tau = (stable + unstable) / 2;
    (eigenvalue * tau / drag < stability_limit(drag * tau / mass) ? stable : unstable) = tau;
  }
  return stable;
}

void print_time_steps() {
  std::printf("\ntime steps of the cube at k = 30 N/m, alpha = 30\n");
  for (const MassRule rule : {MassRule::lumped, MassRule::equal}) {
    const PressRig rig = make_rig(Preset::standard, 0.001, [&](SimulationDef& def) { def.mass_rule = rule; });
    const SpringNetwork& network = rig.sim.network();
    std::printf("%-44s certified %.2f ms", rule == MassRule::lumped ? "lumped masses" : "equal masses",
                1e3 * rig.sim.coefficients().certified_time_step);
    if (rule == MassRule::equal) {
      const double eigenvalue = largest_eigenvalue(network, rig.sim.mesh().positions);
      std::printf(", linear limit %.2f ms, greatest eigenvalue %.2f k, drag %.2f N s/m",
                  1e3 * linear_limit(eigenvalue, network.drags[0], network.masses[0]), eigenvalue / 30,
                  network.drags[0]);
    }
    std::printf("\n");
  }
}

void print_work() {
  PressRig rig = make_rig(Preset::standard, 0.001, [](SimulationDef& def) { def.step.energy_audit = true; });
  double work = 0;
  while (rig.speed * rig.sim.info().time < 0.005) {
    rig.press();
    work += rig.sim.wrench(0).force.y() * rig.speed * rig.scene.def.step.tau;
  }
  std::printf("\nwork by the reported force / work in the ledger, first 5 mm: %.3f\n",
              work / rig.sim.ledger().tool_work);
}

}  // namespace
}  // namespace crumble

int main() try {
  crumble::print_curves();
  crumble::print_all_jumps();
  crumble::print_time_steps();
  crumble::print_work();
  return 0;
} catch (const crumble::Error& error) {
  std::fprintf(stderr, "press_curves: %s\n", error.what());
  return 1;
}
