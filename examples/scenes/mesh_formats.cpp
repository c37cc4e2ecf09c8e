#include "scenes/mesh_formats.hpp"

#include <cstring>

#include "crumble/base/memory.hpp"
#include "scenes/text_lines.hpp"

namespace crumble {
namespace {

constexpr std::size_t kStlHead = 84, kStlTriangle = 50;

void add_corner(const Vec3& p, TriangleMesh& mesh) {
  const auto index = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(p);
  if (index % 3 == 2) mesh.triangles.push_back({index - 2, index - 1, index});
}

TriangleMesh parse_binary_stl(std::string_view bytes, std::size_t count) {
  TriangleMesh mesh;
  for (std::size_t t = 0; t < count; ++t) {
    float corners[9];
    std::memcpy(corners, bytes.data() + kStlHead + kStlTriangle * t + 12, sizeof corners);
    for (int i = 0; i < 9; i += 3) {
      const Vec3 p(corners[i], corners[i + 1], corners[i + 2]);
      if (!is_finite(p)) throw Error(Code::format, "triangle " + std::to_string(t) + " is not finite");
      add_corner(p, mesh);
    }
  }
  return mesh;
}

TriangleMesh parse_text_stl(std::string_view text) {
  TriangleMesh mesh;
  TextLines lines(text);
  bool complete = false;
  while (lines.next()) {
    complete = lines.starts_with("endsolid");
    if (lines.starts_with("vertex")) add_corner(lines.point(1), mesh);
    if (lines.starts_with("endfacet") && mesh.vertices.size() != 3 * mesh.triangles.size()) {
      lines.fail("ends a facet that has not 3 vertices");
    }
  }
  if (!complete || mesh.vertices.size() != 3 * mesh.triangles.size()) lines.fail("is not the end: endsolid is missing");
  return mesh;
}

}  // namespace

// A binary file may begin with "solid" too, so its size decides.
TriangleMesh parse_stl(std::string_view bytes) {
  std::uint32_t count = 0;
  if (bytes.size() >= kStlHead) std::memcpy(&count, bytes.data() + kStlHead - sizeof count, sizeof count);
  const std::size_t expected = kStlHead + kStlTriangle * std::size_t{count};
  if (bytes.size() >= kStlHead && bytes.size() == expected) return parse_binary_stl(bytes, count);
  if (bytes.starts_with("solid")) return parse_text_stl(bytes);
  throw Error(Code::format, "it has " + std::to_string(bytes.size()) + " bytes, as a binary STL file it would have " +
                                std::to_string(expected) + ", and it does not begin with 'solid'");
}

TriangleMesh parse_obj(std::string_view bytes) {
  TriangleMesh mesh;
  TextLines lines(bytes);
  while (lines.next()) {
    if (lines.starts_with("v")) mesh.vertices.push_back(lines.point(1));
    if (!lines.starts_with("f")) continue;
    Vector<std::uint32_t> corners;
    for (std::size_t i = 1; i < lines.words().size(); ++i) {
      const std::string_view word = lines.words()[i];
      const double index = parse_double(word.substr(0, word.find('/'))).value_or(0);
      const auto count = static_cast<double>(mesh.vertices.size());
      const double from_start = index < 0 ? count + index : index - 1;  // negative: from the last one backward
      if (!(from_start >= 0 && from_start < count) || from_start != std::floor(from_start)) {
        lines.fail("names vertex '" + std::string(word) + "' of " + std::to_string(mesh.vertices.size()));
      }
      corners.push_back(static_cast<std::uint32_t>(from_start));
    }
    if (corners.size() < 3) lines.fail("is a face of fewer than 3 vertices");
    add_polygon(corners, mesh.triangles);
  }
  return mesh;
}

}  // namespace crumble
