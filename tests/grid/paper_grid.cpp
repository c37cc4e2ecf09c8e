// Runs points of the paper's grid and prints one line each; exit code 1 when one has failed. scripts/verify-grid runs
// it for the whole grid.
#include <cstdio>
#include <cstring>
#include <optional>

#include "crumble/base/error.hpp"
#include "crumble/base/text.hpp"
#include "grid/grid.hpp"

namespace {

using namespace crumble;

constexpr const char* kUsage =
    "usage: paper_grid [--unchecked] FIRST LAST [STRIDE]\n"
    "Points FIRST to LAST, of 0 to 499. --unchecked: the paper's way, without the guard, to see the test fail.\n";

std::optional<std::size_t> parse_count(const char* text, std::size_t least, std::size_t greatest) {
  const auto value = parse_double(text);
  if (!value || !(*value >= static_cast<double>(least) && *value <= static_cast<double>(greatest))) return {};
  return static_cast<std::size_t>(*value);
}

// Returns the number of points that failed.
std::size_t run(std::size_t first, std::size_t last, std::size_t stride, TimeStepPolicy policy) {
  std::size_t failed = 0;
  for (std::size_t point = first; point <= last; point += stride) {
    const Material m = grid::material_at(point);
    const grid::PointResult result = grid::run_point(point, policy);
    failed += result.failed();
    std::printf("%5zu %5.0f %5.0f %5.1f %8llu %8llu %8llu  %s\n", point, m.stiffness, m.damping_ratio, m.length_limit,
                static_cast<unsigned long long>(result.cuts), static_cast<unsigned long long>(result.cuts_third),
                static_cast<unsigned long long>(result.guarded),
                result.diverged ? "DIVERGED" : (result.failed() ? "FAILED" : "ok"));
    std::fflush(stdout);
  }
  return failed;
}

}  // namespace

int main(int argc, char** argv) {
  const bool unchecked = argc > 1 && std::strcmp(argv[1], "--unchecked") == 0;
  if (unchecked) --argc, ++argv;
  const auto first = argc > 2 ? parse_count(argv[1], 0, grid::kPoints - 1) : std::nullopt;
  const auto last = first ? parse_count(argv[2], *first, grid::kPoints - 1) : std::nullopt;
  const auto stride = argc > 3 ? parse_count(argv[3], 1, grid::kPoints) : std::size_t{1};
  if (!first || !last || !stride || argc > 4) {
    std::fputs(kUsage, stderr);
    return 2;
  }
  try {
    return run(*first, *last, *stride, unchecked ? TimeStepPolicy::unchecked : TimeStepPolicy::guard) == 0 ? 0 : 1;
  } catch (const Error& error) {
    std::fprintf(stderr, "paper_grid: %s\n", error.what());
    return 2;
  }
}
