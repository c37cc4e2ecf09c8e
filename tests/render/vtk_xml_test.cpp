#include "render/vtk_xml.hpp"

#include <gtest/gtest.h>

#include <pugixml.hpp>

#include "crumble/base/file.hpp"
#include "crumble/base/memory.hpp"
#include "render/temporary_folder.hpp"
#include "support/mesh_files.hpp"

namespace crumble::render {
namespace {

// One to seven points: base64 pads bytes in groups of three, so every remainder occurs.
TEST(VtkXml, KeepsArraysOfAnyLength) {
  const TemporaryFolder folder;
  for (std::int32_t count = 1; count <= 7; ++count) {
    VtkGrid grid;
    grid.time = 0.1 * count;
    grid.cell = VtkCell::vertex;
    Vector<std::uint8_t> bytes;
    Vector<std::int32_t> ids;
    Vector<double> numbers;
    for (std::int32_t i = 0; i < count; ++i) {
      grid.points.push_back({1.0 / 3 * i, -1e-9, 1e300});
      grid.corners.push_back(count - 1 - i);
      bytes.push_back(static_cast<std::uint8_t>(255 - i));
      ids.push_back(-i);
      numbers.push_back(i / 7.0);
    }
    grid.point_data = {{"bytes", bytes}, {"vectors", grid.points}};
    grid.cell_data = {{"ids", ids}, {"numbers", numbers}};
    write_text(folder.file("a.vtu"), to_vtu(grid));
    const VtuFile back = read_vtu(folder.file("a.vtu"));
    EXPECT_EQ(back.time, grid.time);
    EXPECT_EQ(back.points, grid.points);
    EXPECT_EQ(back.cell_type, 1);
    for (std::int32_t i = 0; i < count; ++i) {
      EXPECT_EQ(back.cells.at(i), Vector<std::uint32_t>{static_cast<std::uint32_t>(count - 1 - i)});
      EXPECT_EQ(back.point_data.at("bytes").at(i), 255 - i);
      EXPECT_EQ(Vec3(&back.point_data.at("vectors").at(3 * i)), grid.points[i]);
      EXPECT_EQ(back.cell_data.at("ids").at(i), -i);
    }
    EXPECT_EQ(back.cell_data.at("numbers"), numbers);
  }
}

TEST(VtkXml, TellsCellsOfEachKindApart) {
  const TemporaryFolder folder;
  for (const auto& [cell, type, corners] :
       {std::tuple{VtkCell::vertex, 1, 1}, std::tuple{VtkCell::line, 3, 2}, std::tuple{VtkCell::triangle, 5, 3},
        std::tuple{VtkCell::tetrahedron, 10, 4}}) {
    VtkGrid grid;
    grid.cell = cell;
    grid.points.resize(12, Vec3::Zero());
    for (std::int32_t i = 0; i < 12; ++i) grid.corners.push_back(i);
    write_text(folder.file("a.vtu"), to_vtu(grid));
    const VtuFile back = read_vtu(folder.file("a.vtu"));
    EXPECT_EQ(back.cell_type, type);
    EXPECT_EQ(back.cells.size(), 12u / corners);
    EXPECT_EQ(back.cells.back().back(), 11u);
  }
}

TEST(VtkXml, ListsFramesByTime) {
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(to_pvd({{0.001, "a/a_0000.vtu"}, {0.1, "a/a & b.vtu"}}).c_str()));
  EXPECT_STREQ(document.child("VTKFile").attribute("type").value(), "Collection");
  Vector<std::string> rows;
  for (const auto& frame : document.child("VTKFile").child("Collection").children("DataSet")) {
    rows.push_back(std::string(frame.attribute("timestep").value()) + " " + frame.attribute("file").value());
  }
  EXPECT_EQ(rows, (Vector<std::string>{"0.001 a/a_0000.vtu", "0.1 a/a & b.vtu"}));
}

}  // namespace
}  // namespace crumble::render
