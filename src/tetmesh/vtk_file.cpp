#include "crumble/tetmesh/vtk_file.hpp"

#include "crumble/base/file.hpp"
#include "crumble/base/text.hpp"

namespace crumble {

void write_vtk(const TetMesh& mesh, const std::filesystem::path& path) {
  const auto number = [](auto n) { return std::to_string(n); };
  std::string text = "# vtk DataFile Version 3.0\ncrumble tetrahedral mesh, metres\nASCII\nDATASET UNSTRUCTURED_GRID\n";
  text += "POINTS " + number(mesh.node_count()) + " double\n";
  for (const Vec3& p : mesh.positions) text += to_text(p.x()) + ' ' + to_text(p.y()) + ' ' + to_text(p.z()) + '\n';
  text += "CELLS " + number(mesh.tetrahedra.size()) + ' ' + number(5 * mesh.tetrahedra.size()) + '\n';
  for (const auto& [a, b, c, d] : mesh.tetrahedra) {
    text += "4 " + number(a) + ' ' + number(b) + ' ' + number(c) + ' ' + number(d) + '\n';
  }
  text += "CELL_TYPES " + number(mesh.tetrahedra.size()) + '\n';
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) text += "10\n";  // VTK_TETRA
  text += "POINT_DATA " + number(mesh.node_count()) + "\nSCALARS kind int 1\nLOOKUP_TABLE default\n";
  for (const NodeKind kind : mesh.kinds) text += number(static_cast<int>(kind)) + '\n';
  write_text(path, text);
}

}  // namespace crumble
