#include "crumble/fracture/cut.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "crumble/base/memory.hpp"
#include "crumble/base/random.hpp"

namespace crumble {
namespace {

using Ids = Vector<std::uint32_t>;
using Flags = Vector<std::uint8_t>;

Ids cut(const Ids& overlong, Flags& intact) {
  Ids newly_cut(overlong.size());
  newly_cut.resize(cut_springs(overlong, intact, newly_cut));
  return newly_cut;
}

TEST(Cut, WhatIsTooLongAndIntact) {
  Flags intact{1, 1, 0, 1, 0, 1};
  EXPECT_EQ(cut({1, 2, 5}, intact), (Ids{1, 5}));
  EXPECT_EQ(intact, (Flags{1, 0, 0, 1, 0, 0}));
}

TEST(Cut, EachSpringOnce) {
  Flags intact(4, 1);
  EXPECT_EQ(cut({0, 2}, intact), (Ids{0, 2}));
  EXPECT_TRUE(cut({0, 2}, intact).empty());  // still too long
  EXPECT_EQ(cut({0, 1, 2}, intact), Ids{1});
  EXPECT_EQ(intact, (Flags{0, 0, 0, 1}));
}

TEST(Cut, NothingWhenNothingIsTooLong) {
  Flags intact{1, 0, 1};
  EXPECT_TRUE(cut({}, intact).empty());
  EXPECT_EQ(intact, (Flags{1, 0, 1}));
}

TEST(Cut, AllAtOnceFillsTheBuffer) {
  Flags intact(100, 1);
  Ids all(100);
  std::iota(all.begin(), all.end(), 0u);
  EXPECT_EQ(cut(all, intact), all);
  EXPECT_EQ(intact, Flags(100, 0));
}

TEST(Cut, TakesRandomSetsApart) {
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    Flags intact, after;
    Ids overlong, expected;
    for (std::uint32_t s = 0; s < 60; ++s) {
      const bool whole = random.uniform() < 0.6, too_long = random.uniform() < 0.3;
      intact.push_back(whole), after.push_back(whole && !too_long);
      if (too_long) overlong.push_back(s);
      if (whole && too_long) expected.push_back(s);
    }
    ASSERT_EQ(cut(overlong, intact), expected);
    ASSERT_EQ(intact, after);
  }
}

}  // namespace
}  // namespace crumble
