#include "capture.hpp"

#include <algorithm>
#include <cmath>

#include "crumble/fracture/surface.hpp"

namespace crumble::app {
namespace {

// The extractor follows turning pieces from one update to the next, so it is refreshed as often as a viewer would.
constexpr double kRefresh = 1.0 / 60;

class SurfaceCamera {
 public:
  explicit SurfaceCamera(const TetMesh& mesh) : extractor_(mesh) {}

  void refresh(const Simulation& sim) {
    extractor_.update({sim.positions(), sim.intact(), sim.node_fragments(), sim.info().time});
  }

  Capture take(const Simulation& sim, std::size_t step, const Pose& tool) {
    refresh(sim);
    return {step, sim.info().time, tool, drawn()};
  }

 private:
  render::RenderMesh drawn() const {
    render::RenderMesh mesh;
    mesh.positions.assign(extractor_.positions().begin(), extractor_.positions().end());
    mesh.rest_positions.assign(extractor_.rest_positions().begin(), extractor_.rest_positions().end());
    mesh.triangles.assign(extractor_.triangles().begin(), extractor_.triangles().end());
    mesh.corner_normals.assign(extractor_.corner_normals().begin(), extractor_.corner_normals().end());
    mesh.materials.assign(mesh.triangles.size(), render::Material::interior);
    std::fill_n(mesh.materials.begin(), extractor_.skin_triangle_count(), render::Material::skin);
    return mesh;
  }

  SurfaceExtractor extractor_;
};

}  // namespace

Rerun rerun(const Recording& recording, StepSettings how, const std::vector<std::size_t>& steps) {
  Rerun result;
  how.energy_audit = true;
  Simulation sim = recording.start(how);
  SurfaceCamera camera(sim.mesh());
  std::size_t step = 0;
  double refreshed = 0;
  const auto differs = replay(recording, sim, [&](const Simulation& now) {
    if (!steps.empty() && now.info().time >= refreshed + kRefresh) {
      refreshed = now.info().time;
      camera.refresh(now);
    }
    const auto wanted = static_cast<std::size_t>(std::count(steps.begin(), steps.end(), step));
    if (wanted > 0) {
      const Pose tool = recording.tool_count() > 0 ? recording.poses(step)[0] : Pose{};
      result.captures.insert(result.captures.end(), wanted, camera.take(now, step, tool));
    }
    ++step;
    return true;
  });
  if (differs) {
    throw Error(Code::diverged,
                "run again, the state differs from the recorded one at step " + std::to_string(*differs));
  }
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
