// The experiment of docs/contact.md: the paper's rule of contact, its mean of forces and its whole preset beside the
// default, in the press of the paper's cube by a stick that lies across it and by one that stands on it; and thin tools
// with and without samples of the surface between nodes. scripts/contact-experiment builds and runs it.
//   contact_experiment FOLDER     prints the tables; curves go to FOLDER as CSV, pictures as PNG
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <optional>

#include "crumble/base/error.hpp"
#include "crumble/base/file.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/text.hpp"
#include "sim/contact_plots.hpp"
#include "sim/press_rig.hpp"

namespace crumble {
namespace {

constexpr double kSpeed = 0.001;  // m/s, downwards

struct Sample {
  double depth = 0;   // m
  double force = 0;   // upwards, N
  double change = 0;  // of the force vector since the last step, N
  double way = 0;     // of the contact node that went farthest in this step, m
  std::uint64_t cuts = 0;
};

struct Press {
  std::string name, scene;
  Preset preset = Preset::standard;
  std::function<void(SimulationDef&)> change = [](SimulationDef&) {};
  double depth = 0.026;  // m

  crumble::Vector<Sample> samples = {};
  double tau = 0, tool_work = 0;   // s, J
  crumble::Vector<Vec3> end = {};  // positions
};

double farthest_contact(const Simulation& sim, const crumble::Vector<Vec3>& before) {
  double farthest = 0;
  for (const NodeConstraint& c : sim.contacts()) {
    farthest = std::max(farthest, norm(sim.positions()[c.node] - before[c.node]));
  }
  return farthest;
}

void run(Press& press) {
  PressRig rig(press.scene, press.preset, kSpeed, true);
  press.change(rig.scene.def);
  rig.sim = Simulation(rig.scene.def);
  press.tau = rig.scene.def.step.tau;
  crumble::Vector<Vec3> before(rig.sim.mesh().positions);
  Vec3 last = Vec3::Zero();
  while (kSpeed * rig.sim.info().time < press.depth) {
    rig.press();
    const Vec3 force = rig.sim.wrench(0).force;
    press.samples.push_back({kSpeed * rig.sim.info().time, force.y(), norm(force - last),
                             farthest_contact(rig.sim, before), rig.sim.counters().cuts});
    last = force;
    for (std::size_t i = 0; i < before.size(); ++i) before[i] = rig.sim.positions()[i];
  }
  press.tool_work = rig.sim.ledger().tool_work;
  press.end = std::move(before);
}

template <class Value>
double greatest(const Press& press, Value&& value) {
  double most = 0;
  for (const Sample& sample : press.samples) most = std::max(most, value(sample));
  return most;
}

double reported_work(const Press& press) {
  double work = 0;
  for (const Sample& sample : press.samples) work += sample.force * kSpeed * press.tau;
  return work;
}

void print_row(const Press& press) {
  const double peak = greatest(press, [](const Sample& s) { return s.force; });
  const double change = greatest(press, [](const Sample& s) { return s.change; });
  const double way = greatest(press, [](const Sample& s) { return s.way; });
  std::printf("%-34s %5.1f %7.2f %6llu %9.3f %9.3f %9.3f %9.2f %9.2f\n", press.name.c_str(), 1e3 * press.tau, peak,
              static_cast<unsigned long long>(press.samples.back().cuts), change, change / (1e3 * press.tau), 1e3 * way,
              1e3 * reported_work(press), 1e3 * press.tool_work);
}

void write_csv(const Press& press, const std::filesystem::path& folder) {
  std::string text = "depth_mm,force_n,change_in_step_n,farthest_contact_node_mm,cuts\n";
  for (const Sample& s : press.samples) {
    text += to_text(1e3 * s.depth) + "," + to_text(s.force) + "," + to_text(s.change) + "," + to_text(1e3 * s.way) +
            "," + std::to_string(s.cuts) + "\n";
  }
  std::string name = press.name;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == ' ' || c == ',' || c == ':'; }, '_');
  write_text(folder / (name + ".csv"), text);
}

// By how many steps `late` has to be drawn ahead to lie on `raw` best.
int best_shift(const Press& raw, const Press& late) {
  constexpr int kMost = 10;
  crumble::Vector<double> squares(kMost + 1);
  for (std::size_t i = kMost; i < raw.samples.size(); ++i) {
    for (std::size_t shift = 0; shift <= kMost; ++shift) {
      const double miss = late.samples[i].force - raw.samples[i - shift].force;
      squares[shift] += miss * miss;
    }
  }
  return static_cast<int>(std::min_element(squares.begin(), squares.end()) - squares.begin());
}

void print_delay(const Press& raw, const Press& mean) {
  const int shift = best_shift(raw, mean);
  std::printf("%-34s later than '%s' by %d steps, %.1f ms; the body is %s\n", mean.name.c_str(), raw.name.c_str(),
              shift, 1e3 * shift * raw.tau, raw.end == mean.end ? "the same to the last bit" : "another");
}

Curve curve(const Press& press, const char* title, double Sample::*value, double per = 1) {
  Curve result{title, {}, {}};
  for (const Sample& s : press.samples) result.x.push_back(1e3 * s.depth), result.y.push_back(s.*value / per);
  return result;
}

// Of the greatest change of each tenth of a millimetre, per millisecond.
Curve changes(const Press& press, const char* title) {
  Curve result{title, {}, {}};
  for (const Sample& s : press.samples) {
    const double place = std::floor(1e4 * s.depth) / 10 + 0.05, change = std::max(1e-4, s.change / (1e3 * press.tau));
    if (result.x.empty() || result.x.back() < place) result.x.push_back(place), result.y.push_back(0);
    result.y.back() = std::max(result.y.back(), change);
  }
  return result;
}

// The 60 ms round the greatest change of `raw`, over ms.
Panel around_greatest_change(const char* title, const Press& raw, const Press& mean) {
  const auto most = std::max_element(raw.samples.begin(), raw.samples.end(),
                                     [](const Sample& a, const Sample& b) { return a.change < b.change; });
  const double middle = most->depth / kSpeed;
  Panel panel{title, "time (ms)", "force on the stick (N)", {}, false};
  for (const auto& [press, name] : {std::pair{&raw, "the force (Eq 6)"}, std::pair{&mean, "mean of five (Eq 7)"}}) {
    Curve curve{name, {}, {}};
    for (const Sample& s : press->samples) {
      const double time = 1e3 * (s.depth / kSpeed - middle);
      if (std::abs(time) <= 30) curve.x.push_back(time), curve.y.push_back(s.force);
    }
    panel.curves.push_back(std::move(curve));
  }
  return panel;
}

const auto kAlongMotion = [](SimulationDef& def) { def.step.contact_rule = ContactRule::along_motion; };
const auto kMean = [](SimulationDef& def) { def.step.mean_force = true; };
const auto kNoMean = [](SimulationDef& def) { def.step.mean_force = false; };

struct Stick {  // one way to hold it
  Press standard, along, mean, paper, paper_no_mean;

  Stick(const std::string& pose, const std::string& scene)
      : standard{pose + ", default", scene},
        along{pose + ", along-motion rule alone", scene, Preset::standard, kAlongMotion},
        mean{pose + ", mean of five alone", scene, Preset::standard, kMean},
        paper{pose + ", paper preset", scene, Preset::paper},
        paper_no_mean{pose + ", paper preset without mean", scene, Preset::paper, kNoMean} {}

  Panel forces(const char* title) const {
    return {title,
            "depth (mm)",
            "force on the stick (N)",
            {curve(standard, "default", &Sample::force), curve(along, "along motion", &Sample::force),
             curve(paper, "paper preset", &Sample::force)},
            false};
  }
  Panel force_changes(const char* title) const {
    return {title,
            "depth (mm)",
            "greatest change (N per ms)",
            {changes(standard, "default"), changes(along, "along motion"), changes(paper, "paper preset")},
            true};
  }
};

std::function<void(SimulationDef&)> friction(double coefficient) {
  return [=](SimulationDef& def) { def.tools[0].friction = {coefficient, coefficient}; };
}

const auto kFlatStick = [](SimulationDef& def) { def.tools[0].shape = make_bar({0.003, 0.010, 0.05}); };
const auto kNodesOnly = [](SimulationDef& def) { def.step.surface_samples = false; };

Panel thin_panel(const char* title, const Press& samples, const Press& nodes) {
  return {title,
          "depth (mm)",
          "force on the tool (N)",
          {curve(samples, "samples (default)", &Sample::force), curve(nodes, "nodes only", &Sample::force)},
          false};
}

void experiment(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  Stick lying("lying", "tofu_cube"), upright("upright", "tofu_cube_upright");
  Press smooth{"lying, default, friction 0", "tofu_cube", Preset::standard, friction(0)};
  Press rough{"lying, default, nothing slides", "tofu_cube", Preset::standard, friction(1e6)};
  Press needle{"needle, default", "tofu_needle", Preset::standard, [](SimulationDef&) {}, 0.015};
  Press needle_nodes{"needle, nodes only", "tofu_needle", Preset::standard, kNodesOnly, 0.015};
  Press flat{"3 x 10 mm upright, default", "tofu_needle", Preset::standard, kFlatStick, 0.015};
  Press flat_nodes{"3 x 10 mm upright, nodes only", "tofu_needle", Preset::standard,
                   [](SimulationDef& def) { kFlatStick(def), kNodesOnly(def); }, 0.015};

  std::printf(
      "1 mm/s                              step    peak   cuts  change of the force    farthest  work by   work of\n"
      "                                      ms       N         N in step  N per ms   node, mm  force, mJ tool, mJ\n");
  for (Press* press : {&lying.standard, &lying.along, &lying.mean, &lying.paper, &lying.paper_no_mean,
                       &upright.standard, &upright.along, &upright.mean, &upright.paper, &upright.paper_no_mean,
                       &smooth, &rough, &needle, &needle_nodes, &flat, &flat_nodes}) {
    run(*press);
    print_row(*press);
    write_csv(*press, folder);
  }
  for (const Stick* stick : {&lying, &upright}) {
    print_delay(stick->standard, stick->mean);
    print_delay(stick->paper_no_mean, stick->paper);
  }
  draw_panels(crumble::Vector<Panel>{lying.forces("stick lying across the cube"), upright.forces("stick upright")},
              folder / "contact_force.png");
  draw_panels(crumble::Vector<Panel>{lying.force_changes("stick lying across the cube"),
                                     upright.force_changes("stick upright")},
              folder / "contact_change.png");
  draw_panels(
      crumble::Vector<Panel>{
          around_greatest_change("default, where it changes most", lying.standard, lying.mean),
          around_greatest_change("paper preset, where it changes most", lying.paper_no_mean, lying.paper)},
      folder / "contact_mean.png");
  draw_panels(crumble::Vector<Panel>{thin_panel("needle of 2 mm, upright", needle, needle_nodes),
                                     thin_panel("stick of 3 x 10 mm, upright", flat, flat_nodes)},
              folder / "contact_thin.png");
}

}  // namespace
}  // namespace crumble

int main(int argc, char** argv) try {
  if (argc != 2) {
    std::fprintf(stderr, "usage: contact_experiment FOLDER\n");
    return 2;
  }
  crumble::experiment(argv[1]);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "contact_experiment: %s\n", error.what());
  return 1;
}
