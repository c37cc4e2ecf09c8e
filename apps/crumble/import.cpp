#include <cstdio>

#include "commands.hpp"
#include "crumble/device/hapi_log.hpp"
#include "output.hpp"

namespace crumble::app {
namespace {

struct ImportOptions {
  std::string log, out;
  HapiLogOptions hapi;
  bool refuse_repeated = false;
};

void import_log(const ImportOptions& options) {
  require_extension(options.out, ".ctraj");
  HapiLogOptions hapi = options.hapi;
  hapi.drop_repeated = !options.refuse_repeated;
  const Trajectory trajectory = read_hapi_log(options.log, hapi);
  write_trajectory(options.out, trajectory);
  std::printf("%zu samples over %g s in %s\n", trajectory.rows.size(),
              trajectory.rows.back().time - trajectory.rows.front().time, options.out.c_str());
}

}  // namespace

void add_import(CLI::App& app) {
  auto* command = app.add_subcommand("import", "Make a trajectory of a log that HAPI's DeviceLog wrote");
  auto options = std::make_shared<ImportOptions>();
  command->add_option("log", options->log, "A log as text")->required();
  command->add_option("out", options->out, "File to write, .ctraj")->required();
  command->add_option("--length-unit", options->hapi.length_unit, "Of the log, m")->capture_default_str();
  command->add_flag("--refuse-repeated", options->refuse_repeated, "Refuse rows with the time of the row before");
  command->callback([options] { import_log(*options); });
}

}  // namespace crumble::app
