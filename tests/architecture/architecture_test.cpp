// The tree obeys the rules of the house, and the rules bite: each is shown a small tree that breaks it.
#include <gtest/gtest.h>

#include <fstream>

#include "architecture/rules.hpp"

namespace crumble::architecture {
namespace {

namespace fs = std::filesystem;

std::string listed(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += "\n  " + line;
  return text;
}

TEST(House, DependenciesPointDown) {
  ASSERT_GT(library_files(CRUMBLE_SOURCE_DIR).size(), 40u) << "is " << CRUMBLE_SOURCE_DIR << " the source tree?";
  const auto wrong = check_includes(CRUMBLE_SOURCE_DIR);
  EXPECT_TRUE(wrong.empty()) << listed(wrong);
}

TEST(House, OutsideHeadersStayInTheirPlaces) {
  const auto wrong = check_outside_headers(CRUMBLE_SOURCE_DIR);
  EXPECT_TRUE(wrong.empty()) << listed(wrong);
}

TEST(House, TranscendentalsAreOurOwn) {
  const auto wrong = check_transcendentals(CRUMBLE_SOURCE_DIR);
  EXPECT_TRUE(wrong.empty()) << listed(wrong);
}

TEST(House, NoFlagChangesResults) {
  const auto wrong = check_build_files(CRUMBLE_SOURCE_DIR);
  EXPECT_TRUE(wrong.empty()) << listed(wrong);
}

TEST(House, EverySourceIsCompiledWithoutContraction) {
  const auto wrong = check_contraction(fs::path(CRUMBLE_BINARY_DIR) / "compile_commands.json");
  EXPECT_TRUE(wrong.empty()) << listed(wrong);
}

// A tree of its own for each test.
class Teeth : public testing::Test {
 protected:
  Teeth() : root_(fs::path(testing::TempDir()) / "crumble_architecture" / name()) { fs::remove_all(root_); }
  ~Teeth() override { fs::remove_all(root_); }

  static std::string name() { return testing::UnitTest::GetInstance()->current_test_info()->name(); }
  void write(const fs::path& file, const std::string& text) const {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text << "\n";
  }
  // What check_includes says of one file with one include; "" when all is well.
  std::string verdict(const fs::path& file, const std::string& include) const {
    fs::remove_all(root_);
    write(file, "#include " + include);
    const auto wrong = check_includes(root_);
    return wrong.empty() ? "" : wrong.front();
  }

  fs::path root_;
};

TEST_F(Teeth, IncludesUpward) {
  EXPECT_NE(verdict("src/base/hash.cpp", "\"crumble/geometry/pose.hpp\"").find("upward"), std::string::npos);
  EXPECT_NE(verdict("include/crumble/tetmesh/tet_mesh.hpp", "\"crumble/network/solver.hpp\"").find("upward"),
            std::string::npos);
  EXPECT_NE(verdict("src/sim/step.cpp", "<crumble/haptics/loop.hpp>").find("upward"), std::string::npos);
  EXPECT_NE(verdict("src/haptics/loop.cpp", "\"crumble/crumble.h\"").find("upward"), std::string::npos);
}

TEST_F(Teeth, IncludesSideways) {
  EXPECT_NE(verdict("src/contact/contacts.cpp", "\"crumble/network/solver.hpp\"").find("sideways"), std::string::npos);
  EXPECT_NE(verdict("src/network/solver.cpp", "\"fracture/masks.hpp\"").find("sideways"), std::string::npos);
  EXPECT_NE(verdict("include/crumble/sim/simulation.hpp", "\"crumble/device/device.hpp\"").find("sideways"),
            std::string::npos);
}

TEST_F(Teeth, SimDoesNotKnowTheGenerator) {
  EXPECT_NE(verdict("src/sim/simulation.cpp", "\"crumble/bubblemesh/generate.hpp\"").find("does not know"),
            std::string::npos);
}

TEST_F(Teeth, LeavesTheLibrary) {
  EXPECT_NE(verdict("src/sim/simulation.cpp", "\"scenes/scene.hpp\"").find("no module"), std::string::npos);
  EXPECT_NE(verdict("src/sim/simulation.cpp", "\"../apps/crumble/run.hpp\"").find("no module"), std::string::npos);
  EXPECT_NE(verdict("src/loose.cpp", "\"crumble/base/hash.hpp\"").find("stands in no module"), std::string::npos);
}

TEST_F(Teeth, SeesDirectivesWithBlanks) {
  EXPECT_NE(verdict("src/base/hash.cpp", "\t \"crumble/geometry/pose.hpp\""), "");
  write("src/base/hash.cpp", "  # \t include <crumble/geometry/pose.hpp>  // why");
  EXPECT_EQ(check_includes(root_).size(), 1u);
}

TEST_F(Teeth, AllowsWhatPointsDown) {
  EXPECT_EQ(verdict("src/sim/step.cpp", "\"crumble/fracture/cut.hpp\""), "");
  EXPECT_EQ(verdict("src/bubblemesh/relax.cpp", "\"neighbour_grid.hpp\""), "");
  EXPECT_EQ(verdict("src/bubblemesh/relax.cpp", "\"bubblemesh/neighbour_grid.hpp\""), "");
  EXPECT_EQ(verdict("capi/src/mesh.cpp", "\"crumble/crumble.h\""), "");
  EXPECT_EQ(verdict("capi/src/mesh.cpp", "\"crumble/bubblemesh/generate.hpp\""), "");
  EXPECT_EQ(verdict("src/network/solver.cpp", "<vector>"), "");
}

TEST_F(Teeth, OutsideHeaders) {
  write("src/geometry/distance.cpp", "#include <fcl/narrowphase/distance.h>");
  EXPECT_TRUE(check_outside_headers(root_).empty());
  write("src/sim/step.cpp", "#include <fcl/geometry/bvh/BVH_model.h>");
  EXPECT_EQ(check_outside_headers(root_).size(), 1u);
  write("src/sim/step.cpp", "#include <iostream>");
  EXPECT_EQ(check_outside_headers(root_).size(), 1u);
  write("src/sim/step.cpp", "#include <Eigen/Core>");
  EXPECT_TRUE(check_outside_headers(root_).empty());
  write("capi/src/mesh.cpp", "#include <Eigen/Core>");
  EXPECT_EQ(check_outside_headers(root_).size(), 1u);
  write("include/crumble/geometry/distance.hpp", "#include <fcl/narrowphase/distance.h>");
  EXPECT_GE(check_outside_headers(root_).size(), 2u);
}

TEST_F(Teeth, Transcendentals) {
  write("src/sim/step.cpp", "const double r = std::sqrt(std::exchange(x, exp_exact(y)));");
  EXPECT_TRUE(check_transcendentals(root_).empty());
  write("src/network/coefficients.cpp", "const double e = std::expm1(-gamma);");
  write("include/crumble/base/vec.hpp", "return std::fma(a, b, c) + std::atan2(y, x);");
  EXPECT_EQ(check_transcendentals(root_).size(), 3u);
}

TEST_F(Teeth, BuildFiles) {
  write("src/CMakeLists.txt", "target_compile_options(crumble_core PRIVATE -O2)");
  EXPECT_TRUE(check_build_files(root_).empty());
  write("apps/CMakeLists.txt", "target_compile_options(x PRIVATE -march=native)");
  write("cmake/Fast.cmake", "add_compile_options(-ffast-math)");
  write("CMakePresets.json", "\"CMAKE_CXX_FLAGS\": \"-ffp-contract=fast\"");
  EXPECT_EQ(check_build_files(root_).size(), 3u);
  write("trial/CMakeCache.txt", "");  // marks a build tree, whose files are not ours
  write("trial/flags.cmake", "-march=native");
  EXPECT_EQ(check_build_files(root_).size(), 3u);
}

TEST_F(Teeth, Contraction) {
  const fs::path file = root_ / "compile_commands.json";
  EXPECT_EQ(check_contraction(file).size(), 1u);  // absent
  const std::string good = "  \"command\": \"c++ -ffp-contract=off -c a.cpp\",\n  \"file\": \"a.cpp\"\n";
  write("compile_commands.json", "[\n{\n" + good + "}\n]");
  EXPECT_TRUE(check_contraction(file).empty());
  write("compile_commands.json",
        "[\n{\n" + good + "},\n{\n  \"command\": \"c++ -c b.cpp\",\n  \"file\": \"b.cpp\"\n}\n]");
  EXPECT_EQ(check_contraction(file).size(), 1u);
}

}  // namespace
}  // namespace crumble::architecture
