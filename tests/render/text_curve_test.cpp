#include "render/text_curve.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"

namespace crumble::render {
namespace {

Vector<std::u32string> lines_of(const std::string& text) {
  Vector<std::u32string> lines(1);
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const int length = lead < 0x80 ? 1 : lead < 0xe0 ? 2 : 3;
    char32_t c = lead < 0x80 ? lead : lead < 0xe0 ? lead & 0x1f : lead & 0x0f;
    for (int k = 1; k < length; ++k) c = c << 6 | (static_cast<unsigned char>(text[i + k]) & 0x3f);
    i += length;
    if (c == U'\n')
      lines.emplace_back();
    else
      lines.back() += c;
  }
  EXPECT_TRUE(lines.back().empty());  // ends with a newline
  lines.pop_back();
  return lines;
}

/// Row of dots (from the top) of the highest dot in each column of dots; -1 where there is none.
Vector<int> highest_dots(const Vector<std::u32string>& lines, int width, int height) {
  constexpr int kBits[4][2] = {{0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}};
  Vector<int> highest(2 * width, -1);
  for (int row = 4 * height - 1; row >= 0; --row) {
    for (int column = 0; column < 2 * width; ++column) {
      const char32_t cell = lines[1 + row / 4].at(9 + column / 2);
      if (cell != U' ' && (cell - 0x2800) & kBits[row % 4][column % 2]) highest[column] = row;
    }
  }
  return highest;
}

TEST(TextCurve, AStraightLineIsStraight) {
  const Vector<double> x = {0, 30}, y = {0, 2};
  const auto lines = lines_of(text_curve(x, y, 40, 9, {"depth (mm)", "force (N)"}));
  ASSERT_EQ(lines.size(), 1u + 9 + 2);
  EXPECT_NE(lines[0].find(U"force (N)"), std::u32string::npos);
  EXPECT_NE(lines[11].find(U"30  depth (mm)"), std::u32string::npos);
  EXPECT_EQ(lines[1].substr(0, 9), U"      2 ┤");
  EXPECT_EQ(lines[5].substr(0, 9), U"      1 ┤");
  EXPECT_EQ(lines[9].substr(0, 9), U"      0 ┤");
  for (int row = 1; row <= 9; ++row) EXPECT_EQ(lines[row].size(), 9u + 40);
  const Vector<int> highest = highest_dots(lines, 40, 9);
  for (int column = 0; column < 80; ++column) EXPECT_NEAR(highest[column], 35 - 35 * column / 79.0, 1.0) << column;
}

TEST(TextCurve, APeakBetweenTwoColumnsIsKept) {
  Vector<double> x, y;
  for (int i = 0; i <= 10000; ++i) x.push_back(i * 0.002), y.push_back(i == 4321 ? 4 : 1);
  const auto highest = highest_dots(lines_of(text_curve(x, y, 30, 9, {"s", "N"})), 30, 9);
  EXPECT_EQ(*std::min_element(highest.begin(), highest.end()), 0);
}

TEST(TextCurve, NegativeValuesLieBelowZero) {
  const Vector<double> x = {0, 1, 2, 3}, y = {-1, -1, 3, 3};
  const auto lines = lines_of(text_curve(x, y, 20, 9, {"", ""}));
  EXPECT_EQ(lines[9].substr(0, 8), U"     -1 ");
  EXPECT_EQ(lines[7].substr(0, 8), U"      0 ");
  EXPECT_EQ(lines[1].substr(0, 8), U"      3 ");
}

TEST(TextCurve, TheAxisReachesBelowALeastValueThatIsNotRound) {
  const Vector<double> x = {0, 1}, y = {-0.7, 3};
  const auto lines = lines_of(text_curve(x, y, 20, 9, {"", ""}));
  EXPECT_EQ(lines[9].substr(0, 8), U"     -1 ");
  EXPECT_EQ(lines[7].substr(0, 8), U"      0 ");
}

TEST(TextCurve, ConstantZeroAndOnePointAreDrawn) {
  const Vector<double> zero = {0};
  const auto lines = lines_of(text_curve(zero, zero, 20, 4, {"x", "y"}));
  EXPECT_NE(lines[4].at(9), U' ');
}

TEST(TextCurve, RefusesBadInput) {
  const Vector<double> two = {0, 1}, one = {0}, none, bad = {0, std::nan("")};
  EXPECT_THROW(text_curve(two, one, 40, 9, {}), Error);
  EXPECT_THROW(text_curve(none, none, 40, 9, {}), Error);
  EXPECT_THROW(text_curve(two, bad, 40, 9, {}), Error);
  EXPECT_THROW(text_curve(two, two, 4, 9, {}), Error);
  EXPECT_THROW(text_curve(two, two, 40, 1, {}), Error);
}

}  // namespace
}  // namespace crumble::render
