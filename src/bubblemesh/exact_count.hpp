// So many bubbles and no other number.
#pragma once

#include <cstdint>
#include <functional>
#include <string_view>

#include "bubblemesh/cloud.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/geometry/shape.hpp"

namespace crumble {

/// Takes the most crowded nodes of [first, size) out, or puts new ones of their kind on the widest gaps among `places`,
/// and relaxes, until the cloud's last group (surface or inside; the surface counts its features) has `wanted` nodes.
/// Throws Error(out_of_range) naming `field` when `wanted` lies outside 0.6 to 1.5 times the present number.
void match_count(std::string_view field, const Shape& shape, double spacing, std::size_t first, std::uint32_t wanted,
                 const Vector<SurfacePoint>& places, Cloud& cloud, const std::function<void(int, double)>& relax);

}  // namespace crumble
