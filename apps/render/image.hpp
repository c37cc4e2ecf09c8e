// Pictures in memory, and as PNG files.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "crumble/base/memory.hpp"

namespace crumble::render {

using Rgb = std::array<std::uint8_t, 3>;  // sRGB
static_assert(sizeof(Rgb) == 3, "pixels go to OpenGL and PNG as they stand in memory");

struct Image {
  int width = 0, height = 0;
  Vector<Rgb> pixels;  // rows from the top, each from the left

  Rgb& at(int x, int y) { return pixels[static_cast<std::size_t>(y) * width + x]; }
  const Rgb& at(int x, int y) const { return pixels[static_cast<std::size_t>(y) * width + x]; }
};

Image make_image(int width, int height, Rgb colour);

/// Images of one size side by side, `columns` to a row, with `border` pixels of `colour` round and between them.
/// Throws Error: empty (no image), out_of_range (columns, border), invalid_value (the sizes differ).
Image tile(std::span<const Image> images, int columns, int border, Rgb colour);

/// Width in pixels of `text` (ASCII) as draw_text draws it.
int text_width(const std::string& text, int scale);
/// Writes `text` (ASCII, one line) with its upper left corner at (x, y), letters 7 * scale pixels high; what falls
/// outside the picture is left out.
void draw_text(Image& image, int x, int y, const std::string& text, int scale, Rgb colour);

/// Throws Error(io). The file appears whole or not at all.
void write_png(const Image& image, const std::filesystem::path& path);

/// The four phases of one experiment, 2 x 2, each under its caption "(a) ...", "(b) ..."; captions are ASCII. Throws
/// what tile() throws.
Image tile_phases(std::span<const Image, 4> phases, const std::array<std::string, 4>& captions);

}  // namespace crumble::render
