// Binary glTF 2.0 of one surface.
#pragma once

#include <string>

#include "render/mesh_file.hpp"

namespace crumble::render {

/// The bytes of a .glb file; `mesh` and `attributes` are checked by the caller.
std::string to_glb(const TriangleMesh& mesh, const SurfaceAttributes& attributes);

}  // namespace crumble::render
