#include "crumble/device/hapi_log.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>

#include "crumble/base/memory.hpp"
#include "crumble/device/replay.hpp"
#include "device/samples.hpp"

namespace crumble {
namespace {

// The example of HAPI's documentation.
const std::string kExample =
    "TIME POSITION ORIENTATION\n"
    "0 0.1 0.2 0.3 0 0 1 0.5\n"
    "0.01 0.1 0.22 0.3 0 0 1 0.51\n"
    "0.02 0.1 0.22 0.3 0 0 1 0.51\n";

TEST(HapiLog, ReadsTheExampleOfItsDocumentation) {
  const Trajectory t = parse_hapi_log(kExample, "log");
  EXPECT_EQ(t.columns, quantity::kPosition | quantity::kOrientation);
  EXPECT_EQ(t.value_of("source"), "HAPI DeviceLog");
  EXPECT_EQ(t.value_of("assumed"), "lengths in units of 1 m, times in s, angles in rad, forces in N, torques in N*m");
  EXPECT_EQ(t.value_of("repeated_rows_dropped"), "");
  ASSERT_EQ(t.rows.size(), 3u);
  EXPECT_EQ(t.rows[1].time, 0.01);
  EXPECT_EQ(t.rows[1].pose.position, Vec3(0.1, 0.22, 0.3));
  EXPECT_NEAR(t.rows[1].pose.orientation.z(), std::sin(0.255), 1e-15);
  EXPECT_NEAR(t.rows[1].pose.orientation.w(), std::cos(0.255), 1e-15);
  EXPECT_NO_THROW(open_replay(parse_trajectory(format_trajectory(t), "again"), {}, 1e-3));
}

// All that a log can hold, written as HAPI does: five decimals, and whole buttons. RAW_... and TIMESTAMP hold what
// would be seen if they were taken for something else.
TEST(HapiLog, ReadsEveryColumnInAnyOrder) {
  const Trajectory motion = random_trajectory(61, 50);
  Vector<std::pair<std::string, std::function<std::string(const TrajectoryRow&)>>> columns;
  const auto numbers = [](std::initializer_list<double> values) {
    std::string text;
    for (const double value : values) {
      char buffer[64];
      std::snprintf(buffer, sizeof buffer, "%.5f", value);
      text += (text.empty() ? "" : " ") + std::string(buffer);
    }
    return text;
  };
  const auto vector = [&](const Vec3& v) { return numbers({v.x(), v.y(), v.z()}); };
  const auto turned = [&](const Quat& q) {
    const Eigen::AngleAxisd turn(q);
    return numbers({turn.axis().x(), turn.axis().y(), turn.axis().z(), turn.angle()});
  };
  columns = {{"TIME", [&](const auto& row) { return numbers({row.time}); }},
             {"POSITION", [&](const auto& row) { return vector(1e3 * row.pose.position); }},
             {"ORIENTATION", [&](const auto& row) { return turned(row.pose.orientation); }},
             {"VELOCITY", [&](const auto& row) { return vector(1e3 * row.linear_velocity); }},
             {"FORCE", [&](const auto& row) { return vector(row.force); }},
             {"TORQUE", [&](const auto& row) { return vector(row.torque); }},
             {"BUTTONS", [&](const auto& row) { return std::to_string(static_cast<std::int32_t>(row.buttons)); }},
             {"RAW_POSITION",
              [&](const auto&) {
                return numbers({77, 77, 77});
              }},
             {"RAW_ORIENTATION",
              [&](const auto&) {
                return numbers({77, 77, 77, 77});
              }},
             {"RAW_VELOCITY",
              [&](const auto&) {
                return numbers({77, 77, 77});
              }},
             {"RAW_FORCE",
              [&](const auto&) {
                return numbers({77, 77, 77});
              }},
             {"RAW_TORQUE",
              [&](const auto&) {
                return numbers({77, 77, 77});
              }},
             {"TIMESTAMP", [&](const auto&) { return numbers({1.7e9}); }}};
  Random random(62);
  for (int order = 0; order < 20; ++order) {
    for (std::size_t i = columns.size(); i > 1; --i) std::swap(columns[i - 1], columns[random.below(i)]);
    const std::string blank = order % 2 ? " " : " \t ", newline = order % 3 ? "\n" : "\r\n";
    std::string text;
    for (const auto& [name, cells] : columns) text += (text.empty() ? "" : blank) + name;
    text += newline;
    for (const TrajectoryRow& row : motion.rows) {
      for (const auto& [name, cells] : columns) text += cells(row) + (name == columns.back().first ? newline : blank);
    }
    const Trajectory t = parse_hapi_log(text, "log", {.length_unit = 1e-3});
    EXPECT_EQ(t.columns, quantity::kAll & ~(quantity::kAngularVelocity | quantity::kFlags));
    EXPECT_EQ(t.value_of("assumed").substr(0, 25), "lengths in units of 0.001");
    ASSERT_EQ(t.rows.size(), motion.rows.size());
    for (std::size_t i = 0; i < t.rows.size(); ++i) {
      const TrajectoryRow &a = t.rows[i], &b = motion.rows[i];
      EXPECT_NEAR(a.time, b.time, 5.1e-6);
      EXPECT_LT(norm(a.pose.position - b.pose.position), 1e-8);
      EXPECT_NEAR(std::abs(a.pose.orientation.dot(b.pose.orientation)), 1, 1e-9);
      EXPECT_NEAR(a.pose.orientation.norm(), 1, 1e-15);
      EXPECT_LT(norm(a.linear_velocity - b.linear_velocity), 1e-8);
      EXPECT_LT(norm(a.force - b.force), 1e-5);
      EXPECT_LT(norm(a.torque - b.torque), 1e-5);
      EXPECT_EQ(a.buttons, b.buttons);
    }
    EXPECT_NO_THROW(validate(t));
  }
}

TEST(HapiLog, DropsRowsThatRepeatATimeWhenAllowed) {
  const std::string text = "TIME POSITION\n0 1 2 3\n0 4 5 6\n0.00001 7 8 9\n0.00001 7 8 9\n0.00001 7 8 9\n1 0 0 0\n";
  const Trajectory t = parse_hapi_log(text, "log");
  ASSERT_EQ(t.rows.size(), 3u);
  EXPECT_EQ(t.rows[0].pose.position, Vec3(1, 2, 3));  // the first of them stays
  EXPECT_EQ(t.rows[1].pose.position, Vec3(7, 8, 9));
  EXPECT_EQ(t.value_of("repeated_rows_dropped"), "3");
  const Error error = error_of([&] { parse_hapi_log(text, "log", {.drop_repeated = false}); });
  EXPECT_EQ(error.code(), Code::out_of_range);
  EXPECT_TRUE(mentions(error, "log: line 3, column 1 (TIME): must increase, is 0 after 0")) << error.what();
}

TEST(HapiLog, RefusesWhatItCannotReadWithCodeAndPlace) {
  const std::string names = "TIME POSITION\n", row = "0 1 2 3\n";
  const std::string turned = "TIME POSITION ORIENTATION\n0 1 2 3 ";
  struct Case {
    std::string text;
    Code code;
    const char* says;
  };
  const Case cases[] = {
      {"", Code::empty, "log is empty"},
      {"\n", Code::format, "line 1: column TIME is missing"},
      {"TIME\n0\n", Code::format, "line 1: column POSITION is missing"},
      {"TIME RAW_POSITION\n0 1 2 3\n", Code::format, "line 1: column POSITION is missing"},
      {"TIME POSITION SPEED\n", Code::format, "line 1, column 15: unknown column 'SPEED'"},
      {"TIME position\n", Code::format, "line 1, column 6: unknown column 'position'"},
      {"TIME POSITION  TIME\n", Code::format, "line 1, column 16: column TIME stands twice"},
      {"# crumble-traj 1\n", Code::format, "line 1, column 1: unknown column '#'"},
      {names, Code::empty, "line 2: has no row"},
      {"TIME POSITION", Code::corrupt, "line 1: is truncated"},
      {names + row + "1 1 2 3", Code::corrupt, "line 3: is truncated: it ends within a row"},
      {names + row + "1 1 2\n", Code::format, "line 3: 3 cells, the column names are 4"},
      {names + row + "1 1 2 3 4\n", Code::format, "line 3, column 9: more than the 4 cells of the column names"},
      {names + row + "\n", Code::format, "line 3: 0 cells"},
      {names + "0 1 two 3\n", Code::format, "line 2, column 5 (POSITION): 'two' is not a number"},
      {names + "0 1 2,5 3\n", Code::format, "line 2, column 5 (POSITION): '2,5' is not a number"},
      {names + "0 1 1e999 3\n", Code::format, "line 2, column 5 (POSITION): '1e999' is not a number"},
      {names + "0 1 2 nan\n", Code::invalid_value, "line 2, column 7 (POSITION): must be finite, is nan"},
      {names + "-inf 1 2 3\n", Code::invalid_value, "line 2, column 1 (TIME): must be finite, is -inf"},
      {names + row + "-1 1 2 3\n", Code::out_of_range, "line 3, column 1 (TIME): must increase, is -1 after 0"},
      {turned + "0 0 0.5 1\n", Code::bad_pose, "line 2, column 9 (ORIENTATION): the axis must have length 1"},
      {turned + "0 0 0 1\n", Code::bad_pose, "line 2, column 9 (ORIENTATION): the axis must have length 1"},
      {turned + "0 0 1 10001\n", Code::out_of_range, "line 2, column 15 (ORIENTATION): the angle must lie in"},
      {"TIME POSITION BUTTONS\n0 1 2 3 0.5\n", Code::out_of_range, "line 2, column 9 (BUTTONS): must be a whole"},
      {"TIME POSITION BUTTONS\n0 1 2 3 2147483648\n", Code::out_of_range,
       "line 2, column 9 (BUTTONS): must be a whole"},
      {"TIME POSITION RAW_FORCE\n0 1 2 3 4 x 6\n", Code::format, "line 2, column 11 (RAW_FORCE): 'x' is not a number"},
      {std::string("TIME\0POSITION\0\0........", 23), Code::unsupported, "line 1: is a binary log"},
      {names + std::string("0 1\0 2 3\n", 9), Code::format, "line 2, column 3 (POSITION): '1\\x00' is not a number"},
  };
  for (const Case& c : cases) {
    const Error error = error_of([&] { parse_hapi_log(c.text, "log"); });
    EXPECT_EQ(error.code(), c.code) << error.what() << ", not " << c.says;
    EXPECT_TRUE(mentions(error, c.says)) << error.what() << ", not " << c.says;
  }
  EXPECT_EQ(parse_hapi_log(turned + "0 0 0 0\n", "log").rows[0].pose.orientation.w(), 1);  // no turn, about no axis
  const auto unit = [](double length) { return error_of([=] { parse_hapi_log(kExample, "log", {length}); }); };
  EXPECT_EQ(unit(0).code(), Code::out_of_range);
  EXPECT_EQ(unit(std::numeric_limits<double>::quiet_NaN()).code(), Code::invalid_value);
  EXPECT_TRUE(mentions(unit(-1), "hapi_log.length_unit")) << unit(-1).what();
  const Error overflow = error_of([] { parse_hapi_log("TIME POSITION\n0 1 1e300 3\n", "log", {.length_unit = 1e10}); });
  EXPECT_TRUE(mentions(overflow, "line 2, column 5 (POSITION): must be finite, is inf")) << overflow.what();
}

TEST(HapiLog, SurvivesRandomDamage) {
  Random random(63);
  int accepted = 0;
  for (int k = 0; k < 20'000; ++k) {
    std::string damaged = kExample;
    for (std::uint64_t n = 1 + random.below(3); n > 0; --n) {
      const std::size_t at = random.below(damaged.size());
      if (random.below(3) == 0) {
        damaged.erase(at, random.below(9));
      } else {
        damaged[at] = static_cast<char>(random.below(2) ? random.below(256) : "0 .-e\n\tT"[random.below(8)]);
      }
    }
    try {
      validate(parse_hapi_log(damaged, "damaged"));
      ++accepted;
    } catch (const Error& error) {
      EXPECT_NE(error.code(), Code{});
      EXPECT_TRUE(mentions(error, "damaged: line ")) << error.what();
    }
  }
  EXPECT_GT(accepted, 100);
}

TEST(HapiLog, ReadsFiles) {
  namespace fs = std::filesystem;
  const fs::path path = fs::temp_directory_path() / "crumble_hapi_log_test.log";
  std::ofstream(path) << kExample;
  EXPECT_EQ(read_hapi_log(path.string()).rows.size(), 3u);
  std::ofstream(path) << "TIME\n";
  const Error error = error_of([&] { read_hapi_log(path.string()); });
  EXPECT_TRUE(mentions(error, path.string() + ": line 1")) << error.what();
  fs::remove(path);
  EXPECT_EQ(error_of([&] { read_hapi_log(path.string()); }).code(), Code::io);
}

}  // namespace
}  // namespace crumble
