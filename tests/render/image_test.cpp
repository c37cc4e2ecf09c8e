#include "render/image.hpp"

#include <gtest/gtest.h>
#include <stb_image.h>

#include <memory>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "render/temporary_folder.hpp"

namespace crumble::render {
namespace {

Image gradient(int width, int height) {
  Image image = make_image(width, height, {0, 0, 0});
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.at(x, y) = {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), static_cast<std::uint8_t>(x ^ y)};
    }
  }
  return image;
}

TEST(Image, PngReadsBackPixelForPixel) {
  const TemporaryFolder folder;
  const Image image = gradient(37, 21);
  write_png(image, folder.file("a.png"));
  EXPECT_EQ(folder.size(), 1u);  // no temporary file is left
  int width = 0, height = 0, channels = 0;
  const std::unique_ptr<stbi_uc, void (*)(void*)> bytes(
      stbi_load(folder.file("a.png").c_str(), &width, &height, &channels, 0), stbi_image_free);
  ASSERT_TRUE(bytes);
  ASSERT_EQ(width, 37);
  ASSERT_EQ(height, 21);
  ASSERT_EQ(channels, 3);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) ASSERT_EQ(bytes.get()[3 * i + k], image.pixels[i][k]);
  }
}

TEST(Image, PngWhereNoFileCanBeIsAnIoError) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.file("folder"));
  for (const auto& path : {folder.file("missing") / "a.png", folder.file("folder")}) {
    try {
      write_png(gradient(4, 4), path);
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), Code::io);
    }
  }
  EXPECT_EQ(folder.size(), 1u);
}

TEST(Image, TilesLieInRowsWithBorders) {
  Vector<Image> images;
  for (const std::uint8_t shade : std::initializer_list<std::uint8_t>{10, 20, 30, 40, 50})
    images.push_back(make_image(7, 5, {shade, shade, shade}));
  const Image out = tile(images, 3, 2, {255, 0, 0});
  ASSERT_EQ(out.width, 3 * 7 + 4 * 2);
  ASSERT_EQ(out.height, 2 * 5 + 3 * 2);
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      const bool in_tile = x % 9 >= 2 && y % 7 >= 2;
      const int number = x / 9 + 3 * (y / 7);
      const int wanted = in_tile && number < 5 ? 10 * (number + 1) : 255;
      ASSERT_EQ(out.at(x, y)[0], wanted) << x << ' ' << y;
    }
  }
}

TEST(Image, TilesOfDifferentSizesAreRefused) {
  const Vector<Image> images = {make_image(7, 5, {}), make_image(7, 6, {})};
  EXPECT_THROW(tile(images, 2, 1, {}), Error);
  EXPECT_THROW(tile({}, 2, 1, {}), Error);
}

TEST(Image, TextStaysInItsBoxAndIsCutAtTheEdge) {
  Image image = make_image(100, 40, {255, 255, 255});
  draw_text(image, 10, 12, "(a) I", 2, {0, 0, 0});
  int inked = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (image.at(x, y)[0] != 0) continue;
      ++inked;
      EXPECT_TRUE(x >= 10 && x < 10 + text_width("(a) I", 2) && y >= 12 && y < 12 + 2 * 12) << x << ' ' << y;
    }
  }
  EXPECT_GT(inked, 4 * 20);  // the scale's squares
  EXPECT_EQ(inked % 4, 0);
  draw_text(image, 90, 35, "cut off", 3, {0, 0, 0});
  draw_text(image, -9, -5, "cut off", 3, {0, 0, 0});
}

TEST(Image, PhasesStandTwoByTwoOverTheirCaptions) {
  Vector<Image> phases;
  for (const std::uint8_t shade : std::initializer_list<std::uint8_t>{10, 20, 30, 40})
    phases.push_back(make_image(360, 200, {shade, 0, 0}));
  const Image out = tile_phases(std::span<const Image, 4>(phases.data(), 4), {"one", "two", "three", "four"});
  const int right = out.width / 2, below = out.height / 2;
  EXPECT_EQ(out.at(right / 2, below / 2)[0], 10);
  EXPECT_EQ(out.at(right + right / 2, below / 2)[0], 20);
  EXPECT_EQ(out.at(right / 2, below + below / 2)[0], 30);
  EXPECT_EQ(out.at(right + right / 2, below + below / 2)[0], 40);
  int dark = 0;
  for (int y = 4 + 200; y < below; ++y) {
    for (int x = 0; x < right; ++x) dark += out.at(x, y)[0] < 100;
  }
  EXPECT_GT(dark, 50);  // "(a) one"
}

}  // namespace
}  // namespace crumble::render
