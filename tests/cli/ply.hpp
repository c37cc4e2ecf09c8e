// Reads our binary .ply surfaces back, just enough to see that they are closed.
#pragma once

#include <cstdint>
#include <filesystem>

namespace crumble::cli {

struct PlyFile {
  std::size_t vertices = 0, triangles = 0;
  std::size_t unmatched_edges = 0;  // directed edges that are not used exactly as often in the other direction
  double volume = 0;                // m^3
  double greatest_coordinate = 0;   // by magnitude
};

/// Fails the running test when the file is not what it says.
PlyFile read_ply(const std::filesystem::path& path);

}  // namespace crumble::cli
