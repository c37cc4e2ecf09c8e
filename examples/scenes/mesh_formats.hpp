// STL, OBJ and PLY, as far as the triangles go. Written here since assimp 5.2, Debian's, aborts the program or reads
// for ever where a PLY file ends too early.
#pragma once

#include <string_view>

#include "crumble/geometry/triangle_mesh.hpp"

namespace crumble {

/// The whole of a file as its vertices and triangles, polygons fanned out from their first corner; nothing is joined.
/// All throw Error(format) with what is wrong and, in text, the line (from 1).
TriangleMesh parse_stl(std::string_view bytes);
TriangleMesh parse_obj(std::string_view bytes);
TriangleMesh parse_ply(std::string_view bytes);

}  // namespace crumble
