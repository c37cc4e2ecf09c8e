// Reads our .ply and .vtu files back by what their headers say.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "crumble/base/memory.hpp"
#include "crumble/geometry/triangle_mesh.hpp"

namespace crumble {

using Columns = std::map<std::string, Vector<double>>;

struct PlyFile {
  TriangleMesh mesh;
  Columns vertex, face;  // the scalar properties
};
/// Binary, little-endian, triangles. Fails the running test when the file is not what it says.
PlyFile read_ply(const std::filesystem::path& path);

struct VtuFile {
  double time = 0;
  Vector<Vec3> points;
  int cell_type = 0;  // of all cells
  Vector<Vector<std::uint32_t>> cells;
  Columns point_data, cell_data;  // three numbers per point for vectors

  /// Of a file of triangles.
  TriangleMesh mesh() const;
};
VtuFile read_vtu(const std::filesystem::path& path);

/// The triangles whose id is `id`, with the vertices that they use.
TriangleMesh select(const TriangleMesh& mesh, const Vector<double>& ids, double id);

/// Vertices of equal position become one: for formats whose triangles share none.
TriangleMesh weld(const TriangleMesh& mesh);

}  // namespace crumble
