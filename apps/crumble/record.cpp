#include <cstdio>

#include "commands.hpp"
#include "crumble/base/text.hpp"
#include "crumble/device/recorder.hpp"
#include "named_device.hpp"
#include "output.hpp"
#include "serve.hpp"

namespace crumble::app {
namespace {

constexpr double kMostSeconds = 3600;

struct RecordOptions {
  DeviceChoice device{.name = "phantom"};
  std::optional<double> seconds;
  std::string out;
};

double seconds_of(const RecordOptions& options, const NamedDevice& open) {
  if (!options.seconds && !open.seconds) {
    throw Error(Code::empty, "--device '" + options.device.name + "' has no end of its own: give --seconds");
  }
  return options.seconds.value_or(open.seconds.value_or(0));
}

void record(const RecordOptions& options) {
  require_extension(options.out, ".ctraj");
  check(options.device);
  if (options.seconds) {
    require_positive("--seconds", *options.seconds);
    require_in_range("--seconds", *options.seconds, 0, kMostSeconds);
  }
  NamedDevice open = open_named(options.device);
  const double seconds = seconds_of(options, open);
  const double rate = std::max(open.device->info().rate, options.device.rate);
  const auto wanted = static_cast<std::size_t>(seconds * rate + 0.5);
  // A driver that ticks a little faster than it says shall not lose the end
  Recorder recorder(std::move(open.device), wanted + wanted / 10 + 1);
  std::optional<double> begin;
  const bool locked = recorder.info().step_locked;
  const ReadStatus status = serve(recorder, options.device.rate, locked ? kMostSeconds : seconds,
                                  [&](ReadStatus read, const DeviceSample& sample) -> std::optional<Vec3> {
                                    if (read == ReadStatus::finished) return std::nullopt;
                                    if (read == ReadStatus::ok && !begin) begin = sample.time;
                                    const bool over = locked && begin && sample.time - *begin >= seconds;
                                    return over ? std::nullopt : std::optional<Vec3>(Vec3::Zero());
                                  });
  if (recorder.size() == 0) {
    throw Error(Code::device_lost, "nothing was recorded: " + std::string(recorder.error_text()));
  }
  write_trajectory(options.out, recorder.trajectory());
  std::printf("%s: %zu samples in %s, %zu dropped\n", recorder.info().name.c_str(), recorder.size(),
              options.out.c_str(), recorder.dropped());
  if (status == ReadStatus::lost)
    throw Error(Code::device_lost, "then it was lost: " + std::string(recorder.error_text()));
}

}  // namespace

void add_record(CLI::App& app) {
  auto* command = app.add_subcommand("record", "Record how a device is moved, without a body or a force");
  auto options = std::make_shared<RecordOptions>();
  command->add_option("out", options->out, "File to write, .ctraj")->required();
  command->add_option("--device", options->device.name, kDeviceHelp)->capture_default_str();
  command->add_option("--library", options->device.library, "HDAPI, for phantom; else where its installer puts it");
  command->add_option("--rate", options->device.rate, "Samples a second")->capture_default_str();
  command->add_option("--seconds", options->seconds, "Time; else until the device's motion is over, or interrupted");
  command->callback([options] { record(*options); });
}

}  // namespace crumble::app
