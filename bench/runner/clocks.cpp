#include "runner/clocks.hpp"

#include <algorithm>
#include <cmath>

#include "crumble/base/memory.hpp"

namespace crumble::bench {

double median(Vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Percentiles percentiles(Vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size() - 1)))];
  };
  return {at(0.5), at(0.99), at(0.999), at(1)};
}

void empty_loop(std::uint64_t turns) noexcept {
  for (std::uint64_t i = 0; i < turns; ++i) asm volatile("" : "+r"(i));
}

}  // namespace crumble::bench
