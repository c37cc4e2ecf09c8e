#include <charconv>
#include <map>

#include "crumble/base/memory.hpp"
#include "render/mesh_formats.hpp"

namespace crumble::render {
namespace {

// Shortest text that gives the same float or double back.
void add_numbers(std::string& out, const auto& v) {
  char buffer[32];
  for (int i = 0; i < 3; ++i) {
    out.append(" ").append(buffer, std::to_chars(buffer, buffer + sizeof buffer, v[i]).ptr);
  }
}

// Each normal once: corners of one facet share theirs, and so do most corners round a vertex of the skin.
class NormalTable {
 public:
  explicit NormalTable(const Surface& surface) {
    for (const CornerNormals& corners : surface.mesh.corner_normals) {
      for (const Eigen::Vector3f& n : corners) {
        const auto [at, is_new] = numbers_.emplace(std::array{n.x(), n.y(), n.z()}, numbers_.size() + 1);
        if (is_new) lines_ += "vn", add_numbers(lines_, n), lines_ += '\n';
      }
    }
  }
  const std::string& lines() const { return lines_; }
  std::size_t number(const Eigen::Vector3f& n) const { return numbers_.at({n.x(), n.y(), n.z()}); }

 private:
  std::map<std::array<float, 3>, std::size_t> numbers_;
  std::string lines_;
};

std::string vertex_lines(const Surface& surface) {
  std::string out;
  for (std::size_t i = 0; i < surface.mesh.positions.size(); ++i) {
    out += 'v';
    add_numbers(out, surface.mesh.positions[i]);
    if (!surface.colours.empty()) add_numbers(out, surface.colours[i]);
    out += '\n';
  }
  for (const Vec3& rest : surface.mesh.rest_positions) out += "vt", add_numbers(out, rest), out += '\n';
  return out;
}

// "f v", "f v/vt", "f v//vn" or "f v/vt/vn"; the texture coordinate of a vertex has its number.
std::string face_line(const Surface& surface, const NormalTable& normals, std::uint32_t t) {
  const bool has_rest = !surface.mesh.rest_positions.empty(), has_normals = !surface.mesh.corner_normals.empty();
  std::string out = "f";
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string number = std::to_string(surface.mesh.triangles[t][k] + 1);
    out.append(" ").append(number);
    if (has_rest || has_normals) out += '/';
    if (has_rest) out += number;
    if (has_normals) out.append("/").append(std::to_string(normals.number(surface.mesh.corner_normals[t][k])));
  }
  return out + '\n';
}

// The triangles of one material, of a surface without materials all as skin.
void add_faces(const Surface& surface, const NormalTable& normals, const Vector<std::uint32_t>& triangles,
               Material material, std::string& out) {
  const Vector<Material>& materials = surface.mesh.materials;
  bool is_named = materials.empty();
  for (const std::uint32_t t : triangles) {
    if ((materials.empty() ? Material::skin : materials[t]) != material) continue;
    if (!is_named) out.append("usemtl ").append(kMaterialLooks[static_cast<std::size_t>(material)].name) += '\n';
    is_named = true;
    out += face_line(surface, normals, t);
  }
}

}  // namespace

std::string to_obj(const Surface& surface, const std::string& materials) {
  std::string out = "# metres\n";
  if (!materials.empty()) out += "mtllib " + materials + '\n';
  const NormalTable normals(surface);
  out += vertex_lines(surface) + normals.lines();
  for (const auto& [fragment, triangles] : triangles_by_fragment(surface)) {
    if (!surface.fragments.empty()) out += "o fragment_" + std::to_string(fragment) + '\n';
    for (const Material material : {Material::skin, Material::interior}) {
      add_faces(surface, normals, triangles, material, out);
    }
  }
  return out;
}

std::string to_mtl() {
  std::string out;
  for (const MaterialLook& look : kMaterialLooks) {
    out.append("newmtl ").append(look.name) += "\nKd";
    add_numbers(out, look.colour);
    out += "\nKs 0.04 0.04 0.04\nNs 20\nillum 2\n";
  }
  return out;
}

}  // namespace crumble::render
