// What contact sees of the moving nodes: where they are, which of them are near, and where it puts those it holds.
// The network's solver is one; a test may be another.
#pragma once

#include <cstdint>
#include <span>

#include "crumble/base/vec.hpp"
#include "crumble/geometry/convex.hpp"

namespace crumble {

class NodeSource {
 public:
  virtual ~NodeSource() = default;

  virtual std::size_t node_count() const noexcept = 0;
  virtual Vec3 position(std::uint32_t node) const noexcept = 0;  // metres
  virtual Vec3 velocity(std::uint32_t node) const noexcept = 0;  // m/s
  virtual void place(std::uint32_t node, const Vec3& position, const Vec3& velocity) noexcept = 0;

  /// Nodes with low <= position <= high, each once, in an order that depends on the body only. Valid until the next
  /// search. May name nodes a rounding error of the coordinates outside.
  virtual std::span<const std::uint32_t> inside(const Vec3& low, const Vec3& high) noexcept = 0;
  /// Nodes with normal . position < offset; the rest as above.
  virtual std::span<const std::uint32_t> behind(const Plane& plane) noexcept = 0;
};

}  // namespace crumble
