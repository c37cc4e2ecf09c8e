#include "render/vtk_xml.hpp"

#include <cstring>
#include <pugixml.hpp>
#include <span>
#include <sstream>

#include "crumble/base/bytes.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/text.hpp"
#include "render/mesh_formats.hpp"

namespace crumble::render {
namespace {

std::string to_base64(std::span<const std::uint8_t> bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text((bytes.size() + 2) / 3 * 4, '=');
  for (std::size_t i = 0, at = 0; i < bytes.size(); i += 3, at += 4) {
    const std::size_t left = std::min<std::size_t>(bytes.size() - i, 3);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < left ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k <= left; ++k) text[at + k] = kDigits[group >> (18 - 6 * k) & 63];
  }
  return text;
}

// What VTK calls the type of a C++ number.
template <class T>
constexpr const char* kTypeName = nullptr;
template <>
constexpr const char* kTypeName<std::uint8_t> = "UInt8";
template <>
constexpr const char* kTypeName<std::int32_t> = "Int32";
template <>
constexpr const char* kTypeName<double> = "Float64";

template <Plain T>
pugi::xml_node add_array(pugi::xml_node parent, const std::string& name, const Vector<T>& values) {
  pugi::xml_node array = parent.append_child("DataArray");
  array.append_attribute("type") = kTypeName<T>;
  array.append_attribute("Name") = name.c_str();
  array.append_attribute("format") = "binary";
  ByteWriter bytes;
  bytes.put(static_cast<std::uint64_t>(values.size() * sizeof(T)));
  bytes.put_raw(values.data(), values.size() * sizeof(T));
  array.text().set(to_base64(bytes.bytes()).c_str());
  return array;
}

void add_array(pugi::xml_node parent, const std::string& name, const Vector<Vec3>& values) {
  Vector<double> numbers;
  for (const Vec3& v : values) numbers.insert(numbers.end(), {v.x(), v.y(), v.z()});
  add_array(parent, name, numbers).append_attribute("NumberOfComponents") = "3";
}

void add_data(pugi::xml_node piece, const char* kind, const Vector<VtkArray>& arrays) {
  pugi::xml_node data = piece.append_child(kind);
  for (const VtkArray& array : arrays) {
    std::visit([&](const auto& values) { add_array(data, array.name, values); }, array.values);
  }
}

std::size_t corner_count(VtkCell cell) {
  switch (cell) {
    case VtkCell::vertex:
      return 1;
    case VtkCell::line:
      return 2;
    case VtkCell::triangle:
      return 3;
    case VtkCell::tetrahedron:
      return 4;
  }
  return 1;
}

void add_cells(pugi::xml_node piece, const VtkGrid& grid) {
  const std::size_t corners = corner_count(grid.cell), count = grid.corners.size() / corners;
  Vector<std::int32_t> ends;
  for (std::size_t i = 1; i <= count; ++i) ends.push_back(static_cast<std::int32_t>(i * corners));
  pugi::xml_node cells = piece.append_child("Cells");
  add_array(cells, "connectivity", grid.corners);
  add_array(cells, "offsets", ends);
  add_array(cells, "types", Vector<std::uint8_t>(count, static_cast<std::uint8_t>(grid.cell)));
  piece.append_attribute("NumberOfPoints") = std::to_string(grid.points.size()).c_str();
  piece.append_attribute("NumberOfCells") = std::to_string(count).c_str();
}

// The root element of a file of this kind.
pugi::xml_node add_root(pugi::xml_document& document, const char* kind) {
  pugi::xml_node root = document.append_child("VTKFile");
  root.append_attribute("type") = kind;
  root.append_attribute("version") = "1.0";
  root.append_attribute("byte_order") = "LittleEndian";
  root.append_attribute("header_type") = "UInt64";
  return root;
}

std::string to_text(const pugi::xml_document& document) {
  std::ostringstream out;
  document.save(out, " ");
  return out.str();
}

}  // namespace

std::string to_vtu(const VtkGrid& grid) {
  pugi::xml_document document;
  pugi::xml_node content = add_root(document, "UnstructuredGrid").append_child("UnstructuredGrid");
  add_array(content.append_child("FieldData"), "TimeValue", Vector<double>{grid.time})
      .append_attribute("NumberOfTuples") = "1";
  pugi::xml_node piece = content.append_child("Piece");
  add_array(piece.append_child("Points"), "Points", grid.points);
  add_cells(piece, grid);
  add_data(piece, "PointData", grid.point_data);
  add_data(piece, "CellData", grid.cell_data);
  return to_text(document);
}

std::string to_vtu(const Surface& surface) {
  const RenderMesh& mesh = surface.mesh;
  VtkGrid grid;
  grid.time = surface.time;
  grid.points = mesh.positions;
  grid.cell = VtkCell::triangle;
  grid.corners = to_corners(mesh.triangles);
  if (!mesh.rest_positions.empty()) grid.point_data.push_back({"rest", mesh.rest_positions});
  if (!surface.colours.empty()) grid.point_data.push_back({"colour", surface.colours});
  const auto add_ids = [&](const char* name, const Vector<std::uint32_t>& ids) {
    if (!ids.empty()) grid.cell_data.push_back({name, Vector<std::int32_t>(ids.begin(), ids.end())});
  };
  add_ids("fragment", surface.fragments);
  add_ids("tetrahedron", surface.tetrahedra);
  Vector<std::uint8_t> materials;
  for (const Material material : mesh.materials) materials.push_back(static_cast<std::uint8_t>(material));
  if (!materials.empty()) grid.cell_data.push_back({"material", materials});
  return to_vtu(grid);
}

std::string to_pvd(const Vector<std::pair<double, std::string>>& frames) {
  pugi::xml_document document;
  pugi::xml_node collection = add_root(document, "Collection").append_child("Collection");
  for (const auto& [time, file] : frames) {
    pugi::xml_node frame = collection.append_child("DataSet");
    frame.append_attribute("timestep") = crumble::to_text(time).c_str();
    frame.append_attribute("part") = "0";
    frame.append_attribute("file") = file.c_str();
  }
  return to_text(document);
}

}  // namespace crumble::render
