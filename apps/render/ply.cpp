#include <algorithm>
#include <cmath>

#include "crumble/base/bytes.hpp"
#include "render/mesh_formats.hpp"

namespace crumble::render {
namespace {

// Readers skip properties that they do not know. u, v, w would be taken for a picture's place by some.
std::string header(const Surface& surface) {
  std::string text = "ply\nformat binary_little_endian 1.0\ncomment metres\nelement vertex ";
  text += std::to_string(surface.mesh.positions.size()) + "\nproperty float x\nproperty float y\nproperty float z\n";
  if (!surface.mesh.rest_positions.empty()) {
    text += "property float rest_x\nproperty float rest_y\nproperty float rest_z\n";
  }
  if (!surface.colours.empty()) text += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  text += "element face " + std::to_string(surface.mesh.triangles.size());
  text += "\nproperty list uchar int vertex_indices\n";
  if (!surface.fragments.empty()) text += "property int fragment\n";
  if (!surface.mesh.materials.empty()) text += "property uchar material\n";
  return text + "end_header\n";
}

void put_vector(ByteWriter& out, const Vec3& v) {
  for (int i = 0; i < 3; ++i) out.put(static_cast<float>(v[i]));
}

}  // namespace

std::string to_ply(const Surface& surface) {
  const RenderMesh& mesh = surface.mesh;
  ByteWriter out;
  const std::string text = header(surface);
  out.put_raw(text.data(), text.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    put_vector(out, mesh.positions[i]);
    if (!mesh.rest_positions.empty()) put_vector(out, mesh.rest_positions[i]);
    for (int k = 0; !surface.colours.empty() && k < 3; ++k) {
      out.put(static_cast<std::uint8_t>(std::lround(255 * std::clamp(surface.colours[i][k], 0.0, 1.0))));
    }
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    out.put(std::uint8_t{3});
    for (const std::uint32_t v : mesh.triangles[t]) out.put(v);
    if (!surface.fragments.empty()) out.put(surface.fragments[t]);
    if (!mesh.materials.empty()) out.put(static_cast<std::uint8_t>(mesh.materials[t]));
  }
  return {out.bytes().begin(), out.bytes().end()};
}

}  // namespace crumble::render
