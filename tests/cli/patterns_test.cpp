// `crumble patterns`.
#include <gtest/gtest.h>

#include "cli/command.hpp"
#include "crumble/base/file.hpp"
#include "render/temporary_folder.hpp"

namespace crumble::cli {
namespace {

using render::TemporaryFolder;

// A PNG begins with 8 bytes of signature and the header chunk: length, "IHDR", width, height, most significant first.
unsigned big_endian(const std::string& bytes, std::size_t at) {
  unsigned value = 0;
  for (std::size_t i = at; i < at + 4; ++i) value = value << 8u | static_cast<unsigned char>(bytes.at(i));
  return value;
}

TEST(Patterns, DrawsTheElevenClassesAndALegend) {
  const TemporaryFolder folder;
  std::string pictures[2];
  for (int i = 0; i < 2; ++i) {
    const std::string file = folder.file("patterns.png").string();
    const Outcome outcome = crumble({"patterns", "--mode", i == 0 ? "cracks" : "paper", "--out", file});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    pictures[i] = read_text(file);
    EXPECT_EQ(pictures[i].substr(1, 3), "PNG");
    EXPECT_EQ(big_endian(pictures[i], 16), 4 * 252 + 5 * 4u) << "four tiles wide";
    EXPECT_EQ(big_endian(pictures[i], 20), 3 * (226 + 34) + 4 * 4u) << "three high, each over its two lines";
    EXPECT_LT(pictures[i].size(), 300'000u) << "kept in docs/images";
  }
  EXPECT_NE(pictures[0], pictures[1]);
}

TEST(Patterns, DrawsCracksUnlessAsked) {
  const TemporaryFolder folder;
  const std::string plain = folder.file("plain.png").string(), asked = folder.file("asked.png").string();
  ASSERT_EQ(crumble({"patterns", "--out", plain}).code, 0);
  ASSERT_EQ(crumble({"patterns", "--mode", "cracks", "--out", asked}).code, 0);
  EXPECT_EQ(read_text(plain), read_text(asked));
}

}  // namespace
}  // namespace crumble::cli
