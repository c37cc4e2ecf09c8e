#include <unistd.h>

#include <cstdio>
#include <iostream>

#include "commands.hpp"
#include "crumble/base/file.hpp"
#include "device_check.hpp"
#include "output.hpp"

namespace crumble::app {
namespace {

struct CheckOptions {
  CheckSettings settings;
  bool yes = false, json = false;
  std::string report;
};

// Nobody gets a force that did not say so: by --yes, or at a terminal.
void ask_for_consent(const CheckOptions& options) {
  if (!options.settings.push || options.yes) return;
  if (!isatty(STDIN_FILENO)) {
    throw Error(Code::state, "--push needs somebody who agrees: answer at a terminal, or give --yes");
  }
  std::printf("The device will push upwards with up to %g N. Is somebody holding it, and may it? Type yes: ",
              options.settings.force);
  std::fflush(stdout);
  std::string answer;
  std::getline(std::cin, answer);
  if (answer != "yes") throw Error(Code::state, "--push: the answer was '" + answer + "', not 'yes'");
}

// Exit code 1 when the check ended early.
void check_device(const CheckOptions& options) {
  check(options.settings);
  if (!options.report.empty()) require_extension(options.report, ".json");
  ask_for_consent(options);
  CheckResult result;
  run_check(
      options.settings, [](const std::string& text) { std::fprintf(stderr, "%s\n", text.c_str()); }, result);
  if (!options.report.empty()) write_text(options.report, to_json(result));
  std::fputs((options.json ? to_json(result) : to_report(result)).c_str(), stdout);
  if (!result.stopped.empty()) throw Error(Code::device_lost, "the check ended early: " + result.stopped);
}

}  // namespace

void add_device_check(CLI::App& app) {
  auto* command =
      app.add_subcommand("device-check", "Try a device: identity, rate, calibration, noise, push, unplugging");
  auto options = std::make_shared<CheckOptions>();
  CheckSettings& settings = options->settings;
  command->add_option("--device", settings.device.name, kDeviceHelp)->capture_default_str();
  command->add_option("--library", settings.device.library, "HDAPI, for phantom; else where its installer puts it");
  command->add_option("--seconds", settings.seconds, "Time to hold it still")->capture_default_str();
  command->add_flag("--push", settings.push, "Let it push; asks first");
  command->add_option("--force", settings.force, "How much, N")->capture_default_str();
  command->add_flag("--yes", options->yes, "Whoever holds the device has agreed to --push");
  command->add_flag("--unplug", settings.unplug, "See what happens when the plug is pulled");
  command->add_option("--wait", settings.unplug_seconds, "Time for that, and for a calibration, s")
      ->capture_default_str();
  command->add_option("--report", options->report, "File for the result, .json: to send in, please");
  command->add_flag("--json", options->json, "Print one JSON object instead of the report");
  command->callback([options] {
    options->settings.calibration_seconds = options->settings.unplug_seconds;
    check_device(*options);
  });
}

}  // namespace crumble::app
