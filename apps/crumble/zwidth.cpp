#include <unistd.h>

#include <cstdio>
#include <optional>

#include "commands.hpp"
#include "crumble/base/file.hpp"
#include "output_folder.hpp"
#include "zwidth_plots.hpp"
#include "zwidth_report.hpp"

namespace crumble::app {
namespace {

struct ZWidthOptions {
  std::string out;
  bool json = false, quick = false;
};

void show_progress(double share) {
  if (isatty(STDERR_FILENO)) std::fprintf(stderr, "\r%3.0f %%", 100 * share);
}

void zwidth(const ZWidthOptions& options) {
  std::optional<OutputFolder> folder;
  if (!options.out.empty()) folder.emplace(options.out);
  const ZWidth zwidth = measure_zwidth(options.quick, show_progress);
  if (isatty(STDERR_FILENO)) std::fprintf(stderr, "\r      \r");
  const std::string json = to_json(zwidth);
  if (folder) {
    const std::filesystem::path& place = folder->temporary();
    write_text(place / "zwidth.json", json);
    write_text(place / "combinations.csv", combination_table(zwidth));
    write_maps(zwidth.body,
               {"A hand that presses into a body: where the loop stays quiet", "springs of the body (N/m)"},
               place / "zwidth.svg");
    write_maps(zwidth.coupling,
               {"How stiff the virtual coupling may be, in a body with springs of 100 N/m", "virtual coupling (N/m)"},
               place / "coupling.svg");
    folder->commit();
  }
  std::fputs((options.json ? json : to_report(zwidth)).c_str(), stdout);
}

}  // namespace

void add_zwidth(CLI::App& app) {
  auto* command = app.add_subcommand("zwidth", "Press with a simulated hand in the loop and show where it is stable");
  auto options = std::make_shared<ZWidthOptions>();
  command->add_option("--out", options->out, "Folder for zwidth.json, combinations.csv, zwidth.svg, coupling.svg");
  command->add_flag("--json", options->json, "Print one JSON object instead of the report");
  command->add_flag("--quick", options->quick, "A sample of everything, in some seconds");
  command->callback([options] { zwidth(*options); });
}

}  // namespace crumble::app
