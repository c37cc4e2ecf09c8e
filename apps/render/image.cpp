#include "render/image.hpp"

#include <stb_easy_font.h>
#include <stb_image_write.h>

#include <algorithm>
#include <cmath>

#include "crumble/base/error.hpp"
#include "crumble/base/file.hpp"
#include "crumble/base/memory.hpp"

namespace crumble::render {
namespace {

constexpr Rgb kPaper = {250, 250, 248};
constexpr Rgb kInk = {45, 45, 45};

// Letters of stb_easy_font are made of rectangles on a grid of unit squares.
struct TextRectangle {
  int left, top, right, bottom;
};

Vector<TextRectangle> text_rectangles(std::string text) {
  struct Corner {
    float x, y, z;
    std::uint8_t colour[4];
  };
  Vector<Corner> corners(4 * 64 * (text.size() + 1));
  const int count = stb_easy_font_print(0, 0, text.data(), nullptr, corners.data(),
                                        static_cast<int>(corners.size() * sizeof(Corner)));
  const auto unit = [](float v) { return static_cast<int>(std::lround(v)); };
  Vector<TextRectangle> rectangles;
  for (int i = 0; i < count; ++i) {
    const Corner &first = corners[4 * i], &opposite = corners[4 * i + 2];
    rectangles.push_back({unit(first.x), unit(first.y), unit(opposite.x), unit(opposite.y)});
  }
  return rectangles;
}

}  // namespace

Image make_image(int width, int height, Rgb colour) {
  require_in_range("image width", width, 1, 65536);
  require_in_range("image height", height, 1, 65536);
  return {width, height, Vector<Rgb>(static_cast<std::size_t>(width) * height, colour)};
}

Image tile(std::span<const Image> images, int columns, int border, Rgb colour) {
  if (images.empty()) throw Error(Code::empty, "images to tile: there are 0");
  require_in_range("columns", columns, 1, 1024);
  require_in_range("border", border, 0, 1024);
  const int count = static_cast<int>(images.size()), rows = (count + columns - 1) / columns;
  const int width = images[0].width, height = images[0].height;
  Image out =
      make_image(border + std::min(columns, count) * (width + border), border + rows * (height + border), colour);
  for (int i = 0; i < count; ++i) {
    const Image& image = images[i];
    if (image.width != width || image.height != height) {
      throw Error(Code::invalid_value, "images[" + std::to_string(i) + "] must be " + std::to_string(width) + " x " +
                                           std::to_string(height) + " like the first, is " +
                                           std::to_string(image.width) + " x " + std::to_string(image.height));
    }
    const int left = border + i % columns * (width + border), top = border + i / columns * (height + border);
    for (int y = 0; y < height; ++y) std::copy_n(&image.at(0, y), width, &out.at(left, top + y));
  }
  return out;
}

int text_width(const std::string& text, int scale) {
  std::string copy = text;
  return scale * stb_easy_font_width(copy.data());
}

void draw_text(Image& image, int x, int y, const std::string& text, int scale, Rgb colour) {
  for (const TextRectangle& r : text_rectangles(text)) {
    const int left = std::max(0, x + scale * r.left), right = std::min(image.width, x + scale * r.right);
    const int top = std::max(0, y + scale * r.top), bottom = std::min(image.height, y + scale * r.bottom);
    for (int row = top; row < bottom; ++row) {
      for (int column = left; column < right; ++column) image.at(column, row) = colour;
    }
  }
}

void write_png(const Image& image, const std::filesystem::path& path) {
  Vector<std::uint8_t> bytes;
  const auto append = [](void* out, void* data, int size) {
    const auto* first = static_cast<const std::uint8_t*>(data);
    auto& all = *static_cast<Vector<std::uint8_t>*>(out);
    all.insert(all.end(), first, first + size);
  };
  if (!stbi_write_png_to_func(append, &bytes, image.width, image.height, 3, image.pixels.data(), 3 * image.width)) {
    throw Error(Code::no_memory, "cannot encode '" + path.string() + "'");
  }
  write_bytes(path, bytes);
}

Image tile_phases(std::span<const Image, 4> phases, const std::array<std::string, 4>& captions) {
  const int scale = std::max(1, phases[0].width / 360), strip = 14 * scale, border = 4 * scale;
  Vector<Image> framed;
  for (std::size_t i = 0; i < phases.size(); ++i) {
    Image image = make_image(phases[i].width, phases[i].height + strip, kPaper);
    std::copy(phases[i].pixels.begin(), phases[i].pixels.end(), image.pixels.begin());
    const std::string letter(1, static_cast<char>('a' + i)), text = "(" + letter + ") " + captions[i];
    draw_text(image, (image.width - text_width(text, scale)) / 2, phases[i].height + 4 * scale, text, scale, kInk);
    framed.push_back(std::move(image));
  }
  return tile(framed, 2, border, kPaper);
}

}  // namespace crumble::render
