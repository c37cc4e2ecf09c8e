// libFuzzer's entry to the parsers of motion files; scripts/fuzz builds and runs it. Whatever the bytes: an Error that
// says where, or a trajectory that is valid, comes back from its own text and can be played.
#include <cstdlib>
#include <iostream>

#include "crumble/base/error.hpp"
#include "crumble/device/hapi_log.hpp"
#include "crumble/device/replay.hpp"

namespace {

using namespace crumble;

void require(bool holds, const std::string& what) {
  if (holds) return;
  std::cerr << "broken: " << what << '\n';
  std::abort();
}

void require_told(const Error& error) {
  const std::string what = error.what();
  require(error.code() != Code{} && what.starts_with("fuzz") && what.size() < 300, what);
  require(what == "fuzz is empty" || what.starts_with("fuzz: line "), what);
}

void play(const Trajectory& trajectory) {
  for (const ReplayClock clock : {ReplayClock::step_locked, ReplayClock::fast}) {
    std::unique_ptr<Device> device;
    try {
      device = open_replay(trajectory, {.clock = clock}, 1e-3);
    } catch (const Error& error) {
      require(error.code() != Code{}, error.what());
      continue;
    }
    for (int k = 0; k < 20; ++k) {
      DeviceSample sample;
      static_cast<void>(device->read(sample));
      require(is_valid(sample.pose), "pose of a replay");
      require(is_finite(sample.linear_velocity) && is_finite(sample.angular_velocity), "velocities of a replay");
    }
  }
}

void check(std::string_view text, Trajectory (*parse)(std::string_view)) {
  Trajectory trajectory;
  try {
    trajectory = parse(text);
  } catch (const Error& error) {
    return require_told(error);
  }
  validate(trajectory);
  const std::string written = format_trajectory(trajectory);
  require(format_trajectory(parse_trajectory(written, "written")) == written, written);
  play(trajectory);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  check(text, [](std::string_view t) { return parse_trajectory(t, "fuzz"); });
  check(text, [](std::string_view t) { return parse_hapi_log(t, "fuzz"); });
  return 0;
}
