// Triangle surfaces as files for other programs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "crumble/geometry/triangle_mesh.hpp"

namespace crumble::render {

/// What a surface file holds beside the triangles; an empty array is left out.
struct SurfaceAttributes {
  std::vector<Vec3> normals;  // unit, one per vertex
  std::vector<Vec3> colours;  // red, green, blue in [0, 1], one per vertex
};

/// Writes positions in metres as .ply (binary), .obj, .stl (binary) or .glb by the file's extension. Vertices keep
/// their number and order in ply, obj and glb, also where two of them are in the same place (the two lips of a crack
/// that has not opened), so a closed surface stays closed; stl has no shared vertices at all. stl drops colours.
/// Numbers are float32, in obj as exact as they are. The file appears whole or not at all. Throws Error: unsupported
/// (the extension, with the list), empty (no triangle), mesh (an index or array length), invalid_value (not finite),
/// io.
void write_mesh_file(const TriangleMesh& mesh, const SurfaceAttributes& attributes, const std::filesystem::path& path);

/// The extensions as the messages name them: ".glb .obj .ply .stl".
std::string mesh_file_extensions();

}  // namespace crumble::render
