// crumble.hpp: changes in mid-run, several steps at once, recordings, memory, the log.
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include "capi/hpp_rig.hpp"
#include "support/allocation_counter.hpp"

namespace crumble {
namespace {

std::string temporary(const std::string& name) {
  return (std::filesystem::temp_directory_path() / name).string();
}

TEST_F(Hpp, WhatStaysTheSameChangesNoBit) {
  press(twin, 1, 150);
  const std::uint64_t here = twin.state_hash();
  twin.configure(twin.get_def());
  c::ToolDef stick;
  stick.static_friction = 3, stick.dynamic_friction = 1.5;
  twin.set_tool(0, stick);
  twin.set_friction(0, 3, 1.5);
  twin.fix_below(1e-6);
  EXPECT_EQ(twin.state_hash(), here);
  press(twin, 151, 300);
  c::Sim never = make();
  press(never, 1, 300);
  EXPECT_GT(never.get_counters().cuts, 0u);
  EXPECT_EQ(twin.state_hash(), never.state_hash());
}

TEST_F(Hpp, MaterialToolsAndWallsChangeInMidRun) {
  const double soft = press(twin, 1, 60).force[1];
  def = twin.get_def();
  def.stiffness = 60;
  twin.configure(def);
  EXPECT_NEAR(press(twin, 61, 61).force[1] / soft, 2, 0.3);
  def.tau = 0.002;
  expect_error(CRUMBLE_E_STATE, {"crumble_sim_configure", "tau is 0.001", "0.002"}, [&] { twin.configure(def); });
  c::ToolDef ball;
  ball.shape = CRUMBLE_TOOL_BALL;
  twin.set_tool(0, ball);
  EXPECT_EQ(press(twin, 62, 62).force[1], 0) << "another solid lets go";
  c::WallDef wall;
  wall.offset = -0.001;
  twin.add_wall(wall);
  wall.offset = 0.006;  // above the lowest layer of free nodes
  twin.set_wall(1, wall);
  press(twin, 63, 64);
  double lowest = 1;
  for (const double y : twin.get_view(c::kPositionsY)) lowest = y > 1e-6 ? std::min(lowest, y) : lowest;
  EXPECT_GE(lowest, 0.006 - 1e-12);
  expect_error(CRUMBLE_E_OUT_OF_RANGE, {"wall is 2", "there are 2"}, [&] { twin.set_wall(2, wall); });
  expect_error(CRUMBLE_E_OUT_OF_RANGE, {"tool is 1", "there are 1"}, [&] { twin.set_tool(1, ball); });
  expect_error(CRUMBLE_E_OUT_OF_RANGE, {"friction"}, [&] { twin.set_friction(0, 1, 2); });
}

TEST_F(Hpp, AdvancesSeveralSteps) {
  press(twin, 1, 30);
  c::Sim other = make();
  press(other, 1, 30);
  crumble_advance_info info = twin.advance(pose_at(46), wrench, 16);
  EXPECT_EQ(info.steps, 16u);
  EXPECT_EQ(info.dropped, 0u);
  EXPECT_NEAR(info.time, 0.046, 1e-9);
  double sum = 0;
  for (int step = 31; step <= 46; ++step) sum += other.step(pose_at(step)).force[1];
  EXPECT_NEAR(wrench.force[1], sum / 16, 1e-6);
  const std::vector<double> mine = twin.copy(c::kPositions), theirs = other.copy(c::kPositions);
  for (std::size_t i = 0; i < mine.size(); ++i) ASSERT_NEAR(mine[i], theirs[i], 1e-9);
  info = twin.advance(pose_at(96), wrench, 50, 1e-9);
  EXPECT_EQ(info.steps, 1u);
  EXPECT_EQ(info.dropped, 49u);
  EXPECT_TRUE(info.flags & CRUMBLE_STEP_DROPPED);
  EXPECT_EQ(twin.get_counters().dropped_steps, 49u);

  const std::vector<crumble_pose> poses{pose_at(50)};
  std::vector<crumble_wrench> means(1);
  EXPECT_EQ(twin.advance(poses, means, 3).steps, 3u);
  EXPECT_GT(means[0].force[1], 0);
  means.clear();
  expect_error(CRUMBLE_E_OUT_OF_RANGE, {"advance"}, [&] { twin.advance(poses, means, 3); });
  expect_error(CRUMBLE_E_OUT_OF_RANGE, {"steps"}, [&] { twin.advance(poses[0], wrench, 0); });
  wrench.force[1] = 7;
  EXPECT_RESULT(CRUMBLE_E_BAD_POSE, twin.try_advance(crumble_pose{}, wrench, info, 3));
  EXPECT_EQ(wrench.force[1], 0);
}

TEST_F(Hpp, AdvancingAllocatesNothing) {
  if (!AllocationCounter::available()) GTEST_SKIP() << "allocations are not counted here";
  std::size_t allocations = 0;
  twin.step(pose_at(0));  // where the stick begins
  {
    const AllocationCounter counter;
    for (int frame = 1; frame <= 20; ++frame) twin.advance(pose_at(15 * frame), wrench, 15);
    allocations = counter.count();
  }
  EXPECT_EQ(allocations, 0u);
  EXPECT_GT(wrench.force[1], 0.1);
}

TEST_F(Hpp, KeepsTheBooksOfTheEnergy) {
  expect_error(CRUMBLE_E_STATE, {"energy_audit"}, [&] { twin.get_energy(); });
  def = twin.get_def();
  def.energy_audit = 1;
  twin.configure(def);
  press(twin, 1, 250);
  const crumble_energy energy = twin.get_energy();
  EXPECT_GT(energy.tool_work, 0);
  EXPECT_GT(energy.cut, 0);
  EXPECT_NEAR(energy.tool_work + energy.external_work - energy.dissipated - energy.cut, energy.stored,
              1e-9 * energy.tool_work);
}

TEST_F(Hpp, SavesAMeshForOthersToRead) {
  const std::string path = temporary("crumble_hpp_test.vtk");
  body.save_vtk(path);
  std::ifstream file(path);
  const std::string all((std::istreambuf_iterator<char>(file)), {});
  std::filesystem::remove(path);
  EXPECT_NE(all.find("POINTS " + std::to_string(cube.node_count())), std::string::npos);
  expect_error(CRUMBLE_E_IO, {"/nowhere/at/all.vtk"}, [&] { body.save_vtk("/nowhere/at/all.vtk"); });
}

TEST_F(Hpp, GoesThroughARecordingStepByStep) {
  const std::string path = temporary("crumble_hpp_live_test.crec");
  press(twin, 1, 30);
  twin.begin_recording();
  press(twin, 31, 60);
  twin.set_friction(0, 0.5, 0.2);
  press(twin, 61, 120);
  twin.save_recording(path);
  c::Recording recording(path);
  std::filesystem::remove(path);
  const crumble_recording_info info = recording.get_info();
  EXPECT_EQ(info.tool_count, 1u);
  EXPECT_EQ(info.step_count, 90u);
  EXPECT_EQ(info.first_step, 30u);
  c::Sim again = recording.create_sim();
  for (std::uint64_t step = 0; step < 90; ++step) ASSERT_TRUE(recording.step(again, step)) << step;
  EXPECT_EQ(again.state_hash(), twin.state_hash());
  EXPECT_FALSE(recording.step(again, 3)) << "not from where step 2 left it";
  expect_error(CRUMBLE_E_OUT_OF_RANGE, {"step is 90"}, [&] { recording.step(again, 90); });
  recording.destroy();
  expect_error(CRUMBLE_E_NULL, {"crumble_recording_get_info"}, [&] { recording.get_info(); });
  EXPECT_EQ(again.get_step_info().step, 121u) << "needs it no more";
  expect_error(CRUMBLE_E_IO, {"crumble_hpp_live_test.crec"}, [&] { c::Recording none(path); });
}

TEST_F(Hpp, ALoopChangesTheBodyFromAnotherThread) {
  c::DeviceDef who;
  who.kind = CRUMBLE_DEVICE_PRESS;
  who.start.position[1] = 0.036;
  who.press_speed = 0.01, who.press_depth = 0.006;
  const c::Device device(who);
  c::HandDef hand;
  hand.device = device.get();
  c::LoopDef own;
  own.priority = 0;
  c::Loop loop(twin, own, hand);
  def = twin.get_def();
  loop.start();
  std::thread other([&] {
    for (int i = 0; i < 10; ++i) {
      def.stiffness = 31 + i;
      loop.configure(def);
      loop.set_friction(0, 2, 1);
      loop.set_tool(0, c::ToolDef());
    }
  });
  other.join();
  def.tau = 0.002;
  expect_error(CRUMBLE_E_STATE, {"crumble_loop_configure", "tau"}, [&] { loop.configure(def); });
  expect_error(CRUMBLE_E_OUT_OF_RANGE, {"tool is 4"}, [&] { loop.set_tool(4, c::ToolDef()); });
  expect_error(CRUMBLE_E_OUT_OF_RANGE, {"friction"}, [&] { loop.set_friction(0, 1, 2); });
  loop.stop();
  EXPECT_EQ(twin.get_def().stiffness, 40);
}

// ---- The log ----

class HppLog : public testing::Test {
 protected:
  void TearDown() override { c::log_set(nullptr); }
  static void fail() { EXPECT_RESULT(CRUMBLE_E_NULL, crumble_sim_reset(nullptr)); }
};

TEST_F(HppLog, KeepsAFunction) {
  std::vector<std::string> lines;
  const auto kept = std::make_shared<int>(7);
  c::log_set([&lines, kept](std::uint32_t level, const char* text) { lines.push_back(std::to_string(level) + text); });
  EXPECT_EQ(kept.use_count(), 2);
  fail();
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0], std::to_string(CRUMBLE_LOG_ERROR) + crumble_last_error());
  c::log_set(nullptr);
  EXPECT_EQ(kept.use_count(), 1) << "let go";
  fail();
  EXPECT_EQ(lines.size(), 1u);
}

TEST_F(HppLog, MayBeAPlainFunction) {
  std::string last;
  c::log_set([](std::uint32_t, const char* text, void* user) { *static_cast<std::string*>(user) = text; }, &last);
  fail();
  EXPECT_EQ(last, crumble_last_error());
}

TEST_F(HppLog, MayTakeItselfAway) {
  const auto kept = std::make_shared<int>(0);
  c::log_set([kept](std::uint32_t, const char*) {
    c::log_set(nullptr);
    ++*kept;  // still there
  });
  fail();
  fail();
  EXPECT_EQ(*kept, 1);
  EXPECT_EQ(kept.use_count(), 1);
}

TEST_F(HppLog, IsReplacedWhileOthersUseIt) {
  std::atomic<bool> stop{false};
  std::atomic<int> heard{0};
  std::thread other([&] {
    while (!stop) crumble_sim_reset(nullptr);
  });
  for (int i = 0; i < 1000 || heard < 10; ++i) {
    c::log_set([&heard, copy = std::make_shared<int>(1)](std::uint32_t, const char*) { heard += *copy; });
  }
  stop = true;
  other.join();
  EXPECT_GE(heard, 10);
}

// ---- Memory ----

class HppMemory : public testing::Test {
 protected:
  void TearDown() override { c::memory_set_source(nullptr); }
  static std::uint64_t use() {
    const c::Mesh mesh = c::Mesh::create_paper(CRUMBLE_PAPER_CUBE);
    const c::Sim sim(mesh);
    return c::memory_get_info().bytes;
  }
};

/// Counts, and has no more than so many.
struct Counting {
  void* take(std::uint64_t bytes, std::uint64_t alignment) noexcept {
    if (taken == most) return nullptr;
    ++taken;
    const std::uint64_t unit = std::max<std::uint64_t>(alignment, sizeof(void*));
    return std::aligned_alloc(unit, (bytes + unit - 1) / unit * unit);
  }
  void give_back(void* memory, std::uint64_t, std::uint64_t) noexcept {
    ++given;
    std::free(memory);
  }
  std::atomic<int> taken{0}, given{0};
  int most = 1 << 30;
};

TEST_F(HppMemory, ComesFromTheHost) {
  Counting counting;
  c::memory_set_source(c::memory_source_of(counting));
  EXPECT_GT(use(), 100000u);
  EXPECT_GT(counting.taken, 50);
  EXPECT_EQ(counting.taken, counting.given);
  EXPECT_EQ(c::memory_get_info().blocks, 0u);
  EXPECT_GT(c::memory_get_info().most_bytes, 100000u);
  counting.most = counting.taken + 20;
  expect_error(CRUMBLE_E_NO_MEMORY, {}, [] { use(); });
  EXPECT_EQ(counting.taken, counting.given);
}

TEST_F(HppMemory, MayBeABlock) {
  std::vector<std::byte> room(32 << 20);
  c::memory_use_block(room);
  EXPECT_GT(c::memory_get_info().longest_free, room.size() - 4096);
  EXPECT_GT(use(), 100000u);
  const std::uint64_t needed = c::memory_get_info().most_bytes;
  c::memory_use_block({room.data(), static_cast<std::size_t>(needed / 2)});
  expect_error(CRUMBLE_E_NO_MEMORY, {}, [] { use(); });
  expect_error(CRUMBLE_E_OUT_OF_RANGE, {"4096"}, [&] { c::memory_use_block({room.data(), 64}); });
}

TEST_F(HppMemory, IsSetBeforeThereAreObjects) {
  Counting counting;
  {
    const c::Mesh mesh = c::Mesh::create_paper(CRUMBLE_PAPER_CUBE);
    expect_error(CRUMBLE_E_IN_USE, {"blocks"}, [&] { c::memory_set_source(c::memory_source_of(counting)); });
  }
  EXPECT_EQ(counting.taken, 0);
}

}  // namespace
}  // namespace crumble
