#include "capture.hpp"

#include <algorithm>

#include "crumble/base/memory.hpp"

namespace crumble::app {
namespace {

constexpr double kRefresh = 1.0 / 60;  // seconds between two looks of the camera

}  // namespace

void rerun(const Recording& recording, Simulation& sim, SurfaceCamera& camera, const Vector<std::size_t>& steps,
           const std::function<void(std::size_t)>& take) {
  std::size_t step = 0;
  double refreshed = 0;
  auto next = steps.begin();
  const auto differs = replay(recording, sim, [&](const Simulation& now) {
    const bool is_wanted = next != steps.end() && *next == step;
    if (is_wanted || (next != steps.end() && now.info().time >= refreshed + kRefresh)) {
      refreshed = now.info().time;
      camera.refresh();
    }
    for (; next != steps.end() && *next == step; ++next) take(step);
    ++step;
    return true;
  });
  if (differs) {
    throw Error(Code::diverged,
                "run again, the state differs from the recorded one at step " + std::to_string(*differs));
  }
}

Rerun rerun(const Recording& recording, StepSettings how, const Vector<std::size_t>& steps) {
  Rerun result;
  how.energy_audit = true;
  Simulation sim = recording.start(how);
  SurfaceCamera camera(sim, SurfaceMode::cracks);
  rerun(recording, sim, camera, steps, [&](std::size_t step) {
    const auto poses = recording.poses(step);
    result.captures.push_back({step, {poses.begin(), poses.end()}, camera.surface()});
  });
  result.ledger = sim.ledger();
  return result;
}

Vector<std::size_t> phase_steps(const Experiment& experiment) {
  const Vector<Sample>& samples = experiment.samples;
  const std::size_t last = samples.size() - 1;
  if (!is_press(experiment.scene)) return {0, last / 3, 2 * last / 3, last};
  double deepest = 0;
  for (const Sample& sample : samples) deepest = std::max(deepest, sample.tools[0].depth);
  const auto first_at = [&](double depth) {
    const auto at =
        std::find_if(samples.begin(), samples.end(), [&](const Sample& s) { return s.tools[0].depth >= depth; });
    return std::min(static_cast<std::size_t>(at - samples.begin()), last);
  };
  return {0, first_at(0.15 * deepest), first_at(0.5 * deepest), first_at(deepest)};
}

render::RenderMesh tool_mesh(const Tool& tool, const Pose& hand) {
  const TriangleMesh& mesh = tool.shape->surface();
  render::RenderMesh drawn =
      render::make_render_mesh(mesh, Vector<render::Material>(mesh.triangles.size(), render::Material::wood), 40);
  drawn.rest_positions = drawn.positions;
  const Frame frame(compose(hand, tool.offset));
  for (Vec3& p : drawn.positions) p = frame.to_scene(p);
  for (auto& triangle : drawn.corner_normals) {
    for (Eigen::Vector3f& n : triangle) n = rotate(frame.rotation, n.cast<double>()).cast<float>();
  }
  return drawn;
}

}  // namespace crumble::app
