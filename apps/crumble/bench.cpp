#include <unistd.h>

#include <cstdio>

#include "commands.hpp"
#include "crumble/base/file.hpp"
#include "crumble/base/memory.hpp"
#include "runner/choice.hpp"
#include "runner/report.hpp"

namespace crumble::app {
namespace {

struct BenchOptions {
  Vector<std::size_t> springs{4000, 8000, 100'000};
  Vector<std::string> structures{"default"}, sticks{"paper"}, precisions{"float32"}, kernels{""};
  Vector<std::uint32_t> threads{1};
  std::size_t steps = 2000;
  Vector<std::string> compare;
  std::string out;
  bool json = false, list_kernels = false;
};

// All that can be wrong, before the first body is made.
void check(const BenchOptions& options) {
  for (const auto n : options.springs) {
    require_in_range("--springs", static_cast<double>(n), bench::kLeastSprings, bench::kMostSprings);
  }
  for (const auto& name : options.structures) bench::require_choice("--structure", name, bench::structure_names());
  for (const auto& name : options.sticks) bench::require_choice("--stick", name, bench::stick_names());
  for (const auto& name : options.precisions) bench::parse_precision(name);
  for (const auto& name : options.kernels) {
    if (!name.empty()) bench::require_choice("--kernel", name, kernel_names());
  }
  for (const auto n : options.threads) require_in_range("--threads", n, 1, bench::kMostThreads);
  require_in_range("--steps", static_cast<double>(options.steps), 1, bench::kMostSteps);
}

void measure_settings(const BenchOptions& options, const bench::BenchBody& body, Vector<bench::Row>& rows) {
  for (const std::string& precision : options.precisions) {
    for (const std::string& kernel : options.kernels) {
      for (const std::uint32_t threads : options.threads) {
        if (isatty(STDERR_FILENO)) {
          std::fprintf(stderr, "\r%zu springs, %s, %s, %u threads ... ", body.wanted_springs, body.structure.c_str(),
                       precision.c_str(), threads);
        }
        rows.push_back(bench::measure(body, {precision, kernel, threads, options.steps}));
      }
    }
  }
}

Vector<bench::Row> measure_all(const BenchOptions& options) {
  Vector<bench::Row> rows;
  for (const std::size_t springs : options.springs) {
    for (const std::string& structure : options.structures) {
      for (const std::string& stick : options.sticks) {
        measure_settings(options, bench::make_body(springs, structure, stick), rows);
      }
    }
  }
  if (isatty(STDERR_FILENO)) std::fputs("\n", stderr);
  return rows;
}

std::string compare(const Vector<std::string>& files) {
  if (files.size() == 1) return bench::to_table(read_text(files[0]), files[0]);
  return bench::compare(files[0], files[1]);
}

void bench_command(const BenchOptions& options) {
  if (options.list_kernels) {
    for (const std::string& name : kernel_names()) std::puts(name.c_str());
    return;
  }
  if (!options.compare.empty()) {
    std::fputs(compare(options.compare).c_str(), stdout);
    return;
  }
  check(options);
  const std::string json = bench::to_json(measure_all(options));
  if (!options.out.empty()) write_text(options.out, json);
  std::fputs((options.json ? json : bench::to_table(json, "results")).c_str(), stdout);
}

}  // namespace

void add_bench(CLI::App& app) {
  auto* command = app.add_subcommand("bench", "Time the network beside its baselines, and whole steps; microseconds");
  auto options = std::make_shared<BenchOptions>();
  command->add_option("--springs", options->springs, "How many springs, about; one or more")->capture_default_str();
  command->add_option("--structure", options->structures, "lattice, default, shuffled")->capture_default_str();
  command->add_option("--stick", options->sticks, "paper, scaled")->capture_default_str();
  command->add_option("--precision", options->precisions, "float32, float64")->capture_default_str();
  command->add_option("--kernel", options->kernels, "See --list-kernels; else the fastest");
  command->add_option("--threads", options->threads, "1 to 64")->capture_default_str();
  command->add_option("--steps", options->steps, "Steps timed")->capture_default_str();
  command->add_option("--out", options->out, "File for the results, JSON");
  command->add_flag("--json", options->json, "Print the JSON instead of the table");
  command->add_option("--compare", options->compare, "Print a table of results: A.json, or A.json B.json")
      ->expected(1, 2);
  command->add_flag("--list-kernels", options->list_kernels, "Print the kernels of this build and processor");
  command->callback([options] { bench_command(*options); });
}

}  // namespace crumble::app
