// ply, obj and stl are a header and rows of numbers, written here. assimp 5.2's exporter was tried and is no help: its
// obj and glb join vertices that are in the same place, which welds every closed crack shut, and its binary ply
// declares colours as bytes but writes them as floats. The tests read every format back with assimp's importer.
#include "render/mesh_file.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "crumble/base/bytes.hpp"
#include "crumble/base/error.hpp"
#include "crumble/base/file.hpp"
#include "crumble/base/text.hpp"
#include "render/glb.hpp"

namespace crumble::render {
namespace {

void check_vectors(const std::string& field, const std::vector<Vec3>& values, std::size_t count) {
  if (values.size() != count) {
    throw Error(Code::mesh,
                field + " must have " + std::to_string(count) + " entries, has " + std::to_string(values.size()));
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!is_finite(values[i])) throw Error(Code::invalid_value, field + "[" + std::to_string(i) + "] must be finite");
  }
}

void check(const TriangleMesh& mesh, const SurfaceAttributes& attributes) {
  if (mesh.triangles.empty()) throw Error(Code::empty, "triangles must have at least one entry, have 0");
  check_vectors("vertices", mesh.vertices, mesh.vertices.size());
  if (!attributes.normals.empty()) check_vectors("normals", attributes.normals, mesh.vertices.size());
  if (!attributes.colours.empty()) check_vectors("colours", attributes.colours, mesh.vertices.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) {
      if (v >= mesh.vertices.size()) {
        throw Error(Code::mesh, "triangles[" + std::to_string(t) + "] names vertex " + std::to_string(v) + " of " +
                                    std::to_string(mesh.vertices.size()));
      }
    }
  }
}

std::string to_obj(const TriangleMesh& mesh, const SurfaceAttributes& attributes) {
  std::string out = "# metres\n";
  const auto add = [&](const Vec3& v) {
    for (int i = 0; i < 3; ++i) out.append(" ").append(to_text(v[i]));
  };
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    out += 'v';
    add(mesh.vertices[i]);
    if (!attributes.colours.empty()) add(attributes.colours[i]);
    out += '\n';
  }
  for (const Vec3& normal : attributes.normals) out += "vn", add(normal), out += '\n';
  for (const Triangle& triangle : mesh.triangles) {
    out += 'f';
    for (const std::uint32_t v : triangle) {
      const std::string number = std::to_string(v + 1);
      out += ' ';
      out += number;
      if (!attributes.normals.empty()) out.append("//").append(number);
    }
    out += '\n';
  }
  return out;
}

void put_vector(ByteWriter& out, const Vec3& v) {
  for (int i = 0; i < 3; ++i) out.put(static_cast<float>(v[i]));
}

std::string as_text(ByteWriter& out) {
  return {reinterpret_cast<const char*>(out.bytes().data()), out.bytes().size()};
}

std::string to_ply(const TriangleMesh& mesh, const SurfaceAttributes& attributes) {
  const bool has_normals = !attributes.normals.empty(), has_colours = !attributes.colours.empty();
  std::string header = "ply\nformat binary_little_endian 1.0\ncomment metres\nelement vertex ";
  header += std::to_string(mesh.vertices.size()) + "\nproperty float x\nproperty float y\nproperty float z\n";
  if (has_normals) header += "property float nx\nproperty float ny\nproperty float nz\n";
  if (has_colours) header += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  header += "element face " + std::to_string(mesh.triangles.size());
  header += "\nproperty list uchar int vertex_indices\nend_header\n";
  ByteWriter out;
  out.put_raw(header.data(), header.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    put_vector(out, mesh.vertices[i]);
    if (has_normals) put_vector(out, attributes.normals[i]);
    for (int k = 0; has_colours && k < 3; ++k) {
      out.put(static_cast<std::uint8_t>(std::lround(255 * std::clamp(attributes.colours[i][k], 0.0, 1.0))));
    }
  }
  for (const Triangle& triangle : mesh.triangles) {
    out.put(std::uint8_t{3});
    for (const std::uint32_t v : triangle) out.put(v);
  }
  return as_text(out);
}

// Every triangle with its own three corners and the normal of its plane; the format has room for no more.
std::string to_stl(const TriangleMesh& mesh, const SurfaceAttributes&) {
  ByteWriter out;
  const std::array<char, 80> header = {"crumble surface, metres"};
  out.put_raw(header.data(), header.size());
  out.put(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 across = cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]);
    const double length = norm(across);
    put_vector(out, length > 0 ? Vec3(across / length) : Vec3::Zero());
    for (const std::uint32_t v : {a, b, c}) put_vector(out, mesh.vertices[v]);
    out.put(std::uint16_t{0});
  }
  return as_text(out);
}

struct Format {
  const char* extension;
  std::string (*encode)(const TriangleMesh&, const SurfaceAttributes&);
};
constexpr std::array<Format, 4> kFormats{{{".glb", to_glb}, {".obj", to_obj}, {".ply", to_ply}, {".stl", to_stl}}};

const Format& format_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (const Format& format : kFormats) {
    if (extension == format.extension) return format;
  }
  throw Error(Code::unsupported, "mesh file '" + path.string() + "' must end in one of " + mesh_file_extensions());
}

}  // namespace

std::string mesh_file_extensions() {
  std::string all;
  for (const Format& format : kFormats) all.append(all.empty() ? "" : " ").append(format.extension);
  return all;
}

void write_mesh_file(const TriangleMesh& mesh, const SurfaceAttributes& attributes, const std::filesystem::path& path) {
  const Format& format = format_of(path);
  check(mesh, attributes);
  write_text(path, format.encode(mesh, attributes));
}

}  // namespace crumble::render
