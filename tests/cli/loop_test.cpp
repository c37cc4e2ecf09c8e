// `crumble loop`: what it reports, writes and refuses. No test looks at how punctual the thread was: machines are busy.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/command.hpp"
#include "crumble/base/file.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/device/trajectory.hpp"
#include "render/temporary_folder.hpp"

namespace crumble::cli {
namespace {

using nlohmann::json;
using render::TemporaryFolder;
using Arguments = Vector<std::string>;

Outcome loop(Arguments arguments) {
  arguments.insert(arguments.begin(), {"loop", "tofu_cube"});
  return crumble(arguments);
}

json loop_json(Arguments arguments) {
  arguments.push_back("--json");
  const Outcome outcome = loop(arguments);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  return json::parse(outcome.out);
}

void expect_times(const json& times, std::uint64_t count) {
  EXPECT_EQ(times.at("count"), count);
  double last = 0;
  for (const char* key : {"p50", "p99", "p99_9", "max"}) {
    EXPECT_GE(times.at(key).get<double>(), last) << key;
    last = times.at(key);
  }
  EXPECT_GT(last, 0);
}

TEST(LoopCommand, RunsWithEachCoupling) {
  for (const Arguments& how : {Arguments{"--coupling", "direct"},
                               {"--coupling", "local_model", "--body-ticks", "3"},
                               {"--coupling", "local_model", "--body-ticks", "3", "--body-thread"},
                               {"--coupling", "paper", "--body-ticks", "3"}}) {
    SCOPED_TRACE(how.back());
    Arguments arguments{"--seconds", "0.5"};
    arguments.insert(arguments.end(), how.begin(), how.end());
    const json run = loop_json(arguments);
    EXPECT_EQ(run.at("scene"), "tofu_cube");
    EXPECT_EQ(run.at("device"), "simulated hand");
    EXPECT_EQ(run.at("coupling"), how[1]);
    EXPECT_FALSE(run.at("scheduling").get<std::string>().empty());
    const auto ticks = run.at("ticks").get<std::uint64_t>();
    EXPECT_GE(ticks, 500u);
    EXPECT_GT(run.at("body_steps"), 0);
    EXPECT_LE(run.at("body_steps"), ticks);
    expect_times(run.at("tick_wall_us"), ticks);
    expect_times(run.at("tick_cpu_us"), ticks);
    EXPECT_EQ(run.at("lateness_us").at("count"), ticks);
    EXPECT_EQ(run.at("peak_force_n"), 0) << "it does not touch anything before 0.8 s";
    EXPECT_GT(run.at("samples"), 0);
    EXPECT_LE(run.at("samples"), ticks);
  }
}

// In ticks everything repeats, however late they were, as long as the body is stepped in them.
TEST(LoopCommand, TheHandPressesAndIsPressedBack) {
  const TemporaryFolder folder;
  const std::string record = folder.file("hand.ctraj").string();
  const std::filesystem::path out = folder.file("out");
  const json run = loop_json({"--record", record, "--out", out.string()});
  EXPECT_GE(run.at("ticks"), 5000);
  EXPECT_EQ(run.at("body_steps"), run.at("ticks"));
  EXPECT_GT(run.at("energy").at("absorbed_j"), 0);

  const Trajectory trajectory = read_trajectory(record);
  EXPECT_GE(trajectory.rows.size(), 4000u);
  double peak = 0, lowest = 0;
  for (const TrajectoryRow& row : trajectory.rows) {
    peak = std::max(peak, norm(row.force));
    lowest = std::min(lowest, row.pose.position.y());
  }
  EXPECT_GT(peak, 0.1);
  EXPECT_LT(lowest, -1e-3) << "the origin lies where the tool starts, touching";

  std::istringstream table(read_text(out / "loop.csv"));
  std::string line;
  std::getline(table, line);
  EXPECT_EQ(line, "time_s,x_m,y_m,z_m,qx,qy,qz,qw,fx_n,fy_n,fz_n,tool_x_m,tool_y_m,tool_z_m,contacts,cuts,state");
  std::size_t rows = 0;
  for (; std::getline(table, line); ++rows) EXPECT_EQ(std::ranges::count(line, ','), 16) << line;
  EXPECT_EQ(run.at("samples"), rows);
  EXPECT_NE(read_text(out / "loop.svg").find("<svg"), std::string::npos);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(out), {}), 2);

  // and what was recorded can be played
  const json again = loop_json({"--device", "replay:" + record, "--seconds", "0.2"});
  EXPECT_NE(again.at("device").get<std::string>().find("replay"), std::string::npos);
}

TEST(LoopCommand, AnEncoderTellsWholeSteps) {
  const TemporaryFolder folder;
  const std::string record = folder.file("hand.ctraj").string();
  const json run = loop_json({"--encoder", "0.5", "--seconds", "1.5", "--record", record});
  EXPECT_EQ(run.at("encoder_step_m"), 5e-4);
  double lowest = 1;
  for (const TrajectoryRow& row : read_trajectory(record).rows) {
    const double steps = row.pose.position.y() / 5e-4;
    EXPECT_NEAR(steps, std::round(steps), 1e-9);
    lowest = std::min(lowest, steps);
  }
  EXPECT_LE(lowest, -2) << "it moved";
}

TEST(LoopCommand, PlaysAPressAndTheReportSaysTheSame) {
  const Outcome outcome = loop({"--device", "press:20", "--rate", "500", "--seconds", "0.3", "--controller"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  for (const char* part : {"tofu_cube, scripted path", "thread", "deadlines missed", "tick, wall", "lateness",
                           "stepped in the tick", "energy", "safety", "state", "by the controller"}) {
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part << " is not in: " << outcome.out;
  }
}

TEST(LoopCommand, WarnsWithoutTheCoupling) {
  const json run = loop_json({"--no-virtual-coupling", "--no-damping", "--seconds", "0.1"});
  EXPECT_FALSE(run.at("virtual_coupling").get<bool>());
  EXPECT_FALSE(run.at("inject_damping").get<bool>());
  ASSERT_EQ(run.at("warnings").size(), 1u);
  EXPECT_NE(run.at("warnings")[0].get<std::string>().find("virtual coupling"), std::string::npos);
}

TEST(LoopCommand, OtherToolsStayWhereTheyStart) {
  const Outcome outcome = crumble({"loop", "tofu_two_tools", "--seconds", "0.1", "--json"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(json::parse(outcome.out).at("fault"), "none");
}

TEST(LoopCommand, RefusesWhatItCannotDoAndNamesIt) {
  const TemporaryFolder folder;
  const std::string out = folder.file("out").string();
  const struct {
    Arguments arguments, message;
  } refusals[] = {
      {{"--device", "mouse"}, {"--device 'mouse'", "hand, press:MM_PER_S", "replay:FILE, phantom"}},
      {{"--device", "press:0"}, {"--device press:MM_PER_S must be positive, is 0"}},
      {{"--device", "press:fast"}, {"--device 'press:fast'"}},
      {{"--device", "press:0.001"}, {"--device 'press:0.001'", "--seconds"}},
      {{"--device", "replay:no_such.ctraj"}, {"'no_such.ctraj'"}},
      {{"--coupling", "loose"}, {"--coupling 'loose'", "direct local_model paper"}},
      {{"--body-ticks", "3"}, {"--body-ticks 3", "local_model or paper"}},
      {{"--body-ticks", "0", "--coupling", "paper"}, {"--body-ticks must lie in [1, 100], is 0"}},
      {{"--body-ticks", "-1", "--coupling", "paper"}, {"--body-ticks must lie in [1, 100], is -1"}},
      {{"--body-ticks", "11", "--coupling", "paper"}, {"--body-ticks 11", "--rate 1000", "0.011"}},
      {{"--body-thread"}, {"--body-thread", "local_model or paper"}},
      {{"--rate", "99"}, {"--rate must lie in [100, 10000], is 99"}},
      {{"--rate", "20000"}, {"--rate must lie in [100, 10000], is 20000"}},
      {{"--rate", "nan"}, {"--rate must be finite, is nan"}},
      {{"--seconds", "0"}, {"--seconds must be positive, is 0"}},
      {{"--seconds", "1e9"}, {"--seconds must lie in [0, 600]", "1e+09"}},
      {{"--encoder", "-1"}, {"--encoder must be positive, is -1"}},
      {{"--encoder", "1", "--device", "press:1"}, {"--encoder needs --device hand", "'press:1'"}},
      {{"--record", "motion.csv"}, {"--record 'motion.csv' must end in .ctraj"}},
  };
  for (const auto& [arguments, message] : refusals) {
    SCOPED_TRACE(arguments.back());
    Arguments all = arguments;
    all.insert(all.end(), {"--out", out});
    const Outcome outcome = loop(all);
    EXPECT_EQ(outcome.code, 1);
    EXPECT_EQ(outcome.out, "");
    for (const std::string& part : message) {
      EXPECT_NE(outcome.err.find(part), std::string::npos) << "'" << part << "' is not in: " << outcome.err;
    }
  }
  EXPECT_EQ(crumble({"loop", "tofu_pyramid", "--out", out}).code, 1);
  EXPECT_EQ(folder.size(), 0u);
}

}  // namespace
}  // namespace crumble::cli
