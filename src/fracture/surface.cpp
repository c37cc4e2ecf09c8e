#include "crumble/fracture/surface.hpp"

#include <limits>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "surface_state.hpp"

namespace crumble {
namespace {

const SurfaceSettings& checked(const SurfaceSettings& settings) {
  require_in_range("settings.mode", static_cast<double>(settings.mode), 0, 2);
  require_in_range("settings.settle", settings.settle, 0, std::numeric_limits<double>::max());
  require_in_range("settings.crease", settings.crease, 0, kPi);
  return settings;
}

}  // namespace

SurfaceExtractor::SurfaceExtractor(const TetMesh& mesh, const SurfaceSettings& settings)
    : state_(std::make_unique<State>(mesh, checked(settings))) {}

SurfaceExtractor::~SurfaceExtractor() = default;

void SurfaceExtractor::update(const SurfaceInput& now) noexcept {
  state_->update(now);
}
void SurfaceExtractor::rebuild(const SurfaceInput& now) noexcept {
  state_->rebuild(now);
}
std::span<const Triangle> SurfaceExtractor::triangles() const noexcept {
  return state_->triangles().vertices();
}
std::size_t SurfaceExtractor::skin_triangle_count() const noexcept {
  return state_->triangles().skin_count();
}
std::span<const std::uint32_t> SurfaceExtractor::fragments() const noexcept {
  return state_->triangles().fragments();
}
std::span<const std::uint32_t> SurfaceExtractor::tetrahedra() const noexcept {
  return state_->triangles().tetrahedra();
}
std::span<const Vec3> SurfaceExtractor::positions() const noexcept {
  return state_->vertices().positions();
}
std::span<const Vec3> SurfaceExtractor::rest_positions() const noexcept {
  return state_->vertices().rest_positions();
}
std::span<const std::array<Eigen::Vector3f, 3>> SurfaceExtractor::corner_normals() const noexcept {
  return state_->normals().corners(state_->triangles().count());
}
std::span<const std::uint32_t> SurfaceExtractor::changed_triangles() const noexcept {
  return state_->triangles().changed.items();
}
std::span<const std::uint32_t> SurfaceExtractor::changed_vertices() const noexcept {
  return state_->vertices().changed.items();
}
bool SurfaceExtractor::rebuilt() const noexcept {
  return state_->rebuilt();
}
std::span<const std::uint32_t> SurfaceExtractor::skin_sources() const noexcept {
  return state_->triangles().outer_faces();
}
void SurfaceExtractor::spread_over_skin(std::span<const CornerCoordinates> boundary,
                                        std::span<CornerCoordinates> skin) const noexcept {
  state_->spread_over_skin(boundary, skin);
}
std::size_t SurfaceExtractor::max_triangle_count() const noexcept {
  return state_->triangles().bound();
}
std::size_t SurfaceExtractor::max_vertex_count() const noexcept {
  return state_->vertices().bound();
}

FragmentSurface fragment_surface(const SurfaceExtractor& surface, std::uint32_t fragment) {
  FragmentSurface part;
  Vector<std::uint32_t> part_vertices(surface.positions().size(), SurfaceTopology::kNone);
  for (std::uint32_t t = 0; t < surface.triangles().size(); ++t) {
    if (surface.fragments()[t] != fragment) continue;
    Triangle triangle = surface.triangles()[t];
    for (std::uint32_t& vertex : triangle) {
      std::uint32_t& part_vertex = part_vertices[vertex];
      if (part_vertex == SurfaceTopology::kNone) {
        part_vertex = static_cast<std::uint32_t>(part.vertices.size());
        part.vertices.push_back(vertex);
        part.mesh.vertices.push_back(surface.positions()[vertex]);
      }
      vertex = part_vertex;
    }
    part.triangles.push_back(t);
    part.mesh.triangles.push_back(triangle);
  }
  return part;
}

}  // namespace crumble
