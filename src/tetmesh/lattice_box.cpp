#include "crumble/tetmesh/lattice_box.hpp"

#include <cmath>
#include <string>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/text.hpp"

namespace crumble {

TetMesh make_lattice_box(const Vec3& size, double spacing) {
  require_positive("spacing", spacing);
  std::array<std::uint32_t, 3> cells{};
  double nodes = 1;
  for (int axis = 0; axis < 3; ++axis) {
    require_positive("size", size[axis]);
    const double count = std::max(1.0, std::floor(size[axis] / spacing + 0.5));
    nodes *= count + 1;
    if (nodes > 1e7)
      throw Error(Code::too_large, "spacing " + to_text(spacing) + " m makes more than 10 million nodes");
    cells[axis] = static_cast<std::uint32_t>(count);
  }

  Vector<Vec3> positions;
  for (std::uint32_t z = 0; z <= cells[2]; ++z) {
    for (std::uint32_t y = 0; y <= cells[1]; ++y) {
      for (std::uint32_t x = 0; x <= cells[0]; ++x) {
        positions.emplace_back(size.x() * (static_cast<double>(x) / cells[0] - 0.5), size.y() * y / cells[1],
                               size.z() * (static_cast<double>(z) / cells[2] - 0.5));
      }
    }
  }

  // Six tetrahedra round the diagonal 0-7 of each cube (Kuhn); neighbouring cubes meet in the same face diagonals.
  constexpr std::array<std::array<int, 4>, 6> kSix{
      {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}}};
  const auto node = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    return x + (cells[0] + 1) * (y + (cells[1] + 1) * z);
  };
  Vector<Tetrahedron> tetrahedra;
  for (std::uint32_t z = 0; z < cells[2]; ++z) {
    for (std::uint32_t y = 0; y < cells[1]; ++y) {
      for (std::uint32_t x = 0; x < cells[0]; ++x) {
        for (const auto& corners : kSix) {
          Tetrahedron t{};
          for (int k = 0; k < 4; ++k) {
            t[k] = node(x + (corners[k] & 1), y + (corners[k] >> 1 & 1), z + (corners[k] >> 2 & 1));
          }
          tetrahedra.push_back(t);
        }
      }
    }
  }
  return make_tet_mesh(std::move(positions), std::move(tetrahedra));
}

}  // namespace crumble
