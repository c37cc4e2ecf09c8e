#include "surface_patterns.hpp"

namespace crumble::surface_patterns {
namespace {

using Corner = std::uint8_t;

std::size_t spring_between(Corner a, Corner b) {
  std::size_t spring = 0;
  while (!(kTetEdges[spring][0] == a && kTetEdges[spring][1] == b) &&
         !(kTetEdges[spring][0] == b && kTetEdges[spring][1] == a)) {
    ++spring;
  }
  return spring;
}

VertexCode make_code(std::size_t site, std::size_t copy) {
  return static_cast<VertexCode>(site * 4 + copy);
}

VertexCode middle(std::size_t spring, Corner side) {
  return make_code(kMiddles + spring, side == kTetEdges[spring][0] ? 0 : 1);
}

VertexCode face_center(const CutMask& mask, std::size_t face, Corner side) {
  const Corner least = mask.face_component[face][side];
  return make_code(kFaceCenters + face, least > face ? least - 1u : least);  // rank among the face's corners
}

VertexCode center(const CutMask& mask, std::size_t spring, Corner side) {
  if (mask.crossed_cracks) return make_code(kCenter, spring < 3 ? 0 : 1);  // springs 0, 1, 2 meet corner 0
  return make_code(kCenter, mask.piece[side]);
}

// The other two corners of spring (a, b), such that (a, b, first, second) has positive volume when (0, 1, 2, 3) has.
std::array<Corner, 2> opposite_corners(std::size_t spring) {
  constexpr std::array<std::array<Corner, 2>, 6> kOpposite{{{2, 3}, {3, 1}, {1, 2}, {0, 3}, {2, 0}, {0, 1}}};
  return kOpposite[spring];
}

void add_carrier(MaskPatterns& patterns, VertexCode code, Corner corner) {
  patterns.carriers[code] = static_cast<std::uint8_t>(patterns.carriers[code] | 1u << corner);
}

void fill_carriers(const CutMask& mask, MaskPatterns& patterns) {
  for (Corner corner = 0; corner < 4; ++corner) {
    add_carrier(patterns, make_code(kCorners + corner, 0), corner);
    for (std::size_t face = 0; face < 4; ++face) {
      if (face != corner) add_carrier(patterns, face_center(mask, face, corner), corner);
    }
    for (std::size_t spring = 0; spring < 6; ++spring) {
      const auto [a, b] = kTetEdges[spring];
      if (a == corner || b == corner) add_carrier(patterns, middle(spring, corner), corner);
      add_carrier(patterns, center(mask, spring, corner), corner);
    }
  }
}

// The facet between the dual cells of a spring's two ends, once for each side.
void open_spring(const CutMask& mask, std::size_t spring, MaskPatterns& patterns) {
  const auto [first, second] = opposite_corners(spring);
  const auto [a, b] = kTetEdges[spring];
  for (const Corner side : {a, b}) {
    const VertexCode mid = middle(spring, side), in = center(mask, spring, side);
    // The facet lies in the faces (a, b, first) and (a, b, second), which are opposite `second` and `first`.
    VertexCode left = face_center(mask, second, side), right = face_center(mask, first, side);
    if (side == b) std::swap(left, right);
    patterns.interior[patterns.interior_count++] = {{mid, left, in}, side, right};
    patterns.interior[patterns.interior_count++] = {{in, right, mid}, side, left};
  }
}

// An outer face: itself while whole, else a fan about its centre that opens at the cut springs.
void fill_skin(unsigned bits, const CutMask& mask, std::size_t face, MaskPatterns& patterns) {
  const auto add = [&](VertexCode a, VertexCode b, VertexCode c, Corner owner) {
    patterns.skin[face][patterns.skin_count[face]++] = {{a, b, c}, owner, a};
  };
  const auto corner_code = [](Corner corner) { return make_code(kCorners + corner, 0); };
  const auto& corners = kTetFaces[face];
  unsigned cut = 0;
  for (std::size_t k = 0; k < 3; ++k) cut |= bits >> spring_between(corners[k], corners[(k + 1) % 3]) & 1u;
  if (cut == 0) return add(corner_code(corners[0]), corner_code(corners[1]), corner_code(corners[2]), corners[0]);
  for (std::size_t k = 0; k < 3; ++k) {
    const Corner a = corners[k], b = corners[(k + 1) % 3];
    const std::size_t spring = spring_between(a, b);
    if ((bits >> spring & 1u) == 0) {
      add(corner_code(a), corner_code(b), face_center(mask, face, a), a);
    } else {
      add(corner_code(a), middle(spring, a), face_center(mask, face, a), a);
      add(middle(spring, b), corner_code(b), face_center(mask, face, b), b);
    }
  }
}

std::array<MaskPatterns, kCutMaskCount> make_patterns() {
  std::array<MaskPatterns, kCutMaskCount> table{};
  for (unsigned bits = 0; bits < kCutMaskCount; ++bits) {
    const CutMask& mask = kCutMasks[bits];
    MaskPatterns& patterns = table[bits];
    fill_carriers(mask, patterns);
    for (std::size_t spring = 0; spring < 6; ++spring) {
      if ((bits >> spring & 1u) != 0) open_spring(mask, spring, patterns);
    }
    for (std::size_t face = 0; face < 4; ++face) fill_skin(bits, mask, face, patterns);
  }
  return table;
}

std::array<std::uint8_t, kSiteCount> make_site_corners() {
  std::array<std::uint8_t, kSiteCount> corners{};
  for (std::size_t s = 0; s < 6; ++s) {
    corners[kMiddles + s] = static_cast<std::uint8_t>(1u << kTetEdges[s][0] | 1u << kTetEdges[s][1]);
  }
  for (std::size_t c = 0; c < 4; ++c) {
    corners[kFaceCenters + c] = static_cast<std::uint8_t>(15u & ~(1u << c));
    corners[kCorners + c] = static_cast<std::uint8_t>(1u << c);
  }
  corners[kCenter] = 15;
  return corners;
}

}  // namespace

const std::array<std::uint8_t, kSiteCount> kSiteCorners = make_site_corners();
const std::array<MaskPatterns, kCutMaskCount> kPatterns = make_patterns();

}  // namespace crumble::surface_patterns
