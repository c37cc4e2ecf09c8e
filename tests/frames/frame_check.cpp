// Watches the scenes named on the command line and prints one line each; exit code 1 when one is beyond a bound.
// scripts/verify-frames runs it for the paper's bodies.
#include <cmath>
#include <cstdio>
#include <cstring>
#include <map>

#include "crumble/base/text.hpp"
#include "frames/frames.hpp"

namespace {

using namespace crumble;

constexpr const char* kUsage =
    "usage: frame_check [--mode cracks|fragments|paper] [--settle SECONDS] SCENE...\n"
    "--settle: how long a cut takes to show; 0: at once, to see the check fail.\n";

// Returns false for what is not an option, or not with a value.
bool read_option(const std::string& name, const std::string& value, SurfaceSettings& settings) {
  static const std::map<std::string, SurfaceMode> kModes{
      {"cracks", SurfaceMode::cracks}, {"fragments", SurfaceMode::fragments}, {"paper", SurfaceMode::paper}};
  if (name == "--mode" && kModes.contains(value)) {
    settings.mode = kModes.at(value);
    return true;
  }
  const auto seconds = parse_double(value);
  if (name != "--settle" || !seconds) return false;
  settings.settle = *seconds;
  return true;
}

std::string with_time(const char* format, double value, double time) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return std::string(text) + " at " + to_text(std::floor(100 * time) / 100);
}

bool watch_scene(const std::string& name, const frames::Options& options) {
  const frames::Report r = frames::watch(load_scene(name, Preset::standard), options);
  const std::string complaint = frames::complaint(r);
  std::printf("%-16s %6zu %5zu %7zu %6zu %16s %6.2f%% %12s %14s %14s  %s\n", name.c_str(), r.frames, r.cuts, r.defects,
              r.hole_pixels, with_time("%.2f%%", 100 * r.backs.value, r.backs.time).c_str(), 100 * r.sound_backs.value,
              with_time("%.0f", r.flicker.value, r.flicker.time).c_str(),
              with_time("%.3f", r.opening.value, r.opening.time).c_str(),
              with_time("%.3f", r.motion.value, r.motion.time).c_str(), complaint.empty() ? "ok" : complaint.c_str());
  std::fflush(stdout);
  return complaint.empty();
}

}  // namespace

int main(int argc, char** argv) {
  frames::Options options;
  int next = 1;
  while (next + 1 < argc && std::strncmp(argv[next], "--", 2) == 0) {
    if (!read_option(argv[next], argv[next + 1], options.surface)) break;
    next += 2;
  }
  if (next >= argc || argv[next][0] == '-') {
    std::fputs(kUsage, stderr);
    return 2;
  }
  try {
    std::printf("%-16s %6s %5s %7s %6s %16s %7s %12s %14s %14s\n", "scene", "frames", "cuts", "defects", "holes",
                "backs at s", "sound", "flicker at s", "opening at s", "motion at s");
    bool all_good = true;
    for (; next < argc; ++next) all_good = watch_scene(argv[next], options) && all_good;
    return all_good ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "frame_check: %s\n", error.what());
    return 2;
  }
}
