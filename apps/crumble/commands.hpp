// The subcommands; each adds itself to the command line and throws crumble::Error when it cannot do its work.
#pragma once

#include <CLI/CLI.hpp>

namespace crumble::app {

void add_run(CLI::App& app);
void add_mesh(CLI::App& app);
void add_replay(CLI::App& app);
void add_export(CLI::App& app);
void add_bench(CLI::App& app);
void add_patterns(CLI::App& app);
void add_loop(CLI::App& app);
void add_zwidth(CLI::App& app);
void add_devices(CLI::App& app);
void add_device_check(CLI::App& app);
void add_record(CLI::App& app);
void add_import(CLI::App& app);

}  // namespace crumble::app
