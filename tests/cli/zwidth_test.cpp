// `crumble zwidth`: what it counts and writes. The presses are simulated, so nothing here depends on the machine.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "crumble/base/file.hpp"
#include "render/temporary_folder.hpp"

namespace crumble::cli {
namespace {

using nlohmann::json;
using render::TemporaryFolder;

// One run for all questions: it takes some seconds.
struct QuickRun {
  QuickRun() {
    const TemporaryFolder folder;
    const std::filesystem::path out = folder.file("out");
    const Outcome outcome = crumble({"zwidth", "--quick", "--json", "--out", out.string()});
    code = outcome.code, err = outcome.err, printed = outcome.out;
    if (code != 0) return;
    files = static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(out), {}));
    written = read_text(out / "zwidth.json"), table = read_text(out / "combinations.csv");
    maps = read_text(out / "zwidth.svg"), coupling = read_text(out / "coupling.svg");
  }
  int code = -1;
  std::size_t files = 0;
  std::string err, printed, written, table, maps, coupling;
};

const QuickRun& quick_run() {
  static const QuickRun run;
  return run;
}

json quick_json() {
  EXPECT_EQ(quick_run().code, 0) << quick_run().err;
  return json::parse(quick_run().printed);
}

json setup_of(const json& all, const std::string& name) {
  for (const json& setup : all.at("setups")) {
    if (setup.at("setup") == name) return setup;
  }
  ADD_FAILURE() << "no setup " << name;
  return {};
}

std::ptrdiff_t passing(const json& presses) {
  return std::ranges::count_if(presses, [](const json& p) { return p.at("passes").get<bool>(); });
}

void counts_what_it_lists() {
  const json all = quick_json();
  EXPECT_TRUE(all.at("quick").get<bool>());
  ASSERT_EQ(all.at("setups").size(), 9u);
  for (const json& setup : all.at("setups")) {
    SCOPED_TRACE(setup.at("setup"));
    const json& combinations = setup.at("combinations");
    EXPECT_EQ(setup.at("of"), combinations.size());
    EXPECT_EQ(combinations.size(), 6u);
    EXPECT_EQ(setup.at("passed"), passing(combinations));
    double least = 0;
    for (const json& p : combinations) {
      EXPECT_EQ(p.at("why").get<std::string>().empty(), p.at("passes").get<bool>()) << p;
      least = std::min(least, p.at("least_energy_j").get<double>());
    }
    EXPECT_EQ(setup.at("least_energy_j"), least);
  }
}

void default_passes_and_bare_does_not() {
  const json all = quick_json();
  for (const char* name : {"default", "default + encoder", "default + encoder + lateral", "local model"}) {
    EXPECT_EQ(setup_of(all, name).at("passed"), 6) << name;
  }
  for (const char* name : {"bare", "paper"}) {
    const json setup = setup_of(all, name);
    EXPECT_LT(setup.at("passed"), 5) << name;
    EXPECT_LT(setup.at("least_energy_j"), -1e-3) << name << ": the hand was shaken";
  }
}

void cells_of_the_maps_agree_with_their_edges() {
  const json all = quick_json();
  EXPECT_EQ(all.at("body_maps").size(), 8u);
  EXPECT_EQ(all.at("coupling_maps").size(), 4u);
  for (const char* key : {"body_maps", "coupling_maps"}) {
    for (const json& map : all.at(key)) {
      SCOPED_TRACE(map.at("title"));
      const json &cells = map.at("cells"), &stiffnesses = map.at("stiffnesses_n_m"), &rates = map.at("rates_hz");
      ASSERT_EQ(cells.size(), stiffnesses.size() * rates.size());
      for (std::size_t r = 0; r < rates.size(); ++r) {
        std::size_t k = 0;
        double largest = 0;
        for (; k < stiffnesses.size() && cells[k * rates.size() + r].at("passes").get<bool>(); ++k) {
          largest = stiffnesses[k];
        }
        EXPECT_EQ(map.at("largest_stable_n_m")[r], largest);
        EXPECT_NEAR(cells[r].at("tick_s").get<double>() * rates[r].get<double>(), 1, 1e-12);
      }
      EXPECT_EQ(map.contains("chosen_n_m"), map.at("cells")[0].at("coupling_stiffness_n_m") > 0);
    }
  }
}

void within_the_limits_is_what_passes() {
  for (const json& map : quick_json().at("body_maps")) {
    for (const json& p : map.at("cells")) {
      const bool quiet = p.at("hold_cuts") == 0 && p.at("fault") == "none";
      EXPECT_EQ(p.at("passes").get<bool>(), quiet && p.at("excess") <= 1) << p;
    }
  }
}

void writes_the_same_into_files() {
  const QuickRun& run = quick_run();
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(run.files, 4u);
  EXPECT_EQ(run.written, run.printed);
  EXPECT_EQ(std::ranges::count(run.table, '\n'), 1 + 9 * 6);
  EXPECT_EQ(run.table.substr(0, 11), "setup,grip,");
  for (const std::string* svg : {&run.maps, &run.coupling}) {
    EXPECT_NE(svg->find("<svg"), std::string::npos);
    EXPECT_NE(svg->find("default + encoder, held loosely"), std::string::npos);
    EXPECT_NE(svg->find("rate of the servo (Hz)"), std::string::npos);
  }
  EXPECT_EQ(run.err, "") << "progress is for terminals";
}

// One test, since each runs in a process of its own and would press again.
TEST(ZWidth, AQuickRunIsWhatItSays) {
  counts_what_it_lists();
  default_passes_and_bare_does_not();
  cells_of_the_maps_agree_with_their_edges();
  within_the_limits_is_what_passes();
  writes_the_same_into_files();
}

TEST(ZWidth, RefusesAPlaceThatCannotBeWrittenBeforeItStarts) {
  const TemporaryFolder folder;
  const std::string file = folder.file("file").string();
  write_text(file, "a file");
  const Outcome outcome = crumble({"zwidth", "--out", file});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(outcome.out, "");
  EXPECT_NE(outcome.err.find("--out '" + file + "'"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace crumble::cli
