#include "crumble/base/hash.hpp"

#include <gtest/gtest.h>

#include <array>
#include <set>

namespace crumble {
namespace {

TEST(Hash, EverySingleBitFlipChangesTheHash) {
  std::array<std::uint8_t, 37> bytes{};
  std::set<std::uint64_t> seen;
  const auto hash_of = [&] {
    Hash hash;
    hash.add(std::span<const std::uint8_t>(bytes));
    return hash.value();
  };
  seen.insert(hash_of());
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
    EXPECT_TRUE(seen.insert(hash_of()).second) << "bit " << bit;
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
  }
}

TEST(Hash, OrderAndLengthAndSignOfZeroMatter) {
  const auto hash_of = [](std::initializer_list<double> values) {
    Hash hash;
    for (const double v : values) hash.add(v);
    return hash.value();
  };
  EXPECT_NE(hash_of({1, 2}), hash_of({2, 1}));
  EXPECT_NE(hash_of({0}), hash_of({0, 0}));
  EXPECT_NE(hash_of({0.0}), hash_of({-0.0}));
  EXPECT_EQ(hash_of({1, 2}), hash_of({1, 2}));
}

TEST(Hash, IsTheSameInEveryBuild) {
  Hash hash;
  for (int i = 0; i < 1000; ++i) hash.add(0.1 * i);
  EXPECT_EQ(hash.value(), 11672532496704548231u);
}

}  // namespace
}  // namespace crumble
