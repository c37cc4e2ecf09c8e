#include "support/mesh_files.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <pugixml.hpp>
#include <sstream>

#include "crumble/base/file.hpp"
#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

template <class T>
double take(const std::string& bytes, std::size_t& at) {
  T value{};
  if (at + sizeof value <= bytes.size()) std::memcpy(&value, bytes.data() + at, sizeof value);
  at += sizeof value;
  return static_cast<double>(value);
}

double take(const std::string& type, const std::string& bytes, std::size_t& at) {
  if (type == "uchar" || type == "UInt8") return take<std::uint8_t>(bytes, at);
  if (type == "int" || type == "Int32") return take<std::int32_t>(bytes, at);
  if (type == "float") return take<float>(bytes, at);
  if (type == "UInt64") return take<std::uint64_t>(bytes, at);
  EXPECT_EQ(type, "Float64");
  return take<double>(bytes, at);
}

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  Vector<Vector<std::string>> properties;  // words
};

Vector<PlyElement> read_header(const std::string& bytes, std::size_t& at) {
  at = bytes.find("end_header\n");
  EXPECT_NE(at, std::string::npos);
  std::istringstream lines(bytes.substr(0, at));
  at += std::strlen("end_header\n");
  Vector<PlyElement> elements;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream in(line);
    Vector<std::string> words;
    for (std::string word; in >> word;) words.push_back(word);
    if (words[0] == "element") elements.push_back({words[1], std::stoul(words[2]), {}});
    if (words[0] == "property") elements.back().properties.emplace_back(words.begin() + 1, words.end());
  }
  return elements;
}

std::string from_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t held = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    const std::size_t digit = digits.find(c);
    EXPECT_NE(digit, std::string::npos);
    held = held << 6 | static_cast<std::uint32_t>(digit);
    bits += 6;
    if (bits >= 8) bits -= 8, bytes += static_cast<char>(held >> bits & 255);
  }
  return bytes;
}

Vector<double> read_array(const pugi::xml_node& array) {
  EXPECT_STREQ(array.attribute("format").value(), "binary");
  const std::string text = array.text().get(), bytes = from_base64(text);
  EXPECT_EQ(text.size() % 4, 0u);
  std::size_t at = 0;
  EXPECT_EQ(take("UInt64", bytes, at) + 8, static_cast<double>(bytes.size())) << array.attribute("Name").value();
  Vector<double> values;
  while (at < bytes.size()) values.push_back(take(array.attribute("type").value(), bytes, at));
  EXPECT_EQ(at, bytes.size());
  return values;
}

Columns read_arrays(const pugi::xml_node& parent, std::size_t count) {
  Columns columns;
  for (const pugi::xml_node& array : parent.children("DataArray")) {
    const std::string name = array.attribute("Name").value();
    columns[name] = read_array(array);
    EXPECT_EQ(columns[name].size(), count * array.attribute("NumberOfComponents").as_uint(1)) << name;
  }
  return columns;
}

}  // namespace

PlyFile read_ply(const std::filesystem::path& path) {
  const std::string bytes = read_text(path);
  PlyFile file;
  std::size_t at = 0;
  for (const PlyElement& element : read_header(bytes, at)) {
    Columns& columns = element.name == "vertex" ? file.vertex : file.face;
    for (std::size_t i = 0; i < element.count; ++i) {
      for (const Vector<std::string>& property : element.properties) {
        if (property[0] != "list") {
          columns[property[1]].push_back(take(property[0], bytes, at));
          continue;
        }
        EXPECT_EQ(take(property[1], bytes, at), 3);
        Triangle& triangle = file.mesh.triangles.emplace_back();
        for (std::uint32_t& v : triangle) v = static_cast<std::uint32_t>(take(property[2], bytes, at));
      }
    }
  }
  EXPECT_EQ(at, bytes.size()) << path;
  for (std::size_t i = 0; i < file.vertex["x"].size(); ++i) {
    file.mesh.vertices.push_back({file.vertex["x"][i], file.vertex["y"][i], file.vertex["z"][i]});
  }
  return file;
}

VtuFile read_vtu(const std::filesystem::path& path) {
  pugi::xml_document document;
  EXPECT_TRUE(document.load_file(path.c_str())) << path;
  const pugi::xml_node root = document.child("VTKFile"), grid = root.child("UnstructuredGrid");
  EXPECT_STREQ(root.attribute("byte_order").value(), "LittleEndian");
  EXPECT_STREQ(root.attribute("header_type").value(), "UInt64");
  const pugi::xml_node piece = grid.child("Piece");
  const std::size_t points = piece.attribute("NumberOfPoints").as_uint();
  const std::size_t cells = piece.attribute("NumberOfCells").as_uint();
  VtuFile file;
  file.time = read_array(grid.child("FieldData").child("DataArray")).at(0);
  const Vector<double> numbers = read_arrays(piece.child("Points"), points).at("Points");
  for (std::size_t i = 0; i < points; ++i) file.points.emplace_back(&numbers[3 * i]);
  Vector<double> corners;
  for (const pugi::xml_node& array : piece.child("Cells").children()) {
    const std::string name = array.attribute("Name").value();
    const Vector<double> values = read_array(array);
    if (name == "connectivity") corners = values;
    if (name == "types") file.cell_type = static_cast<int>(values.at(0));
    if (name != "offsets") continue;
    EXPECT_EQ(values.size(), cells);
    double begin = 0;
    for (const double end : values) {
      auto& cell = file.cells.emplace_back();
      for (; begin < end; ++begin) cell.push_back(static_cast<std::uint32_t>(corners.at(std::size_t(begin))));
    }
  }
  file.point_data = read_arrays(piece.child("PointData"), points);
  file.cell_data = read_arrays(piece.child("CellData"), cells);
  return file;
}

TriangleMesh VtuFile::mesh() const {
  EXPECT_EQ(cell_type, 5);
  TriangleMesh mesh;
  mesh.vertices = points;
  for (const auto& cell : cells) mesh.triangles.push_back({cell.at(0), cell.at(1), cell.at(2)});
  return mesh;
}

TriangleMesh select(const TriangleMesh& mesh, const Vector<double>& ids, double id) {
  TriangleMesh out;
  std::map<std::uint32_t, std::uint32_t> numbers;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (ids.at(t) != id) continue;
    Triangle& triangle = out.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.triangles[t][k];
      const auto [at, is_new] = numbers.emplace(v, static_cast<std::uint32_t>(numbers.size()));
      if (is_new) out.vertices.push_back(mesh.vertices.at(v));
      triangle[k] = at->second;
    }
  }
  return out;
}

TriangleMesh weld(const TriangleMesh& mesh) {
  std::map<std::array<double, 3>, std::uint32_t> ids;
  TriangleMesh out;
  Vector<std::uint32_t> id_of;
  for (const Vec3& p : mesh.vertices) {
    const auto [at, is_new] = ids.emplace(std::array{p.x(), p.y(), p.z()}, static_cast<std::uint32_t>(ids.size()));
    if (is_new) out.vertices.push_back(p);
    id_of.push_back(at->second);
  }
  for (const auto& [a, b, c] : mesh.triangles) out.triangles.push_back({id_of[a], id_of[b], id_of[c]});
  return out;
}

}  // namespace crumble
