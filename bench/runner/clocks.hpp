// What is measured with, and how many measurements become one line.
#pragma once

#include <cstdint>

#include "crumble/base/memory.hpp"

namespace crumble::bench {

/// Middle value; of an even number the upper one. `values` must not be empty.
double median(Vector<double> values);

struct Percentiles {
  double p50 = 0, p99 = 0, p99_9 = 0, max = 0;
};
/// `values` must not be empty.
Percentiles percentiles(Vector<double> values);

/// Counts to `turns` in registers: takes a time that only the processor's clock and other programs decide.
void empty_loop(std::uint64_t turns) noexcept;

}  // namespace crumble::bench
