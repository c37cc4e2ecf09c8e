#include "crumble/base/transcendental.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "crumble/base/random.hpp"

namespace crumble {
namespace {

// libm in long double is the oracle
TEST(Transcendental, ExpHasAlmostEveryBit) {
  Random random(2);
  for (int i = 0; i < 200000; ++i) {
    const double x = random.uniform(-708, 709);
    const long double exact = std::exp(static_cast<long double>(x));
    ASSERT_NEAR(static_cast<double>((exp_exact(x) - exact) / exact), 0, 3e-16) << x;
  }
  EXPECT_EQ(exp_exact(0), 1);
  EXPECT_EQ(exp_exact(-800), 0);
  EXPECT_TRUE(std::isinf(exp_exact(800)));
  EXPECT_TRUE(std::isnan(exp_exact(std::nan(""))));
}

TEST(Transcendental, Expm1KeepsItsDigitsNearZero) {
  Random random(3);
  for (int i = 0; i < 200000; ++i) {
    const double x = random.uniform(-1, 1) * exp_exact(random.uniform(-40, 2));
    const long double exact = std::expm1(static_cast<long double>(x));
    ASSERT_LE(std::abs(static_cast<double>((expm1_exact(x) - exact) / exact)), 1e-15) << x;
  }
}

TEST(Transcendental, SinAndCos) {
  Random random(4);
  for (int i = 0; i < 200000; ++i) {
    const double x = random.uniform(-1e4, 1e4);
    ASSERT_NEAR(sin_exact(x), static_cast<double>(std::sin(static_cast<long double>(x))), 3e-16) << x;
    ASSERT_NEAR(cos_exact(x), static_cast<double>(std::cos(static_cast<long double>(x))), 3e-16) << x;
  }
}

}  // namespace
}  // namespace crumble
