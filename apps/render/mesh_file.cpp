// assimp 5.2's exporter was tried and is no help: its obj and glb join vertices that are in the same place, which welds
// every closed crack shut, and its binary ply declares colours as bytes but writes them as floats. The tests read every
// format back with other programs' readers.
#include "render/mesh_file.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "render/file_set.hpp"
#include "render/mesh_formats.hpp"

namespace crumble::render {
namespace {

void check_count(const std::string& field, std::size_t size, std::size_t count) {
  if (size != 0 && size != count) {
    throw Error(Code::mesh, field + " must have " + std::to_string(count) + " entries, has " + std::to_string(size));
  }
}

void check_vectors(const std::string& field, const Vector<Vec3>& values, std::size_t count) {
  check_count(field, values.size(), count);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!is_finite(values[i])) throw Error(Code::invalid_value, field + "[" + std::to_string(i) + "] must be finite");
  }
}

void check_triangle(const Surface& surface, std::size_t t) {
  const auto fail = [&](Code code, const std::string& field, const std::string& reason) {
    throw Error(code, field + "[" + std::to_string(t) + "] " + reason);
  };
  const RenderMesh& mesh = surface.mesh;
  for (const std::uint32_t v : mesh.triangles[t]) {
    if (v < mesh.positions.size()) continue;
    fail(Code::mesh, "triangles", "names vertex " + std::to_string(v) + " of " + std::to_string(mesh.positions.size()));
  }
  if (!mesh.materials.empty() && mesh.materials[t] != Material::skin && mesh.materials[t] != Material::interior) {
    fail(Code::mesh, "materials", "must be 0 (skin) or 1 (interior)");
  }
  if (mesh.corner_normals.empty()) return;
  for (const Eigen::Vector3f& n : mesh.corner_normals[t]) {
    if (!n.allFinite()) fail(Code::invalid_value, "corner_normals", "must be finite");
  }
}

void check(const Surface& surface) {
  const RenderMesh& mesh = surface.mesh;
  const std::size_t vertices = mesh.positions.size(), triangles = mesh.triangles.size();
  if (triangles == 0) throw Error(Code::empty, "triangles must have at least one entry, have 0");
  check_vectors("positions", mesh.positions, vertices);
  check_vectors("rest_positions", mesh.rest_positions, vertices);
  check_vectors("colours", surface.colours, vertices);
  check_count("corner_normals", mesh.corner_normals.size(), triangles);
  check_count("materials", mesh.materials.size(), triangles);
  check_count("fragments", surface.fragments.size(), triangles);
  check_count("tetrahedra", surface.tetrahedra.size(), triangles);
  for (std::size_t t = 0; t < triangles; ++t) check_triangle(surface, t);
}

void add_obj(const Surface& surface, const std::filesystem::path& path, FileSet& files) {
  std::filesystem::path materials;
  if (!surface.mesh.materials.empty()) {
    materials = std::filesystem::path(path).replace_extension(".mtl");
    files.add(materials, to_mtl());
  }
  files.add(path, to_obj(surface, materials.filename().string()));
}

template <std::string (*kEncode)(const Surface&)>
void add_one(const Surface& surface, const std::filesystem::path& path, FileSet& files) {
  files.add(path, kEncode(surface));
}

struct Format {
  const char* extension;
  void (*add)(const Surface&, const std::filesystem::path&, FileSet&);
};
constexpr std::array<Format, 5> kFormats{{{".glb", add_one<to_glb>},
                                          {".obj", add_obj},
                                          {".ply", add_one<to_ply>},
                                          {".stl", add_one<to_stl>},
                                          {".vtu", add_one<to_vtu>}}};

const Format& format_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (const Format& format : kFormats) {
    if (extension == format.extension) return format;
  }
  throw Error(Code::unsupported, "mesh file '" + path.string() + "' must end in one of " + mesh_file_extensions());
}

}  // namespace

Vector<std::pair<std::uint32_t, Vector<std::uint32_t>>> triangles_by_fragment(const Surface& surface) {
  std::map<std::uint32_t, Vector<std::uint32_t>> groups;
  for (std::uint32_t t = 0; t < surface.mesh.triangles.size(); ++t) {
    groups[surface.fragments.empty() ? 0 : surface.fragments[t]].push_back(t);
  }
  return {groups.begin(), groups.end()};
}

std::string mesh_file_extensions() {
  std::string all;
  for (const Format& format : kFormats) all.append(all.empty() ? "" : " ").append(format.extension);
  return all;
}

void add_mesh_file(const Surface& surface, const std::filesystem::path& path, FileSet& files) {
  const Format& format = format_of(path);
  check(surface);
  format.add(surface, path, files);
}

void write_mesh_file(const Surface& surface, const std::filesystem::path& path) {
  FileSet files;
  add_mesh_file(surface, path, files);
  files.commit();
}

}  // namespace crumble::render
