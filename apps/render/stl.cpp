#include <array>

#include "crumble/base/bytes.hpp"
#include "crumble/base/memory.hpp"
#include "render/mesh_formats.hpp"

namespace crumble::render {

// Every triangle with its own three corners and the normal of its plane; the format has room for no more.
std::string to_stl(const Surface& surface) {
  ByteWriter out;
  const auto put_vector = [&](const Vec3& v) {
    for (int i = 0; i < 3; ++i) out.put(static_cast<float>(v[i]));
  };
  const std::array<char, 80> header = {"crumble surface, metres"};
  out.put_raw(header.data(), header.size());
  const Vector<Vec3>& at = surface.mesh.positions;
  out.put(static_cast<std::uint32_t>(surface.mesh.triangles.size()));
  for (const auto& [a, b, c] : surface.mesh.triangles) {
    const Vec3 across = cross(at[b] - at[a], at[c] - at[a]);
    const double length = norm(across);
    put_vector(length > 0 ? Vec3(across / length) : Vec3::Zero());
    for (const std::uint32_t v : {a, b, c}) put_vector(at[v]);
    out.put(std::uint16_t{0});
  }
  return {out.bytes().begin(), out.bytes().end()};
}

}  // namespace crumble::render
