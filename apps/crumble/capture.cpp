#include "capture.hpp"

#include <algorithm>

namespace crumble::app {
namespace {

constexpr double kRefresh = 1.0 / 60;  // seconds between two looks of the camera

}  // namespace

void rerun(const Recording& recording, Simulation& sim, SurfaceCamera& camera, const std::vector<std::size_t>& steps,
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

Rerun rerun(const Recording& recording, StepSettings how, const std::vector<std::size_t>& steps) {
  Rerun result;
  how.energy_audit = true;
  Simulation sim = recording.start(how);
  SurfaceCamera camera(sim, SurfaceMode::cracks);
  rerun(recording, sim, camera, steps, [&](std::size_t step) {
    const Pose tool = recording.tool_count() > 0 ? recording.poses(step)[0] : Pose{};
    result.captures.push_back({step, tool, camera.surface()});
  });
  result.ledger = sim.ledger();
  return result;
}

std::vector<std::size_t> phase_steps(const std::vector<Sample>& samples) {
  double deepest = 0;
  for (const Sample& sample : samples) deepest = std::max(deepest, sample.depth);
  const auto first_at = [&](double depth) {
    const auto at = std::find_if(samples.begin(), samples.end(), [&](const Sample& s) { return s.depth >= depth; });
    return static_cast<std::size_t>(std::min(at, samples.end() - 1) - samples.begin());
  };
  return {0, first_at(0.15 * deepest), first_at(0.5 * deepest), first_at(deepest)};
}

render::RenderMesh tool_mesh(const ConvexPolyhedron& shape, const Pose& pose) {
  const TriangleMesh& mesh = shape.surface;
  render::RenderMesh drawn =
      render::make_render_mesh(mesh, std::vector<render::Material>(mesh.triangles.size(), render::Material::wood), 40);
  drawn.rest_positions = drawn.positions;
  const Frame frame(pose);
  for (Vec3& p : drawn.positions) p = frame.to_scene(p);
  for (auto& triangle : drawn.corner_normals) {
    for (Eigen::Vector3f& n : triangle) n = rotate(frame.rotation, n.cast<double>()).cast<float>();
  }
  return drawn;
}

}  // namespace crumble::app
