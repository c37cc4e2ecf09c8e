#include "crumble/fracture/masks.hpp"

namespace crumble {
namespace {

// Least corner of each corner's component over the intact springs among the corners of `corner_set` (bits).
constexpr std::array<std::uint8_t, 4> corner_components(unsigned mask, unsigned corner_set) {
  std::array<std::uint8_t, 4> component{0, 1, 2, 3};
  for (int pass = 0; pass < 3; ++pass) {  // the longest path has three springs
    for (std::size_t s = 0; s < kTetEdges.size(); ++s) {
      const auto [a, b] = kTetEdges[s];
      const bool inside = ((corner_set >> a) & (corner_set >> b) & 1u) != 0;
      if (!inside || ((mask >> s) & 1u) != 0) continue;
      const std::uint8_t least = component[a] < component[b] ? component[a] : component[b];
      component[a] = component[b] = least;
    }
  }
  return component;
}

// The mask after two neighbouring corners, `low` and low + 1, have changed places.
constexpr unsigned swap_corners(unsigned mask, unsigned low) {
  const auto renamed = [&](unsigned corner) { return corner == low ? low + 1 : corner == low + 1 ? low : corner; };
  unsigned image = 0;
  for (std::size_t from = 0; from < kTetEdges.size(); ++from) {
    const unsigned a = renamed(kTetEdges[from][0]), b = renamed(kTetEdges[from][1]);
    for (std::size_t to = 0; to < kTetEdges.size(); ++to) {
      const bool same =
          (kTetEdges[to][0] == a && kTetEdges[to][1] == b) || (kTetEdges[to][0] == b && kTetEdges[to][1] == a);
      if (same) image |= ((mask >> from) & 1u) << to;
    }
  }
  return image;
}

// Swaps of neighbours generate every relabelling: the least mask spreads along them until nothing changes.
constexpr void find_classes(std::array<CutMask, kCutMaskCount>& table) {
  for (unsigned mask = 0; mask < kCutMaskCount; ++mask) table[mask].least_mask = static_cast<std::uint8_t>(mask);
  for (bool changed = true; changed;) {
    changed = false;
    for (unsigned mask = 0; mask < kCutMaskCount; ++mask) {
      for (unsigned low = 0; low < 3; ++low) {
        const std::uint8_t least = table[swap_corners(mask, low)].least_mask;
        if (least >= table[mask].least_mask) continue;
        table[mask].least_mask = least;
        changed = true;
      }
    }
  }
}

constexpr std::array<CutMask, kCutMaskCount> make_cut_masks() {
  std::array<CutMask, kCutMaskCount> table{};
  find_classes(table);
  for (unsigned mask = 0; mask < kCutMaskCount; ++mask) {
    CutMask& entry = table[mask];
    entry.piece = corner_components(mask, 15u);
    for (std::uint8_t corner = 0; corner < 4; ++corner) {
      entry.piece_count = static_cast<std::uint8_t>(entry.piece_count + (entry.piece[corner] == corner));
      entry.face_component[corner] = corner_components(mask, 15u & ~(1u << corner));
    }
    entry.crossed_cracks = entry.least_mask == 12;
  }
  return table;
}

}  // namespace

// Constant-initialised, so the tables that other files build from it at start may read it.
constinit const std::array<CutMask, kCutMaskCount> kCutMasks = make_cut_masks();

}  // namespace crumble
