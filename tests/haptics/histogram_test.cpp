#include "crumble/haptics/histogram.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "crumble/base/memory.hpp"
#include "crumble/base/random.hpp"

namespace crumble {
namespace {

TEST(Histogram, QuantilesAreThoseOfTheSortedTimes) {
  Random random(3);
  Histogram histogram;
  Vector<double> times;
  for (int k = 0; k < 20000; ++k) {
    times.push_back(std::pow(10, random.uniform(-8, 0)));
    histogram.add(times.back());
  }
  std::sort(times.begin(), times.end());
  for (const double share : {0.0, 0.1, 0.5, 0.9, 0.99, 0.999, 1.0}) {
    const auto at = static_cast<std::size_t>(std::max(0.0, std::ceil(share * 20000) - 1));
    EXPECT_NEAR(histogram.quantile(share), times[at], 0.033 * times[at] + 1e-9) << share;
    EXPECT_GE(histogram.quantile(share), times[at] - 1e-9) << share;
  }
  EXPECT_NEAR(histogram.greatest(), times.back(), 1e-9);
  EXPECT_EQ(histogram.count(), 20000u);
}

TEST(Histogram, TakesAnything) {
  Histogram histogram;
  EXPECT_EQ(histogram.quantile(0.5), 0);
  for (const double t : {-1.0, 0.0, std::numeric_limits<double>::quiet_NaN(), 1e-12, 1e30}) histogram.add(t);
  EXPECT_EQ(histogram.count(), 5u);
  EXPECT_EQ(histogram.quantile(0.5), 0);
  EXPECT_GT(histogram.greatest(), 1e9);
  histogram.clear();
  EXPECT_EQ(histogram.count(), 0u);
  EXPECT_EQ(histogram.greatest(), 0);
}

}  // namespace
}  // namespace crumble
