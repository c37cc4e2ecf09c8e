#include "surface_camera.hpp"

#include <algorithm>

namespace crumble::app {

SurfaceCamera::SurfaceCamera(const Simulation& sim, SurfaceMode mode)
    : sim_(&sim), extractor_(sim.mesh(), SurfaceSettings{.mode = mode, .settle = 0}) {}

void SurfaceCamera::refresh() {
  extractor_.update({sim_->positions(), sim_->intact(), sim_->node_fragments(), sim_->info().time});
}

render::Surface SurfaceCamera::surface() const {
  const auto copy = [](const auto& from, auto& to) { to.assign(from.begin(), from.end()); };
  render::Surface surface;
  render::RenderMesh& mesh = surface.mesh;
  copy(extractor_.positions(), mesh.positions);
  copy(extractor_.rest_positions(), mesh.rest_positions);
  copy(extractor_.triangles(), mesh.triangles);
  copy(extractor_.corner_normals(), mesh.corner_normals);
  mesh.materials.assign(mesh.triangles.size(), render::Material::interior);
  std::fill_n(mesh.materials.begin(), extractor_.skin_triangle_count(), render::Material::skin);
  copy(extractor_.fragments(), surface.fragments);
  copy(extractor_.tetrahedra(), surface.tetrahedra);
  surface.time = sim_->info().time;
  return surface;
}

}  // namespace crumble::app
