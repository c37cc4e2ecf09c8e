// A tetrahedral mesh as a legacy VTK file (ASCII, unstructured grid): ParaView, VisIt and meshio read it.
// Written by hand, 30 lines, since Debian's VTK would bring 200 packages for it.
#pragma once

#include <filesystem>

#include "crumble/tetmesh/tet_mesh.hpp"

namespace crumble {

/// Metres; node kinds as point data. Replaces the file only when all of it is written. Throws Error(io).
void write_vtk(const TetMesh& mesh, const std::filesystem::path& path);

}  // namespace crumble
