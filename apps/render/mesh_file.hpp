// Triangle surfaces as files for other programs.
#pragma once

#include <filesystem>
#include <string>

#include "crumble/base/memory.hpp"
#include "render/scene.hpp"

namespace crumble::render {

class FileSet;

/// A surface and what is known about it. What is empty is left out of the file, but for positions and triangles.
struct Surface {
  RenderMesh mesh;                   // rest positions per vertex; corner normals and materials per triangle
  Vector<Vec3> colours;              // red, green, blue in [0, 1], one per vertex
  Vector<std::uint32_t> fragments;   // one per triangle
  Vector<std::uint32_t> tetrahedra;  // that it was cut from, one per triangle
  double time = 0;                   // simulated seconds
};

/// Writes positions in metres as .ply (binary), .obj, .stl (binary), .glb or .vtu by the file's extension; an .obj gets
/// its materials in an .mtl beside it. docs/export.md tells what each format holds. Vertices are shared as they are
/// here, also where two of them are in the same place (the two lips of a crack that has not opened), so a closed
/// surface stays closed; glb has a vertex twice where its normals differ, and stl has no shared vertices at all.
/// Numbers are float32; in obj and vtu positions are as exact as they are. All files appear whole or not at all.
/// Throws Error: unsupported (the extension, with the list), empty (no triangle), mesh (an index, an array length or a
/// material other than skin and interior), invalid_value (not finite), io.
void write_mesh_file(const Surface& surface, const std::filesystem::path& path);
/// The same as part of `files`; there when these are committed.
void add_mesh_file(const Surface& surface, const std::filesystem::path& path, FileSet& files);

/// The extensions as the messages name them: ".glb .obj .ply .stl .vtu".
std::string mesh_file_extensions();

}  // namespace crumble::render
