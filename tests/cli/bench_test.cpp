// `crumble bench`: what it reports and refuses. No test looks at how long anything took.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/command.hpp"
#include "crumble/base/file.hpp"
#include "crumble/base/memory.hpp"
#include "render/temporary_folder.hpp"

namespace crumble::cli {
namespace {

using nlohmann::json;
using render::TemporaryFolder;

json rows_of(Vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "bench");
  arguments.push_back("--json");
  const Outcome outcome = crumble(arguments);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  return json::parse(outcome.out).at("rows");
}

Vector<std::string> kernels() {
  std::istringstream lines(crumble({"bench", "--list-kernels"}).out);
  Vector<std::string> names;
  for (std::string name; std::getline(lines, name);) names.push_back(name);
  return names;
}

void expect_ascending(const json& percentiles) {
  double last = 0;
  for (const char* key : {"p50", "p99", "p99_9", "max"}) {
    EXPECT_GE(percentiles.at(key).get<double>(), last) << key;
    last = percentiles.at(key);
  }
  EXPECT_GT(last, 0);
}

TEST(Bench, ReportsTheNetworkItsBaselinesAndTheStep) {
  const json rows = rows_of({"--springs", "4000", "--steps", "50"});
  ASSERT_EQ(rows.size(), 1u);
  const json& row = rows[0];
  EXPECT_EQ(row.at("nodes"), 600) << "the paper's cube";
  EXPECT_EQ(row.at("structure"), "default");
  EXPECT_EQ(row.at("precision"), "float32");
  EXPECT_EQ(row.at("kernel"), kernels().back()) << "the fastest";
  EXPECT_EQ(row.at("threads"), 1);
  for (const char* key : {"network_us", "network_wall_us", "plain_us", "ratio", "step_ratio"}) {
    EXPECT_GT(row.at(key).get<double>(), 0) << key;
  }
  for (const char* key : {"step_us", "step_raw_us", "step_wall_us", "control_raw_us", "control_wall_us"})
    expect_ascending(row.at(key));
  EXPECT_GT(row.at("stages_us").at("solve_network").get<double>(), 0);
  const json& bullet = row.at("bullet_us");
  EXPECT_TRUE(bullet.is_number() ? bullet.get<double>() > 0 : bullet == "not installed") << bullet;
  EXPECT_GT(row.at("contacts"), 0) << "the stick is in the body";
  EXPECT_GT(row.at("cuts_before").get<int>() + row.at("cuts").get<int>(), 0);
  EXPECT_EQ(row.at("hash").get<std::string>().size(), 16u);
  EXPECT_GT(row.at("layout").at("lane_use"), 0);
  EXPECT_LE(row.at("layout").at("lane_use"), 1);
}

// The plain loop is the same network, written independently.
TEST(Bench, ComparesLikeWithLike) {
  for (const json& row : rows_of({"--springs", "4000", "--steps", "5", "--structure", "lattice", "default", "shuffled",
                                  "--precision", "float32", "float64"})) {
    SCOPED_TRACE(row.dump());
    const double difference = row.at("difference_from_plain_m"), spacing = 0.0044;
    EXPECT_LT(difference, (row.at("precision") == "float64" ? 1e-11 : 1e-5) * spacing);
    EXPECT_EQ(row.contains("plain_shuffled_us"), row.at("structure") == "shuffled");
    if (row.at("structure") == "shuffled") {
      EXPECT_TRUE(row.at("layout").at("sorted").get<bool>());
    }
    EXPECT_NEAR(row.at("springs").get<double>(), 4000, row.at("structure") == "lattice" ? 400 : 600);
  }
}

void expect_one_hash(const json& rows) {
  EXPECT_GT(rows[0].at("cuts_before").get<int>() + rows[0].at("cuts").get<int>(), 0);
  for (const json& row : rows) EXPECT_EQ(row.at("hash"), rows[0].at("hash")) << row.dump();
}

TEST(Bench, EveryKernelGivesTheSameBits) {
  ASSERT_GE(kernels().size(), 2u) << "a vector kernel beside the scalar one";
  for (const char* precision : {"float32", "float64"}) {
    Vector<std::string> arguments{"--springs", "4000", "--steps", "50", "--precision", precision, "--kernel"};
    for (const std::string& name : kernels()) arguments.push_back(name);
    const json rows = rows_of(arguments);
    ASSERT_EQ(rows.size(), kernels().size());
    expect_one_hash(rows);
  }
}

TEST(Bench, AnyNumberOfThreadsGivesTheSameBits) {
  const json rows = rows_of({"--springs", "60000", "--structure", "lattice", "--steps", "20", "--threads", "1", "2",
                             "--kernel", "scalar", kernels().back()});
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_GT(rows[0].at("layout").at("partitions"), 1) << "or threads have nothing to share";
  expect_one_hash(rows);
}

TEST(Bench, ListsItsKernelsScalarFirst) {
  ASSERT_FALSE(kernels().empty());
  EXPECT_EQ(kernels().front(), "scalar");
}

TEST(Bench, ComparesResultsThatItKept) {
  const TemporaryFolder folder;
  const std::string a = folder.file("a.json").string(), b = folder.file("b.json").string();
  for (const std::string& file : {a, b}) {
    const Outcome outcome = crumble({"bench", "--springs", "4000", "--steps", "5", "--out", file});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("float32"), std::string::npos);
    EXPECT_EQ(crumble({"bench", "--compare", file}).out, outcome.out) << "the table that was printed";
  }
  const Outcome both = crumble({"bench", "--compare", a, b});
  EXPECT_EQ(both.code, 0) << both.err;
  EXPECT_NE(both.out.find("same"), std::string::npos) << both.out;

  json changed = json::parse(read_text(b));
  changed["rows"][0]["hash"] = "0000000000000000";
  write_text(b, changed.dump());
  EXPECT_NE(crumble({"bench", "--compare", a, b}).out.find("other bits"), std::string::npos);
  for (const char* text : {"", "no JSON", "{}", R"({"rows": 1})", "[]"}) {
    write_text(b, text);
    using Files = Vector<std::string>;
    for (const auto& files : {Files{b}, Files{a, b}, Files{b, a}}) {
      Vector<std::string> arguments{"bench", "--compare"};
      arguments.insert(arguments.end(), files.begin(), files.end());
      const Outcome outcome = crumble(arguments);
      EXPECT_EQ(outcome.code, 1);
      EXPECT_EQ(outcome.out, "");
      EXPECT_NE(outcome.err.find(b), std::string::npos) << outcome.err;
    }
  }
}

TEST(Bench, RefusesWhatItDoesNotKnowAndSaysWhatThereIs) {
  const struct {
    Vector<std::string> arguments, message;
  } refusals[] = {
      {{"--structure", "cubic"}, {"--structure 'cubic'", "lattice default shuffled"}},
      {{"--stick", "square"}, {"--stick 'square'", "paper scaled"}},
      {{"--precision", "float16"}, {"--precision 'float16'", "float32 float64"}},
      {{"--kernel", "abacus"}, {"--kernel 'abacus'", "scalar"}},
      {{"--threads", "0"}, {"--threads", "0"}},
      {{"--threads", "65"}, {"--threads", "65"}},
      {{"--threads", "-1"}, {"--threads", "-1"}},
      {{"--springs", "10"}, {"--springs", "10"}},
      {{"--springs", "100000000"}, {"--springs", "1e+08"}},
      {{"--springs", "many"}, {"--springs", "many"}},
      {{"--steps", "0"}, {"--steps", "0"}},
      {{"--compare", "no_such.json"}, {"no_such.json"}},
      {{"--out", "no_such_folder/a.json", "--springs", "4000", "--steps", "5"}, {"no_such_folder/a.json"}},
  };
  for (const auto& [arguments, message] : refusals) {
    Vector<std::string> all{"bench"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const Outcome outcome = crumble(all);
    EXPECT_GT(outcome.code, 0) << arguments[1];
    EXPECT_LT(outcome.code, 127) << "killed or not started";
    EXPECT_EQ(outcome.out, "");
    for (const std::string& part : message) {
      EXPECT_NE(outcome.err.find(part), std::string::npos) << "'" << part << "' is not in: " << outcome.err;
    }
  }
}

}  // namespace
}  // namespace crumble::cli
