#include "crumble/base/file.hpp"

#include <gtest/gtest.h>

#include "crumble/base/error.hpp"

namespace crumble {
namespace {

class File : public testing::Test {
 protected:
  std::filesystem::path folder = std::filesystem::temp_directory_path() / "crumble_file_test";
  File() { std::filesystem::create_directories(folder); }
  ~File() override { std::filesystem::remove_all(folder); }
};

TEST_F(File, ComesBackAsItWasWritten) {
  const std::string text("a\0b\nlast line without end", 25);
  write_text(folder / "x", text);
  EXPECT_EQ(read_text(folder / "x"), text);
  write_text(folder / "x", "");
  EXPECT_TRUE(read_bytes(folder / "x").empty());
}

TEST_F(File, ReadingSaysWhyItFailed) {
  const auto message = [](const std::filesystem::path& path) {
    try {
      read_text(path);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), Code::io);
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  EXPECT_NE(message(folder).find("Is a directory"), std::string::npos);
  EXPECT_NE(message(folder / "absent").find("No such file"), std::string::npos);
}

TEST_F(File, AFailedReplacementLeavesTheOldOneAndNothingElse) {
  write_text(folder / "x", "old");
  const auto fails = [](const std::filesystem::path& temporary) {
    write_text(temporary, "half");
    throw Error(Code::internal, "stop");
  };
  EXPECT_THROW(replace_file(folder / "x", fails), Error);
  EXPECT_EQ(read_text(folder / "x"), "old");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
}

}  // namespace
}  // namespace crumble
