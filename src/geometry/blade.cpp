#include "crumble/base/memory.hpp"
#include "crumble/geometry/tool_solids.hpp"
#include "geometry/round_solids.hpp"

namespace crumble {

ConvexPolyhedron make_blade(const Vec3& size, double bevel) {
  require_size("size.x", size.x());
  require_size("size.y", size.y());
  require_size("size.z", size.z());
  require_positive("bevel", bevel);
  require_in_range("bevel", bevel, 0, size.y());
  const double x = size.x() / 2, y = size.y() / 2, z = size.z() / 2;
  // across the blade, counter-clockwise from the edge; a wedge has no straight part
  Vector<std::array<double, 2>> outline{{0, -y}, {x, bevel - y}, {x, y}, {-x, y}, {-x, bevel - y}};
  if (bevel == size.y()) outline = {{0, -y}, {x, y}, {-x, y}};
  TriangleMesh mesh;
  for (const auto& [px, py] : outline) {
    mesh.vertices.push_back({px, py, -z});
    mesh.vertices.push_back({px, py, z});
  }
  const auto corners = static_cast<std::uint32_t>(outline.size());
  for (std::uint32_t i = 0; i < corners; ++i) {
    const std::uint32_t back = 2 * i, next = 2 * ((i + 1) % corners);
    mesh.triangles.push_back({back, next, next + 1});
    mesh.triangles.push_back({back, next + 1, back + 1});
    if (i > 0 && i + 1 < corners) {
      mesh.triangles.push_back({0, next, back});
      mesh.triangles.push_back({1, back + 1, next + 1});
    }
  }
  return make_convex(mesh);
}

}  // namespace crumble
