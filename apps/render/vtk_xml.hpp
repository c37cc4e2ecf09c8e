// VTK's XML files: unstructured grids (.vtu) and series of them (.pvd), as ParaView, VisIt, PyVista and meshio read
// them. VTK itself could write them but is 200 packages; pugixml writes the XML, and the arrays are VTK's "binary":
// base64 of a UInt64 byte count and then of the numbers, little-endian, not compressed.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>

#include "crumble/base/memory.hpp"
#include "crumble/base/vec.hpp"

namespace crumble::render {

/// One value per point or per cell.
struct VtkArray {
  std::string name;
  std::variant<Vector<std::uint8_t>, Vector<std::int32_t>, Vector<double>, Vector<Vec3>> values;
};

enum class VtkCell : std::uint8_t { vertex = 1, line = 3, triangle = 5, tetrahedron = 10 };

/// Cells of one kind.
struct VtkGrid {
  double time = 0;  // seconds
  Vector<Vec3> points;
  VtkCell cell = VtkCell::triangle;
  Vector<std::int32_t> corners;  // point indices, cell by cell
  Vector<VtkArray> point_data, cell_data;
};

std::string to_vtu(const VtkGrid& grid);

/// The point indices of cells that are arrays of indices.
template <class Cells>
Vector<std::int32_t> to_corners(const Cells& cells) {
  Vector<std::int32_t> corners;
  for (const auto& cell : cells) {
    for (const std::uint32_t point : cell) corners.push_back(static_cast<std::int32_t>(point));
  }
  return corners;
}

/// `frames`: time in seconds and file name relative to the .pvd.
std::string to_pvd(const Vector<std::pair<double, std::string>>& frames);

}  // namespace crumble::render
