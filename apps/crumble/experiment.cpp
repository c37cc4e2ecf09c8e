#include "experiment.hpp"

#include <algorithm>
#include <cmath>

#include "crumble/base/clock.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/text.hpp"

namespace crumble::app {
namespace {

// 2.7 hours at 1 ms; a step takes 160 bytes of recording and samples.
constexpr double kMaxSteps = 1e7;
constexpr double kDebrisRate = 60;  // Hz

// The scene's own motion of its first tool, or what the command line puts in its place. A trajectory from there begins,
// with its origin, where the tool starts.
Motion first_motion(const Scene& scene, const std::string& device) {
  Motion motion = scene.motions[0];
  if (device.empty()) return motion;
  motion.path.clear();
  motion.trajectory.reset();
  if (device.starts_with("press:")) {
    const auto speed = parse_double(std::string_view(device).substr(6));
    if (!speed) throw Error(Code::format, "--device '" + device + "': press:MM_PER_S takes a number");
    require_positive("--device press:MM_PER_S", *speed);
    motion.press.speed = *speed * 1e-3;
  } else if (device.starts_with("replay:")) {
    motion.trajectory = load_trajectory(device.substr(7));
    motion.replay = {};
    motion.workspace = {};
    motion.workspace.pose.position = motion.start.position;
    motion.workspace.mount = motion.start.orientation;
  } else {
    throw Error(Code::unsupported, "--device '" + device + "' is not known; there are press:MM_PER_S and replay:FILE");
  }
  return motion;
}

// What moves the tools and attachments of a scene.
class Movers {
 public:
  Movers(const Scene& scene, const std::string& device) {
    movers_.push_back(open_motion(first_motion(scene, device), scene.tick()));
    for (std::size_t i = 1; i < scene.motions.size(); ++i) {
      movers_.push_back(open_motion(scene.motions[i], scene.tick()));
    }
    poses_.resize(movers_.size());
  }
  std::string names() const {
    std::string names;
    for (const MotionDevice& m : movers_) names += (names.empty() ? "" : ", ") + m.device->info().name;
    return names;
  }
  double seconds() const { return std::ranges::max_element(movers_, {}, &MotionDevice::seconds)->seconds; }
  // True when a pose was resampled.
  bool read() {
    bool resampled = false;
    for (std::size_t i = 0; i < movers_.size(); ++i) {
      DeviceSample sample;
      if (movers_[i].device->read(sample) == ReadStatus::lost) {
        throw Error(Code::device_lost, "device '" + movers_[i].device->info().name + "' was lost");
      }
      resampled |= (sample.flags & sample_flag::kResampled) != 0;
      poses_[i] = movers_[i].workspace.to_scene(sample.pose);
    }
    return resampled;
  }
  void write(std::size_t i, const Wrench& wrench) {
    movers_[i].device->write(movers_[i].workspace.force_to_device(wrench.force),
                             movers_[i].workspace.torque_to_device(wrench.torque));
  }
  std::span<const Pose> poses() const { return poses_; }

 private:
  Vector<MotionDevice> movers_;
  Vector<Pose> poses_;
};

double tool_depth(const Scene& scene, std::size_t tool, const Pose& pose) {
  const Tool& t = scene.def.tools[tool];
  return scene.top - lowest_point(*t.shape, Frame(compose(pose, t.offset)));
}

void clear_debris(Experiment& experiment, const DebrisOptions& debris) {
  for (const std::uint32_t fragment : experiment.sim.find_debris(debris.rule)) {
    if (experiment.sim.fragment_state(fragment) == debris.fate) continue;
    experiment.sim.set_fragment_state(fragment, debris.fate);
    experiment.recording.add_fragment_state(fragment, debris.fate);
  }
}

std::size_t count_steps(double seconds, double tick) {
  const double steps = std::floor(seconds / tick + 1.5);
  if (!(steps <= kMaxSteps)) {
    throw Error(Code::too_large, to_text(seconds) + " s of motion are more than " + to_text(kMaxSteps) + " steps of " +
                                     to_text(tick) + " s, the most that a run keeps");
  }
  return static_cast<std::size_t>(steps);
}

void require_done(const StepInfo& info, std::size_t step) {
  if (info.status == Code::diverged) {
    throw Error(Code::diverged,
                "the body diverged at step " + std::to_string(info.step) + ", node " + std::to_string(info.bad_node));
  }
  if (info.status != Code{}) throw Error(info.status, "step " + std::to_string(step) + " was refused: bad pose");
}

}  // namespace

bool is_press(const Scene& scene) {
  return scene.motions.size() == 1 && scene.motions[0].path.empty();
}

std::string tool_name(const Scene& scene, std::size_t tool) {
  return scene.def.tools.size() == 1 ? "the tool" : "tool " + std::to_string(tool + 1);
}

std::size_t count_fragments(const Simulation& sim) {
  return sim.fragments().count() - sim.counters().removed;
}

std::size_t count_inverted(const Simulation& sim) {
  const VecView x = sim.positions();
  const auto inverted = [&](const Tetrahedron& t) { return orient(x[t[0]], x[t[1]], x[t[2]], x[t[3]]) < 0; };
  return static_cast<std::size_t>(std::count_if(sim.mesh().tetrahedra.begin(), sim.mesh().tetrahedra.end(), inverted));
}

Experiment run_experiment(Scene scene, const std::string& device, std::optional<double> seconds,
                          const DebrisOptions& debris, LiveChanges changes,
                          const std::function<void(double)>& progress) {
  if (seconds) require_positive("--seconds", *seconds);
  Movers movers(scene, device);
  Simulation sim(scene.def);
  Experiment experiment(std::move(scene), std::move(sim));
  experiment.device = movers.names();
  experiment.peak_forces.resize(experiment.scene.def.tools.size());

  const double tick = experiment.scene.tick();
  const std::size_t steps = count_steps(seconds.value_or(movers.seconds()), tick);
  const auto debris_period = static_cast<std::size_t>(std::ceil(1 / (kDebrisRate * tick)));
  Vector<double> cpu;
  for (std::size_t step = 0; step < steps; ++step) {
    experiment.resampled |= movers.read();
    if (debris.rule.max_nodes > 0 && step % debris_period == 0) clear_debris(experiment, debris);
    changes.make_due(experiment.sim, experiment.recording);
    const double before = thread_cpu_seconds();
    const StepInfo& info = experiment.sim.step(movers.poses());
    cpu.push_back(1e6 * (thread_cpu_seconds() - before));
    require_done(info, step);

    experiment.recording.add(movers.poses(), experiment.sim.state_hash());
    Sample sample{info.time, {}, experiment.sim.counters().cuts};
    for (std::size_t tool = 0; tool < experiment.peak_forces.size(); ++tool) {
      const Wrench& wrench = experiment.sim.wrench(tool);
      movers.write(tool, wrench);
      sample.tools.push_back({tool_depth(experiment.scene, tool, movers.poses()[tool]), wrench});
      experiment.peak_forces[tool] = std::max(experiment.peak_forces[tool], norm(wrench.force));
    }
    experiment.samples.push_back(std::move(sample));
    const auto events = experiment.sim.events();
    experiment.events.insert(experiment.events.end(), events.begin(), events.end());
    if (progress && step % 256 == 0) progress(static_cast<double>(step) / static_cast<double>(steps));
  }
  experiment.cost = bench::percentiles(std::move(cpu));
  return experiment;
}

}  // namespace crumble::app
