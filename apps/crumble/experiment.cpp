#include "experiment.hpp"

#include <algorithm>
#include <cmath>

#include "crumble/base/clock.hpp"
#include "crumble/base/text.hpp"

namespace crumble::app {
namespace {

// 2.7 hours at 1 ms; a step takes 160 bytes of recording and samples.
constexpr double kMaxSteps = 1e7;
constexpr double kDebrisRate = 60;  // Hz

std::unique_ptr<Device> open_press_device(const Scene& scene, const PressOptions& press) {
  return open_press(press, scene.def.step.tau * scene.def.step.iterations);
}

// How many ticks a device will be read for: what the caller asked, else what the motion lasts.
double duration(const Scene& scene, const std::string& device, const PressOptions& press,
                const Trajectory* trajectory) {
  if (!trajectory) return press.depth / press.speed;
  const double first = scene.replay.from && device.empty() ? *scene.replay.from : trajectory->rows.front().time;
  const double last = scene.replay.to && device.empty() ? *scene.replay.to : trajectory->rows.back().time;
  return last - first;
}

struct Motion {
  std::unique_ptr<Device> device;
  WorkspaceOptions workspace;
  double seconds = 0;
};

// A press moves in the scene's own frame. The scene's own trajectory is placed by the scene's workspace; any other
// begins, with its origin, where the tool starts.
Motion open_motion(const Scene& scene, const std::string& device) {
  const double tick = scene.def.step.tau * scene.def.step.iterations;
  const bool own_trajectory = device.empty() && scene.trajectory;
  if (own_trajectory) {
    return {open_replay(*scene.trajectory, scene.replay, tick), scene.workspace,
            duration(scene, device, scene.press, &*scene.trajectory)};
  }
  PressOptions press = scene.press;
  if (device.starts_with("press:")) {
    const auto speed = parse_double(std::string_view(device).substr(6));
    if (!speed) throw Error(Code::format, "--device '" + device + "': press:MM_PER_S takes a number");
    require_positive("--device press:MM_PER_S", *speed);
    press.speed = *speed * 1e-3;
  } else if (device.starts_with("replay:")) {
    const Trajectory trajectory = load_trajectory(device.substr(7));
    WorkspaceOptions workspace;
    workspace.pose.position = scene.start.position;
    workspace.mount = scene.start.orientation;
    return {open_replay(trajectory, {}, tick), workspace, duration(scene, device, press, &trajectory)};
  } else if (!device.empty()) {
    throw Error(Code::unsupported, "--device '" + device + "' is not known; there are press:MM_PER_S and replay:FILE");
  }
  return {open_press_device(scene, press), {}, duration(scene, device, press, nullptr)};
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

double tool_depth(const Scene& scene, const Pose& pose) {
  const Frame frame(pose);
  double lowest = frame.to_scene(scene.def.tools[0].shape.vertices[0]).y();
  for (const Vec3& v : scene.def.tools[0].shape.vertices) lowest = std::min(lowest, frame.to_scene(v).y());
  return scene.top - lowest;
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
                          const DebrisOptions& debris, const std::function<void(double)>& progress) {
  if (seconds) require_positive("--seconds", *seconds);
  Motion motion = open_motion(scene, device);
  const Workspace workspace(motion.workspace);
  Simulation sim(scene.def);
  Experiment experiment(std::move(scene), std::move(sim));
  experiment.device = motion.device->info().name;

  const double tick = experiment.scene.def.step.tau * experiment.scene.def.step.iterations;
  const std::size_t steps = count_steps(seconds.value_or(motion.seconds), tick);
  const auto debris_period = static_cast<std::size_t>(std::ceil(1 / (kDebrisRate * tick)));
  std::vector<double> cpu;
  DeviceSample sample;
  for (std::size_t step = 0; step < steps; ++step) {
    const ReadStatus status = motion.device->read(sample);
    if (status == ReadStatus::lost) throw Error(Code::device_lost, "device '" + experiment.device + "' was lost");
    experiment.resampled |= (sample.flags & sample_flag::kResampled) != 0;
    const Pose pose = workspace.to_scene(sample.pose);

    if (debris.rule.max_nodes > 0 && step % debris_period == 0) clear_debris(experiment, debris);
    const double before = thread_cpu_seconds();
    const StepInfo& info = experiment.sim.step({&pose, 1});
    cpu.push_back(1e6 * (thread_cpu_seconds() - before));
    require_done(info, step);

    const Wrench& wrench = experiment.sim.wrench(0);
    motion.device->write(workspace.force_to_device(wrench.force), workspace.torque_to_device(wrench.torque));
    experiment.recording.add({&pose, 1}, experiment.sim.state_hash());
    experiment.samples.push_back(
        {info.time, tool_depth(experiment.scene, pose), wrench, experiment.sim.counters().cuts});
    const auto events = experiment.sim.events();
    experiment.events.insert(experiment.events.end(), events.begin(), events.end());
    experiment.peak_force = std::max(experiment.peak_force, norm(wrench.force));
    if (progress && step % 256 == 0) progress(static_cast<double>(step) / static_cast<double>(steps));
  }
  experiment.cost = bench::percentiles(std::move(cpu));
  return experiment;
}

}  // namespace crumble::app
