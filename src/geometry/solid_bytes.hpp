// Parts of solids as bytes.
#pragma once

#include "crumble/base/bytes.hpp"
#include "crumble/geometry/triangle_mesh.hpp"

namespace crumble {

inline void put_vector(ByteWriter& out, const Vec3& v) {
  out.put(v.x()), out.put(v.y()), out.put(v.z());
}

inline Vec3 get_vector(ByteReader& in) {
  const auto x = in.get<double>(), y = in.get<double>(), z = in.get<double>();
  return {x, y, z};
}

inline void put_mesh(ByteWriter& out, const TriangleMesh& mesh) {
  out.put(static_cast<std::uint64_t>(mesh.vertices.size()));
  for (const Vec3& v : mesh.vertices) put_vector(out, v);
  out.put(static_cast<std::uint64_t>(mesh.triangles.size()));
  for (const Triangle& t : mesh.triangles) out.put(t[0]), out.put(t[1]), out.put(t[2]);
}

inline TriangleMesh get_mesh(ByteReader& in) {
  const auto count = [&](std::size_t bytes_each) {
    const auto n = in.get<std::uint64_t>();
    if (n > in.left() / bytes_each) throw Error(Code::corrupt, "recording is truncated in a tool's mesh");
    return static_cast<std::size_t>(n);
  };
  TriangleMesh mesh;
  mesh.vertices.resize(count(3 * sizeof(double)));
  for (Vec3& v : mesh.vertices) v = get_vector(in);
  mesh.triangles.resize(count(3 * sizeof(std::uint32_t)));
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t) v = in.get<std::uint32_t>();
  }
  return mesh;
}

}  // namespace crumble
