// The tension cut rule (paper §2.5, Eq 8).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "crumble/base/vec_array.hpp"
#include "crumble/tetmesh/tet_mesh.hpp"

namespace crumble {

/// (length_limit * rest_length)^2 of every spring, m^2: what cut_springs compares with, so that a step takes no root.
/// `length_limit` is l_p, a ratio. Throws Error(out_of_range) unless 1 <= length_limit <= 1e6: below 1 a body at rest
/// would break; Error(invalid_value) when it is not finite.
std::vector<double> squared_length_limits(std::span<const double> rest_lengths, double length_limit);

/// Eq 8: cuts every intact spring that is longer than length_limit * rest_length, all at once on the positions given,
/// those after the move. As length_limit >= 1 a spring in compression is never cut, and one exactly at its limit holds.
/// `positions` (node_count, metres); `springs`, `squared_limits` and `intact` (spring_count; intact is 1 or 0) belong
/// together by index. Writes the ids of the springs cut now to the front of `newly_cut`, ascending, and returns how
/// many; `newly_cut` needs spring_count places and what stands behind the count is scratch. A spring whose length is
/// NaN is left alone. Called in every step: no allocation, no root, no system call.
std::size_t cut_springs(VecView positions, std::span<const Edge> springs, std::span<const double> squared_limits,
                        std::span<std::uint8_t> intact, std::span<std::uint32_t> newly_cut) noexcept;

}  // namespace crumble
