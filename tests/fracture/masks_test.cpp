#include "crumble/fracture/masks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <map>
#include <set>

namespace crumble {
namespace {

// Known counts of the graphs on four labelled vertices, by class: masks, pieces (compare docs/fracture.md).
TEST(Masks, ElevenClassesOfTheKnownSizes) {
  struct Row {
    int masks, pieces;
    bool operator==(const Row&) const = default;
  };
  const std::map<int, Row> expected{{0, {1, 1}},   {1, {6, 1}},   {3, {12, 1}}, {12, {3, 1}}, {7, {4, 2}}, {11, {4, 1}},
                                    {13, {12, 1}}, {15, {12, 2}}, {30, {3, 2}}, {31, {6, 3}}, {63, {1, 4}}};
  std::map<int, Row> found;
  for (unsigned mask = 0; mask < kCutMaskCount; ++mask) {
    Row& row = found[kCutMasks[mask].least_mask];
    EXPECT_TRUE(row.masks++ == 0 || row.pieces == kCutMasks[mask].piece_count) << mask;
    row.pieces = kCutMasks[mask].piece_count;
    EXPECT_EQ(std::popcount(mask), std::popcount(unsigned{kCutMasks[mask].least_mask}));
    EXPECT_LE(kCutMasks[mask].least_mask, mask);
  }
  EXPECT_TRUE(found == expected);
  for (const auto& [least, row] : found) EXPECT_EQ(std::count(kCutClasses.begin(), kCutClasses.end(), least), 1);
  EXPECT_EQ(found.size(), kCutClasses.size());
}

// Reachability by repeated squaring of the adjacency matrix: another way to the same components.
std::array<std::uint8_t, 4> least_reachable(unsigned mask, std::size_t left_out) {
  bool reach[4][4] = {};
  for (std::size_t i = 0; i < 4; ++i) reach[i][i] = true;
  for (std::size_t s = 0; s < 6; ++s) {
    const auto [a, b] = kTetEdges[s];
    if ((mask >> s & 1u) == 0 && a != left_out && b != left_out) reach[a][b] = reach[b][a] = true;
  }
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < 4; ++j) reach[i][j] = reach[i][j] || (reach[i][k] && reach[k][j]);
    }
  }
  std::array<std::uint8_t, 4> least{};
  for (std::size_t i = 0; i < 4; ++i) {
    while (!reach[i][least[i]]) ++least[i];
  }
  return least;
}

TEST(Masks, PiecesAndFaceComponents) {
  for (unsigned mask = 0; mask < kCutMaskCount; ++mask) {
    EXPECT_EQ(kCutMasks[mask].piece, least_reachable(mask, 4)) << mask;
    const std::set<int> names(kCutMasks[mask].piece.begin(), kCutMasks[mask].piece.end());
    EXPECT_EQ(names.size(), kCutMasks[mask].piece_count);
    for (std::size_t face = 0; face < 4; ++face) {
      EXPECT_EQ(kCutMasks[mask].face_component[face], least_reachable(mask, face)) << mask << " face " << face;
    }
  }
}

TEST(Masks, CracksCrossInThreeMasks) {
  std::set<unsigned> crossed;
  for (unsigned mask = 0; mask < kCutMaskCount; ++mask) {
    if (kCutMasks[mask].crossed_cracks) crossed.insert(mask);
  }
  EXPECT_EQ(crossed, (std::set<unsigned>{0b100001, 0b010010, 0b001100}));  // 01+23, 02+13, 03+12
}

TEST(Masks, MaskFollowsTheSpringOrder) {
  const std::array<std::uint32_t, 6> springs{7, 3, 0, 5, 1, 6};
  std::array<std::uint8_t, 8> intact;
  intact.fill(1);
  EXPECT_EQ(cut_mask(springs, intact), 0);
  intact[0] = intact[6] = 0;
  EXPECT_EQ(cut_mask(springs, intact), 0b100100);
}

}  // namespace
}  // namespace crumble
