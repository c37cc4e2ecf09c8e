// Tools from files of other programs.
#pragma once

#include <filesystem>

#include "crumble/geometry/triangle_mesh.hpp"

namespace crumble {

/// The triangles of an STL, OBJ or PLY file, text or binary, every coordinate times `scale`; polygons become triangles,
/// and vertices of equal coordinates one, since STL has no others.
/// Throws Error, naming the file: io, unsupported (another extension), too_large (above 256 MB), format (not of its
/// kind), empty (no triangle), out_of_range and invalid_value (scale). Whether the surface is closed is asked by what
/// makes a solid of it.
TriangleMesh read_tool_mesh(const std::filesystem::path& file, double scale);

}  // namespace crumble
