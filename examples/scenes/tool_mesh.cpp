#include "scenes/tool_mesh.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>

#include "crumble/base/file.hpp"
#include "crumble/base/memory.hpp"
#include "scenes/mesh_formats.hpp"

namespace crumble {
namespace {

constexpr std::uintmax_t kMostBytes = std::uintmax_t{256} << 20;

[[noreturn]] void fail(Code code, const std::filesystem::path& file, const std::string& what) {
  throw Error(code, "mesh file '" + file.string() + "' " + what);
}

using Parse = TriangleMesh (*)(std::string_view);

Parse parser_of(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".stl") return parse_stl;
  if (extension == ".obj") return parse_obj;
  if (extension == ".ply") return parse_ply;
  fail(Code::unsupported, file, "must end in .stl, .obj or .ply");
}

std::string read_bounded(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(file, error);
  if (!error && bytes > kMostBytes) {
    fail(Code::too_large, file, "has " + std::to_string(bytes) + " bytes, more than " + std::to_string(kMostBytes));
  }
  return read_text(file);
}

// Vertices of equal coordinates become one; -0 equals 0.
TriangleMesh welded(const TriangleMesh& mesh, double scale) {
  TriangleMesh out;
  std::map<std::array<double, 3>, std::uint32_t> known;
  Vector<std::uint32_t> index;
  for (const Vec3& v : mesh.vertices) {
    const Vec3 place = scale * v;
    const auto [at, is_new] = known.try_emplace({place.x() + 0.0, place.y() + 0.0, place.z() + 0.0},
                                                static_cast<std::uint32_t>(out.vertices.size()));
    if (is_new) out.vertices.push_back(place);
    index.push_back(at->second);
  }
  for (const auto& [a, b, c] : mesh.triangles) out.triangles.push_back({index[a], index[b], index[c]});
  return out;
}

}  // namespace

TriangleMesh read_tool_mesh(const std::filesystem::path& file, double scale) {
  require_positive("scale", scale);
  const Parse parse = parser_of(file);
  const std::string bytes = read_bounded(file);
  TriangleMesh mesh;
  try {
    mesh = parse(bytes);
  } catch (const Error& error) {
    fail(error.code(), file, std::string("cannot be read: ") + error.what());
  }
  if (mesh.triangles.empty()) fail(Code::empty, file, "has no triangle");
  return welded(mesh, scale);
}

}  // namespace crumble
