#include "cli/ply.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "crumble/base/file.hpp"

namespace crumble::cli {
namespace {

template <class T>
T take(const std::string& bytes, std::size_t& at) {
  T value{};
  if (at + sizeof value <= bytes.size()) std::memcpy(&value, bytes.data() + at, sizeof value);
  at += sizeof value;
  return value;
}

}  // namespace

PlyFile read_ply(const std::filesystem::path& path) {
  const std::string bytes = read_text(path);
  PlyFile file;
  std::size_t at = bytes.find("end_header\n");
  EXPECT_NE(at, std::string::npos) << path;
  std::istringstream header(bytes.substr(0, at));
  at += std::strlen("end_header\n");
  std::size_t properties = 0;
  for (std::string line; std::getline(header, line);) {
    std::sscanf(line.c_str(), "element vertex %zu", &file.vertices);
    std::sscanf(line.c_str(), "element face %zu", &file.triangles);
    properties += line.rfind("property float", 0) == 0;
  }
  EXPECT_EQ(properties, 3u) << "positions only";
  EXPECT_EQ(bytes.size(), at + file.vertices * 12 + file.triangles * 13) << path;

  std::vector<std::array<double, 3>> points(file.vertices);
  for (auto& point : points) {
    for (double& x : point)
      x = take<float>(bytes, at), file.greatest_coordinate = std::max(file.greatest_coordinate, std::abs(x));
  }
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (std::size_t t = 0; t < file.triangles; ++t) {
    EXPECT_EQ(take<std::uint8_t>(bytes, at), 3);
    std::array<std::uint32_t, 3> v{};
    for (std::uint32_t& each : v) each = take<std::uint32_t>(bytes, at) % static_cast<std::uint32_t>(file.vertices);
    for (int k = 0; k < 3; ++k) ++edges[{v[k], v[(k + 1) % 3]}];
    const auto &a = points[v[0]], &b = points[v[1]], &c = points[v[2]];
    file.volume +=
        (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])) /
        6;
  }
  for (const auto& [edge, count] : edges) {
    const auto back = edges.find({edge.second, edge.first});
    file.unmatched_edges += back == edges.end() || back->second != count;
  }
  return file;
}

}  // namespace crumble::cli
