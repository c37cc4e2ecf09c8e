// Orientation and in-sphere tests without rounding.
//
// Coordinates are integers of 22 bits. Differences then have 23 bits with sign, the orientation determinant at most
// 6 * 2^66 and the in-sphere determinant less than 2^122, so 128-bit integers hold every intermediate result: no
// floating-point filter, no expansions, no perturbation.
#pragma once

#include <cstdint>

namespace crumble {

__extension__ typedef __int128 Int128;

inline constexpr int kCoordinateBits = 22;

struct GridPoint {
  std::int32_t x, y, z;  // in [0, 2^22]
  bool operator==(const GridPoint&) const = default;
};

namespace detail {
struct GridVector {
  std::int64_t x, y, z;
  GridVector(const GridPoint& from, const GridPoint& to)
      : x(std::int64_t{to.x} - from.x), y(std::int64_t{to.y} - from.y), z(std::int64_t{to.z} - from.z) {}
  std::int64_t squared() const { return x * x + y * y + z * z; }
};
inline Int128 triple(const GridVector& a, const GridVector& b, const GridVector& c) {
  return Int128{a.x} * (b.y * c.z - b.z * c.y) + Int128{a.y} * (b.z * c.x - b.x * c.z) +
         Int128{a.z} * (b.x * c.y - b.y * c.x);
}
}  // namespace detail

/// Sign of the volume of a b c d; positive as crumble::orient.
inline int orient_sign(const GridPoint& a, const GridPoint& b, const GridPoint& c, const GridPoint& d) {
  const Int128 volume = detail::triple({a, b}, {a, c}, {a, d});
  return volume > 0 ? 1 : volume < 0 ? -1 : 0;
}

/// Whether e lies strictly inside the sphere through a, b, c, d, which must have positive volume.
inline bool in_sphere(const GridPoint& a, const GridPoint& b, const GridPoint& c, const GridPoint& d,
                      const GridPoint& e) {
  const detail::GridVector ea(e, a), eb(e, b), ec(e, c), ed(e, d);
  const Int128 determinant = (detail::triple(ea, eb, ec) * ed.squared() - detail::triple(ea, eb, ed) * ec.squared()) +
                             (detail::triple(ea, ec, ed) * eb.squared() - detail::triple(eb, ec, ed) * ea.squared());
  return determinant < 0;
}

}  // namespace crumble
