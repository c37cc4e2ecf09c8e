// What the command line does with devices: real ones are the double of HDAPI here.
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "crumble/base/file.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/device/trajectory.hpp"
#include "render/temporary_folder.hpp"

namespace crumble::cli {
namespace {

using nlohmann::json;
using render::TemporaryFolder;

bool mentions(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

json json_of(const Vector<std::string>& arguments) {
  const Outcome outcome = crumble(arguments);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  return outcome.code == 0 ? json::parse(outcome.out) : json();
}

TEST(DevicesCommand, ListsWhatIsPluggedInAndWhatItLacks) {
  const TemporaryFolder folder;
  const auto place = folder.file("usb") / "1-4";
  std::filesystem::create_directories(place);
  write_text(place / "idVendor", "2988\n");
  write_text(place / "idProduct", "0304\n");
  write_text(place / "product", "Touch\n");
  std::filesystem::create_directories(folder.file("usb") / "1-5");
  write_text(folder.file("usb") / "1-5" / "idVendor", "1d6b\n");
  const Vector<std::string> usb = {"devices", "--usb", folder.file("usb").string(), "--library", "/no/such/libHD.so"};
  const Outcome outcome = crumble(usb);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  for (const char* part : {"USB 2988:0304 Touch at 1-4", "its driver is not", "/no/such/libHD.so", "hand"}) {
    EXPECT_TRUE(mentions(outcome.out, part)) << outcome.out;
  }
  EXPECT_FALSE(mentions(outcome.out, "1-5"));
  const Outcome none = crumble({"devices", "--usb", "/no/such/folder", "--library", "/no/such/libHD.so"});
  EXPECT_TRUE(mentions(none.out, "no hardware was found")) << none.out;
  const json asked =
      json_of({"devices", "--usb", "/no/such/folder", "--library", "/no/such/libHD.so", "--ask-services", "--json"});
  ASSERT_EQ(asked.at("attached").size(), 1u);
  EXPECT_EQ(asked.at("attached")[0].at("kind"), "inverse3");
  EXPECT_FALSE(asked.at("attached")[0].at("note").get<std::string>().empty());
}

TEST(RecordCommand, RecordsAScriptWholeAndAnEndlessOneInPart) {
  const TemporaryFolder folder;
  const std::string out = folder.file("a.ctraj").string();
  EXPECT_EQ(crumble({"record", out, "--device", "poke:50"}).code, 0);
  const Trajectory poke = read_trajectory(out);
  EXPECT_GT(poke.rows.size(), 6000u);
  EXPECT_EQ(poke.rows.front().pose.position, poke.rows.back().pose.position);
  EXPECT_EQ(crumble({"record", out, "--device", "wander:3", "--seconds", "2", "--rate", "500"}).code, 0);
  const Trajectory wander = read_trajectory(out);
  EXPECT_NEAR(static_cast<double>(wander.rows.size()), 1000, 1);
  const struct {
    Vector<std::string> arguments;
    std::string message;
  } refusals[] = {
      {{"record", out, "--device", "wander:3"}, "has no end of its own: give --seconds"},
      {{"record", out, "--device", "wander:x", "--seconds", "1"}, "--device 'wander:x' needs a whole number"},
      {{"record", out, "--device", "mouse", "--seconds", "1"}, "--device 'mouse' is not known"},
      {{"record", out, "--device", "replay:"}, "needs a file"},
      {{"record", out, "--device", "inverse3:host:0", "--seconds", "1"}, "needs a port"},
      {{"record", out, "--device", "hand", "--library", "x"}, "--library needs --device phantom"},
      {{"record", "a.csv", "--device", "hand"}, ".ctraj"}};
  for (const auto& [arguments, message] : refusals) {
    const Outcome outcome = crumble(arguments);
    EXPECT_EQ(outcome.code, 1);
    EXPECT_TRUE(mentions(outcome.err, message)) << outcome.err;
  }
}

TEST(ImportCommand, MakesATrajectoryOfALog) {
  const TemporaryFolder folder;
  const std::string log = folder.file("hapi.log").string(), out = folder.file("a.ctraj").string();
  write_text(log, "TIME POSITION\n0 0 0 1\n0.5 0 0 2\n");
  const Outcome outcome = crumble({"import", log, out, "--length-unit", "0.001"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(mentions(outcome.out, "2 samples over 0.5 s")) << outcome.out;
  EXPECT_EQ(read_trajectory(out).rows[1].pose.position.z(), 0.002);
  write_text(log, "TIME POSITION\n0 0 0\n");
  EXPECT_TRUE(mentions(crumble({"import", log, out}).err, "line 2"));
}

TEST(LoopCommand, WhatItRecordedIsTheSameWhenRunAgain) {
  const TemporaryFolder folder;
  const std::string file = folder.file("a.ctraj").string();
  const Outcome run = crumble({"loop", "tofu_cube", "--record", file, "--seconds", "2.5"});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_TRUE(mentions(run.out, "every force is the same to the last bit")) << run.out;
  const Outcome again = crumble({"loop", "tofu_cube", "--device", "replay:" + file, "--verify"});
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_TRUE(mentions(again.out, "every force the same to the last bit")) << again.out;

  Trajectory changed = read_trajectory(file);
  changed.rows[2000].force.y() += 1e-15;
  const std::string other = folder.file("b.ctraj").string();
  write_trajectory(other, changed);
  const Outcome different = crumble({"loop", "tofu_cube", "--device", "replay:" + other, "--verify"});
  EXPECT_EQ(different.code, 1);
  EXPECT_TRUE(mentions(different.err, "the force of row 2000")) << different.err;
  changed = read_trajectory(file);
  for (std::string& line : changed.header) {
    if (line.starts_with("loop_state")) line.back() = line.back() == '0' ? '1' : '0';
  }
  write_trajectory(other, changed);
  EXPECT_TRUE(
      mentions(crumble({"loop", "tofu_cube", "--device", "replay:" + other, "--verify"}).err, "the state's hash"));
  EXPECT_TRUE(mentions(crumble({"loop", "tofu_cube", "--device", "replay:" + file, "--no-damping", "--verify"}).err,
                       "it was recorded with"));
  EXPECT_TRUE(mentions(crumble({"loop", "tofu_cube", "--device", "replay:press_1mm_s", "--verify"}).err,
                       "was not recorded by"));
  EXPECT_TRUE(mentions(crumble({"loop", "tofu_cube", "--verify"}).err, "--verify needs --device replay:FILE"));
}

#ifdef FAKEHD_LIBRARY
/// The double's script of one device, for programs started from here.
class Script {
 public:
  explicit Script(const std::string& text) { ::setenv("FAKEHD_SCRIPT", text.c_str(), 1); }
  ~Script() { ::unsetenv("FAKEHD_SCRIPT"); }
};

TEST(DeviceCheck, GoesThroughAndWritesItsReport) {
  const Script script(R"({"devices": [{"inkwell_at_s": 0, "inkwell_for_s": 0.2, "ramp_s": 0}],
                          "faults": [{"kind": "comm_error", "tick": 4500}]})");
  const TemporaryFolder folder;
  const std::string file = folder.file("check.json").string();
  const Outcome outcome = crumble({"device-check", "--library", FAKEHD_LIBRARY, "--seconds", "1", "--push", "--yes",
                                   "--unplug", "--wait", "30", "--report", file});
  EXPECT_EQ(outcome.code, 0) << outcome.err << outcome.out;
  for (const char* part : {"FAKE Touch", "calibration  ok", "Hz of 1000", "push         0.30 N", "HD_COMM_ERROR",
                           "the check went through"}) {
    EXPECT_TRUE(mentions(outcome.out, part)) << part << " is not in " << outcome.out;
  }
  const json report = json::parse(read_text(file));
  EXPECT_EQ(report.at("device").at("kind"), "phantom");
  EXPECT_EQ(report.at("device").at("serial"), "FAKE-0001");
  EXPECT_GT(report.at("still").at("samples"), 100);
  EXPECT_NEAR(report.at("push").at("peak_n"), 0.3, 1e-9);
  EXPECT_NEAR(report.at("push").at("moved_up_m"), 0.3 / 150, 3e-4) << "the double's hand: 150 N/m";
  EXPECT_TRUE(report.at("unplugged").at("noticed"));
  EXPECT_EQ(report.at("stopped"), "");
}

TEST(DeviceCheck, NobodyIsPushedUnasked) {
  const Script script(R"({"devices": [{"calibration": "none"}]})");
  const Vector<std::string> check = {"device-check", "--library", FAKEHD_LIBRARY, "--seconds", "0.3", "--json"};
  EXPECT_FALSE(json_of(check).contains("push"));
  Vector<std::string> push = check;
  push.push_back("--push");
  const Outcome outcome = crumble(push);  // nobody at a terminal
  EXPECT_EQ(outcome.code, 1);
  EXPECT_TRUE(mentions(outcome.err, "--push")) << outcome.err;
  push.insert(push.end(), {"--yes", "--force", "3"});
  EXPECT_TRUE(mentions(crumble(push).err, "--force must lie in [0, 0.5], is 3"));
}

TEST(DeviceCheck, EndsEarlyWithTheReason) {
  const Vector<std::string> check = {"device-check", "--library", FAKEHD_LIBRARY, "--seconds", "1", "--wait", "0.5"};
  {
    const Script script(R"({"devices": [{"inkwell_at_s": -1}]})");
    const Outcome outcome = crumble(check);
    EXPECT_EQ(outcome.code, 1);
    EXPECT_TRUE(mentions(outcome.err, "put the stylus into its inkwell")) << outcome.err;
  }
  {
    const Script script(R"({"devices": [{"calibration": "none"}], "faults": [{"kind": "comm_error", "tick": 200}]})");
    const Outcome outcome = crumble(check);
    EXPECT_EQ(outcome.code, 1);
    EXPECT_TRUE(mentions(outcome.err, "HD_COMM_ERROR, internal code -28")) << outcome.err;
  }
  const Outcome missing = crumble({"device-check", "--library", "/no/such/libHD.so"});
  EXPECT_EQ(missing.code, 1);
  EXPECT_TRUE(mentions(missing.err, "/no/such/libHD.so: cannot open shared object file"))
      << "the loader's words: " << missing.err;
}

TEST(LoopCommand, TheDriverOfADeviceTicks) {
  const Script script(R"({"devices": [{"calibration": "none", "ramp_s": 0, "hand": {"points":
      [{"t": 0, "y": 0.001}, {"t": 1, "y": 0.001}, {"t": 1.5, "y": -0.005}]}}]})");
  const TemporaryFolder folder;
  const std::string file = folder.file("a.ctraj").string();
  const json run = json_of({"loop", "tofu_cube", "--device", "phantom", "--library", FAKEHD_LIBRARY, "--seconds", "2.5",
                            "--record", file, "--json"});
  EXPECT_EQ(run.at("fault"), "none");
  EXPECT_GT(run.at("peak_force_n"), 0.02);
  EXPECT_EQ(run.at("scheduling"), "") << "the thread is the driver's";
  EXPECT_EQ(run.at("device_text"), "");
  EXPECT_TRUE(run.at("replay").at("identical").get<bool>());
  const Trajectory trajectory = read_trajectory(file);
  EXPECT_TRUE(mentions(std::string(trajectory.value_of("device")), "FAKE Touch"));
  EXPECT_EQ(trajectory.value_of("max_force_n"), "3.3");
  EXPECT_EQ(crumble({"loop", "tofu_cube", "--device", "replay:" + file, "--verify"}).code, 0);
  {
    const Script unplugged(
        R"({"devices": [{"calibration": "none"}], "faults": [{"kind": "comm_error", "tick": 100}]})");
    const Outcome lost =
        crumble({"loop", "tofu_cube", "--device", "phantom", "--library", FAKEHD_LIBRARY, "--seconds", "0.5"});
    EXPECT_EQ(lost.code, 0) << lost.err;
    for (const char* part : {"thread      the device's", "faulted: device_lost", "the device says: HD_COMM_ERROR"}) {
      EXPECT_TRUE(mentions(lost.out, part)) << lost.out;
    }
  }
  const Outcome slow = crumble(
      {"loop", "tofu_cube", "--device", "phantom", "--library", FAKEHD_LIBRARY, "--rate", "4000", "--seconds", "1"});
  EXPECT_TRUE(mentions(slow.err, "ticks at 1000 Hz")) << slow.err;
}
#endif

}  // namespace
}  // namespace crumble::cli
