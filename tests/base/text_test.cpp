#include "crumble/base/text.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <limits>

#include "crumble/base/random.hpp"

namespace crumble {
namespace {

TEST(Text, EveryFiniteDoubleComesBackExactly) {
  Random random(1);
  for (int i = 0; i < 100000; ++i) {
    const double value = std::bit_cast<double>(random.next());
    if (value - value != 0) continue;
    const auto back = parse_double(to_text(value));
    ASSERT_TRUE(back);
    ASSERT_EQ(std::bit_cast<std::uint64_t>(*back), std::bit_cast<std::uint64_t>(value));
  }
}

TEST(Text, RefusesWhatIsNotOneNumber) {
  for (const char* text : {"", " 1", "1 ", "1,5", "1.5x", "0x10", "+-1", "one"})
    EXPECT_FALSE(parse_double(text)) << text;
}

TEST(Text, IsShort) {
  EXPECT_EQ(to_text(0.1), "0.1");
  EXPECT_EQ(to_text(-std::numeric_limits<double>::infinity()), "-inf");
}

}  // namespace
}  // namespace crumble
