#include "crumble/device/trajectory.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>

#include "crumble/base/memory.hpp"
#include "device/samples.hpp"

namespace crumble {
namespace {

namespace fs = std::filesystem;

DeviceSample as_sample(const TrajectoryRow& row) {
  return {row.time, row.pose, row.linear_velocity, row.angular_velocity, row.buttons, row.flags};
}

void expect_same_bits(const Trajectory& a, const Trajectory& b) {
  EXPECT_EQ(a.header, b.header);
  EXPECT_EQ(a.columns, b.columns);
  ASSERT_EQ(a.rows.size(), b.rows.size());
  for (std::size_t i = 0; i < a.rows.size(); ++i) {
    EXPECT_EQ(bits(as_sample(a.rows[i])), bits(as_sample(b.rows[i]))) << i;
    EXPECT_EQ(a.rows[i].force, b.rows[i].force) << i;
    EXPECT_EQ(a.rows[i].torque, b.rows[i].torque) << i;
  }
}

class TrajectoryFile : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / (std::string("crumble_trajectory_") + test->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const char* name) const { return (folder_ / name).string(); }
  std::size_t files() const { return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), {})); }

  fs::path folder_;
};

TEST_F(TrajectoryFile, ComesBackExactly) {
  const Trajectory all = random_trajectory(11, 1000);
  write_trajectory(path("all.ctraj"), all);
  expect_same_bits(read_trajectory(path("all.ctraj")), all);
  EXPECT_EQ(files(), 1u);  // no temporary file is left
}

TEST_F(TrajectoryFile, IsUntouchedWhenWritingFails) {
  const Trajectory good = random_trajectory(12, 3);
  write_trajectory(path("a.ctraj"), good);
  Trajectory bad = random_trajectory(13, 3);
  bad.rows[2].pose.position.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(error_of([&] { write_trajectory(path("a.ctraj"), bad); }).code(), Code::invalid_value);
  expect_same_bits(read_trajectory(path("a.ctraj")), good);
  EXPECT_EQ(error_of([&] { write_trajectory(path("no/such/folder.ctraj"), good); }).code(), Code::io);
  fs::create_directories(folder_ / "taken" / "inside");
  EXPECT_EQ(error_of([&] { write_trajectory(path("taken"), good); }).code(), Code::io);
  EXPECT_EQ(files(), 2u);
}

TEST_F(TrajectoryFile, TellsAnUnreadableOne) {
  const Error missing = error_of([&] { read_trajectory(path("missing.ctraj")); });
  EXPECT_EQ(missing.code(), Code::io);
  EXPECT_TRUE(mentions(missing, "missing.ctraj"));
  EXPECT_EQ(error_of([&] { read_trajectory(folder_.string()); }).code(), Code::io);
  std::ofstream(path("empty.ctraj")).close();
  EXPECT_EQ(error_of([&] { read_trajectory(path("empty.ctraj")); }).code(), Code::empty);
}

TEST(Trajectory, EveryChoiceOfColumnsComesBack) {
  for (std::uint32_t columns = 1; columns <= quantity::kAll; columns += 2) {
    Trajectory motion = parse_trajectory(format_trajectory(random_trajectory(14, 5)), "all");
    motion.columns = columns;
    const std::string text = format_trajectory(motion);
    const Trajectory back = parse_trajectory(text, "some");
    EXPECT_EQ(back.columns, columns);
    EXPECT_EQ(format_trajectory(back), text);
    const bool turned = columns & quantity::kOrientation;
    EXPECT_EQ(back.rows[3].pose.orientation.w(), turned ? motion.rows[3].pose.orientation.w() : 1);
  }
}

TEST(Trajectory, ReadsWhatItsReferenceShows) {
  const Trajectory t = parse_trajectory(
      "# crumble-traj 1\r\n# device: a : b \n#tight\n#\nbuttons,pz,py,px,t\n3,0.3,-2e-1,.1,-1\n0,3,2,1,0\n# end rows=2",
      "x");
  EXPECT_EQ(t.header, (Vector<std::string>{"device: a : b ", "tight", ""}));
  EXPECT_EQ(t.value_of("device"), "a : b");
  EXPECT_EQ(t.value_of("dev"), "");
  EXPECT_EQ(t.columns, quantity::kPosition | quantity::kButtons);
  ASSERT_EQ(t.rows.size(), 2u);
  EXPECT_EQ(t.rows[0].time, -1);
  EXPECT_EQ(t.rows[0].pose.position, Vec3(0.1, -0.2, 0.3));
  EXPECT_EQ(t.rows[0].buttons, 3u);
}

struct Malformed {
  const char* what;
  std::string text;
  Code code;
  const char* says;  // the place, and what is wrong
};

TEST(Trajectory, RefusesEveryMalformedTextWithCodeAndPlace) {
  const std::string magic = "# crumble-traj 1\n", names = "t,px,py,pz\n", row = "0,1,2,3\n", end1 = "# end rows=1\n";
  const std::string head = magic + names;
  const std::string turned = magic + "t,px,py,pz,qx,qy,qz,qw\n";
  std::string many = "t,px,py,pz";
  for (int i = 0; i < 10'000; ++i) many += ",c" + std::to_string(i);
  const Malformed cases[] = {
      {"empty", "", Code::empty, "is empty"},
      {"wrong magic", "t,px,py,pz\n", Code::format, "line 1: "},
      {"blank first line", "\n" + head + row + end1, Code::format, "line 1: "},
      {"byte order mark", "\xef\xbb\xbf" + head + row + end1, Code::format,
       "line 1: is no .ctraj file: it must begin with '# crumble-traj ', not with '\\xef\\xbb\\xbf# crumble-traj 1'"},
      {"version 2", "# crumble-traj 2\n" + names + row + end1, Code::version, "line 1: "},
      {"version 10", "# crumble-traj 10\n" + names + row + end1, Code::version, "'10'"},
      {"only the magic line", magic, Code::corrupt, "line 2: "},
      {"end before the names", magic + "# end rows=0\n", Code::format, "line 2: "},
      {"millimetres", magic + "# units: mm s N\n" + names + row + end1, Code::unsupported, "line 2: units"},
      {"missing column", magic + "# a\n# b\nt,px,pz\n0,1,2\n" + end1, Code::format, "line 4: column py is missing"},
      {"half an orientation", magic + "t,px,py,pz,qx,qy,qz\n0,1,2,3,0,0,0\n" + end1, Code::format,
       "line 2: column qw is missing"},
      {"unknown column", magic + "t,px,py,pz,speed\n", Code::format, "line 2, column 12: unknown column 'speed'"},
      {"blank in a name", magic + "t, px,py,pz\n", Code::format, "line 2, column 3: unknown column ' px'"},
      {"column twice", magic + "t,px,py,pz,px\n", Code::format, "line 2, column 12: column px stands twice"},
      {"trailing comma", magic + "t,px,py,pz,\n", Code::format, "line 2, column 12: unknown column ''"},
      {"no number", head + row + "1,1,two,3\n# end rows=2\n", Code::format,
       "line 4, column 5 (py): 'two' is not a number"},
      {"empty cell", head + "0,1,,3\n" + end1, Code::format, "line 3, column 5 (py): ''"},
      {"blank before a number", head + "0, 1,2,3\n" + end1, Code::format, "line 3, column 3 (px): ' 1'"},
      {"decimal comma", head + "0,1,5,2,3\n" + end1, Code::format, "line 3: 5 cells, the column names are 4"},
      {"too large for a double", head + "0,1e999,2,3\n" + end1, Code::format,
       "line 3, column 3 (px): '1e999' is not a number"},
      {"NaN", head + "0,1,2,nan\n" + end1, Code::invalid_value, "line 3, column 7 (pz): must be finite, is nan"},
      {"infinite time", head + "inf,1,2,3\n" + end1, Code::invalid_value,
       "line 3, column 1 (t): must be finite, is inf"},
      {"time stands still", head + row + row + "# end rows=2\n", Code::out_of_range,
       "line 4, column 1 (t): must increase, is "},
      {"time goes back", head + row + "-1,1,2,3\n# end rows=2\n", Code::out_of_range,
       "line 4, column 1 (t): must increase, is "},
      {"long quaternion", turned + "0,1,2,3,0,0,0,1.0011\n" + end1, Code::bad_pose,
       "line 3, column 9 (qx qy qz qw): must have length 1"},
      {"zero quaternion", turned + "0,1,2,3,0,0,0,0\n" + end1, Code::bad_pose,
       "line 3, column 9 (qx qy qz qw): must have length 1"},
      {"huge quaternion", turned + "0,1,2,3,1e300,0,0,0\n" + end1, Code::bad_pose,
       "line 3, column 9 (qx qy qz qw): must have length 1"},
      {"half a button", magic + "t,px,py,pz,buttons\n0,1,2,3,0.5\n" + end1, Code::out_of_range,
       "line 3, column 9 (buttons): must be a whole number"},
      {"33 buttons", magic + "t,px,py,pz,buttons\n0,1,2,3,4294967296\n" + end1, Code::out_of_range,
       "line 3, column 9 (buttons): must be a whole number"},
      {"few cells", head + row + "1,1,2\n# end rows=2\n", Code::format, "line 4: 3 cells, the column names are 4"},
      {"many cells", head + "0,1,2,3,4\n" + end1, Code::format, "line 3: 5 cells"},
      {"blank line", head + row + "\n# end rows=1\n", Code::format, "line 4: 1 cells"},
      {"no end line", head + row, Code::corrupt, "line 4: is truncated"},
      {"cut in the end line", head + row + "# end ro", Code::corrupt, "line 4: the end line must be '# end rows=1'"},
      {"wrong count", head + row + "# end rows=2\n", Code::corrupt, "line 4: the end line must be '# end rows=1'"},
      {"huge count", head + row + "# end rows=18446744073709551615\n", Code::corrupt, "line 4: "},
      {"padded count", head + row + "# end rows=01\n", Code::corrupt, "line 4: "},
      {"comment between rows", head + row + "# hello\n1,1,2,3\n# end rows=2\n", Code::corrupt, "line 4: "},
      {"text after the end", head + row + end1 + row, Code::corrupt, "line 5: text after the end line"},
      {"no rows", head + "# end rows=0\n", Code::empty, "has no row"},
      {"no rows, count 1", head + end1, Code::corrupt, "line 3: "},
      {"count below zero", head + row + "# end rows=-1\n", Code::corrupt, "line 4: "},
      {"count beyond all", head + row + "# end rows=1" + std::string(400, '0') + "\n", Code::corrupt, "0000...'"},
      {"columns in another order", magic + "pz,buttons,t,py,px\n0,0,0,0,0\n0.25,1.5,1,0,0\n# end rows=2\n",
       Code::out_of_range, "line 4, column 6 (buttons): must be a whole number"},
      {"last column's time", magic + "px,py,pz,t\n0,0,0,7\n0.25,-1.5,1,6.5\n# end rows=2\n", Code::out_of_range,
       "line 4, column 13 (t): must increase, is 6.5 after 7"},
      {"huge whole number", head + "0,1," + std::string(400, '9') + ",3\n" + end1, Code::format,
       "line 3, column 5 (py): '9999999999999999999999999999999999999999...' is not a number"},
      {"minus NaN", head + "0,1,2,-nan\n" + end1, Code::invalid_value, "line 3, column 7 (pz): must be finite"},
      {"NUL in a number", head + std::string("0,1\0,2,3\n", 10) + end1, Code::format,
       "line 3, column 3 (px): '1\\x00' is not a number"},
      {"NUL in a name", magic + std::string("t,px,py,p\0z\n", 12), Code::format,
       "line 2, column 9: unknown column 'p\\x00z'"},
      {"NUL for a text", std::string(1, '\0'), Code::format, "line 1: "},
      {"CR alone", "# crumble-traj 1\rt,px,py,pz\r0,1,2,3\r# end rows=1\r", Code::version,
       "line 1: has .ctraj version '1\\x0dt,px,py,pz\\x0d0,1,2,3"},
      {"a long name", magic + "t," + std::string(1'000'000, 'p') + "\n", Code::format,
       "line 2, column 3: unknown column 'pppppppppppppppppppppppppppppppppppppppp...'"},
      {"a long cell", head + "0," + std::string(1'000'000, 'p') + ",2,3\n" + end1, Code::format,
       "line 3, column 3 (px): 'pppppppppppppppppppppppppppppppppppppppp...' is not a number"},
      {"a long row", head + std::string(1'000'000, ',') + "\n" + end1, Code::format, "line 3: 1000001 cells"},
      {"a long version", "# crumble-traj " + std::string(1'000'000, '1') + "\n", Code::version, "111...'"},
      {"many columns", magic + many + "\n", Code::format, "line 2, column 12: unknown column 'c0'"},
  };
  for (const Malformed& c : cases) {
    const Error error = error_of([&] { parse_trajectory(c.text, "file"); });
    EXPECT_EQ(error.code(), c.code) << c.what << ": " << error.what();
    EXPECT_TRUE(mentions(error, c.says)) << c.what << ": " << error.what();
    EXPECT_TRUE(mentions(error, "file")) << c.what << ": " << error.what();
    EXPECT_LT(std::string(error.what()).size(), 200u) << c.what;
  }
}

TEST(Trajectory, ReadsLongHeaderLines) {
  const std::string line(1'000'000, 'x');
  const Trajectory t = parse_trajectory("# crumble-traj 1\n# " + line + "\nt,px,py,pz\n0,1,2,3\n# end rows=1", "x");
  EXPECT_EQ(t.header, Vector<std::string>{line});
}

/// Reads `text`; whatever it is, it is valid or an Error that says what and where. Returns whether it was valid.
bool expect_valid_or_told(const std::string& text) {
  try {
    validate(parse_trajectory(text, "damaged"));
    return true;
  } catch (const Error& error) {
    const std::string what = error.what();
    EXPECT_NE(error.code(), Code{});
    EXPECT_TRUE(what.starts_with("damaged: line ")) << what;
    EXPECT_LT(what.size(), 200u) << what;
    return false;
  }
}

// Every prefix is refused, except the one that lacks only the last newline.
TEST(Trajectory, EveryTruncationIsSeen) {
  const std::string text = format_trajectory(random_trajectory(15, 12));
  EXPECT_EQ(error_of([&] { parse_trajectory("", "cut"); }).code(), Code::empty);
  for (std::size_t n = 1; n + 1 < text.size(); ++n) EXPECT_FALSE(expect_valid_or_told(text.substr(0, n))) << n;
  EXPECT_EQ(parse_trajectory(text.substr(0, text.size() - 1), "cut").rows.size(), 12u);
}

TEST(Trajectory, SurvivesEveryByteChanged) {
  const std::string text = format_trajectory(random_trajectory(19, 2));
  Random random(20);
  int accepted = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    for (int k = 0; k < 11; ++k) {
      std::string damaged = text;
      damaged[at] = static_cast<char>(k < 8 ? damaged[at] ^ (1 << k) : static_cast<int>(random.below(256)));
      accepted += expect_valid_or_told(damaged);
    }
  }
  EXPECT_GT(accepted, 100);  // a changed digit is still a number
}

// Damaged bytes end in an Error or in a trajectory that is valid: nothing else leaves the parser.
TEST(Trajectory, SurvivesRandomDamage) {
  const std::string text = format_trajectory(random_trajectory(16, 6));
  const Vector<std::string> words = {
      "\n",  "\r",    "\r\n", ",",    ",,",         "# ",           "# end rows=",
      "nan", "1e999", "inf",  "-0x1", "4294967296", "\xef\xbb\xbf", std::string(1, '\0')};
  Random random(17);
  int accepted = 0;
  for (int k = 0; k < 20000; ++k) {
    std::string damaged = text;
    for (std::uint64_t n = 1 + random.below(4); n > 0; --n) {
      const std::size_t at = random.below(damaged.size());
      switch (random.below(4)) {
        case 0:
          damaged.erase(at, random.below(20));
          break;
        case 1:
          damaged.insert(at, words[random.below(words.size())]);
          break;
        case 2:
          damaged.insert(at, damaged.substr(random.below(damaged.size()), random.below(60)));
          break;
        default:
          damaged[at] = static_cast<char>(random.below(2) ? random.below(256) : "0,.-e\n# "[random.below(8)]);
      }
    }
    accepted += expect_valid_or_told(damaged);
  }
  EXPECT_GT(accepted, 100);
}

TEST(Trajectory, ValidateNamesRowAndColumn) {
  Trajectory t = random_trajectory(18, 5);
  t.rows[3].force.y() = std::numeric_limits<double>::infinity();
  const Error error = error_of([&] { validate(t); });
  EXPECT_EQ(error.code(), Code::invalid_value);
  EXPECT_TRUE(mentions(error, "rows[3]: column fy")) << error.what();
  for (const char* line : {"two\nlines", "end rows=3", "return\r"}) {
    t = random_trajectory(18, 5);
    t.header.push_back(line);
    EXPECT_EQ(error_of([&] { format_trajectory(t); }).code(), Code::format) << line;
  }
  t.header = {"units: mm"};
  EXPECT_EQ(error_of([&] { format_trajectory(t); }).code(), Code::unsupported);
}

}  // namespace
}  // namespace crumble
