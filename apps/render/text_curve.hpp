// A curve in a terminal.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace crumble::render {

struct CurveLabels {
  std::string_view x, y;  // names and units, UTF-8
};

/// A graph of y over x from braille dots (2 x 4 per character): `height` lines of `width` characters with y's numbers
/// on the left, then x's axis with its numbers. Every column of dots is inked from the least to the greatest y that it
/// meets, so a drop between two columns is never lost. Ends with a newline; contains no escape codes.
/// Throws Error: empty, invalid_value (x and y differ in length, a value that is not finite), out_of_range (a value
/// beyond 1e100, width not in [20, 400], height not in [3, 100]).
std::string text_curve(std::span<const double> x, std::span<const double> y, int width, int height,
                       const CurveLabels& labels);

}  // namespace crumble::render
