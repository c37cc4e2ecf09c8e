#include "render/force_plot.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "crumble/base/error.hpp"
#include "crumble/base/file.hpp"
#include "crumble/base/memory.hpp"
#include "render/temporary_folder.hpp"

namespace crumble::render {
namespace {

Vector<ForceSample> press(int count) {
  Vector<ForceSample> samples;
  for (int i = 0; i < count; ++i) {
    const double depth = 0.02 * i / count;
    samples.push_back({1000 * depth, depth, {0.1, 100 * depth, -0.05}, static_cast<std::uint64_t>(i / 10)});
  }
  return samples;
}

TEST(ForcePlot, WritesALabelledSvg) {
  const TemporaryFolder folder;
  write_force_plot(press(5000), PlotAxis::depth, "the stick's first 20 mm", folder.file("force.svg"));
  const std::string svg = read_text(folder.file("force.svg"));
  EXPECT_EQ(folder.size(), 1u);
  for (const char* wanted : {"<svg", "the stick's first 20 mm", "depth of the tool (mm)", "force on the tool (N)",
                             "springs cut so far", "Fx", "Fy", "Fz", "|F|", "</svg>"}) {
    EXPECT_NE(svg.find(wanted), std::string::npos) << wanted;
  }
  EXPECT_LT(svg.size(), 300000u);  // thinned
}

TEST(ForcePlot, ThinningKeepsPeaksOfOneSample) {
  const TemporaryFolder folder;
  Vector<ForceSample> samples = press(20000);
  samples[7777].force.x() = -39;
  samples[3333].force.z() = 57;
  write_force_plot(samples, PlotAxis::depth, "", folder.file("force.svg"));
  const std::string svg = read_text(folder.file("force.svg"));
  EXPECT_NE(svg.find(">-40<"), std::string::npos);  // ends of gnuplot's own force axis
  EXPECT_NE(svg.find("> 60<"), std::string::npos);
}

TEST(ForcePlot, WithoutCutsThereIsNoSecondAxis) {
  const TemporaryFolder folder;
  write_force_plot(press(9), PlotAxis::time, "", folder.file("force.svg"));
  const std::string svg = read_text(folder.file("force.svg"));
  EXPECT_NE(svg.find("time (s)"), std::string::npos);
  EXPECT_EQ(svg.find("springs cut"), std::string::npos);
}

TEST(ForcePlot, AMissingGnuplotIsNamedAndTheOldFileStays) {
  const TemporaryFolder folder;
  write_text(folder.file("force.svg"), "old");
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", "/nowhere", 1);
  try {
    write_force_plot(press(9), PlotAxis::time, "", folder.file("force.svg"));
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Code::unsupported);
    EXPECT_NE(std::string(error.what()).find("gnuplot"), std::string::npos);
  }
  ::setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(read_text(folder.file("force.svg")), "old");
}

TEST(ForcePlot, RefusesBadSamples) {
  Vector<ForceSample> samples = press(9);
  EXPECT_THROW(write_force_plot({}, PlotAxis::time, "", "unused.svg"), Error);
  samples[3].force.y() = std::nan("");
  EXPECT_THROW(write_force_plot(samples, PlotAxis::time, "", "unused.svg"), Error);
}

}  // namespace
}  // namespace crumble::render
