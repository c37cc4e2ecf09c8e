// What is measured with, and how many measurements become one line.
#pragma once

#include <cstdint>
#include <vector>

namespace crumble::bench {

/// Middle value; of an even number the upper one. `values` must not be empty.
double median(std::vector<double> values);

struct Percentiles {
  double p50 = 0, p99 = 0, p99_9 = 0, max = 0;
};
/// `values` must not be empty.
Percentiles percentiles(std::vector<double> values);

/// Counts to `turns` in registers: takes a time that only the processor's clock and other programs decide.
void empty_loop(std::uint64_t turns) noexcept;

}  // namespace crumble::bench
