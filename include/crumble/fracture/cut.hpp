// The tension cut rule (paper §2.5, Eq 8): which of the springs that the network found too long are cut now.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace crumble {

/// Cuts every spring of `overlong` that is intact, all at once. `overlong` ascends, without doubles; `intact` is 1 or 0
/// (spring_count). Writes the ids of those cut now to the front of `newly_cut`, ascending, and returns how many; there
/// must be a place for each of `overlong`. Called in every step: no allocation.
std::size_t cut_springs(std::span<const std::uint32_t> overlong, std::span<std::uint8_t> intact,
                        std::span<std::uint32_t> newly_cut) noexcept;

}  // namespace crumble
