// The host's memory, and what happens when it has none left.
#include <cstdlib>
#include <functional>
#include <map>
#include <mutex>
#include <vector>

#include "capi/rig.hpp"
#include "support/long_lane.hpp"

namespace crumble {
namespace {

// Counts, keeps books, and refuses the n-th, once or from then on.
struct Host {
  std::mutex mutex;
  std::map<void*, std::uint64_t> out;
  std::uint64_t takes = 0, bytes = 0, refuse_at = 0;
  bool and_after = false;

  static void* take(std::uint64_t bytes, std::uint64_t alignment, void* user) {
    auto& host = *static_cast<Host*>(user);
    const std::lock_guard lock(host.mutex);
    ++host.takes;
    if (host.refuse_at != 0 && (host.takes == host.refuse_at || (host.and_after && host.takes > host.refuse_at))) {
      return nullptr;
    }
    const std::size_t unit = std::max<std::size_t>(alignment, sizeof(void*));
    void* const memory = std::aligned_alloc(unit, (bytes + unit - 1) / unit * unit);
    host.out[memory] = bytes;
    host.bytes += bytes;
    return memory;
  }
  static void give_back(void* memory, std::uint64_t bytes, std::uint64_t, void* user) {
    auto& host = *static_cast<Host*>(user);
    const std::lock_guard lock(host.mutex);
    EXPECT_EQ(host.out.at(memory), bytes);
    host.out.erase(memory);
    std::free(memory);
  }
  crumble_memory_source source() {
    crumble_memory_source s{};
    s.struct_size = sizeof s;
    s.take = take, s.give_back = give_back, s.user = this;
    return s;
  }
};

crumble_memory_info memory() {
  crumble_memory_info info{};
  info.struct_size = sizeof info;
  EXPECT_RESULT(CRUMBLE_OK, crumble_memory_get_info(&info));
  return info;
}

// Everything that takes memory, each object destroyed whatever happened to the others.
crumble_result use_everything(const Cube& cube) {
  crumble_mesh mesh = nullptr;
  crumble_sim sim = nullptr;
  crumble_reader reader = nullptr;
  crumble_device device = nullptr;
  crumble_loop loop = nullptr;
  crumble_tool_def tool{};
  crumble_device_def which{};
  crumble_loop_def how{};
  crumble_hand_def hand{};
  crumble_sim_def def{};
  crumble_wrench wrench{};
  EXPECT_RESULT(CRUMBLE_OK, crumble_tool_def_init(&tool, sizeof tool));
  EXPECT_RESULT(CRUMBLE_OK, crumble_device_def_init(&which, sizeof which));
  EXPECT_RESULT(CRUMBLE_OK, crumble_loop_def_init(&how, sizeof how));
  EXPECT_RESULT(CRUMBLE_OK, crumble_hand_def_init(&hand, sizeof hand));
  EXPECT_RESULT(CRUMBLE_OK, crumble_sim_def_init(&def, sizeof def));
  def.length_limit = 1.05;
  how.driver = CRUMBLE_DRIVER_HOST;
  which.start.position[1] = 0.05;
  const auto press = [&] {
    crumble_result result = CRUMBLE_OK;
    for (int step = 0; step < 40 && result == CRUMBLE_OK; ++step) {
      const crumble_pose pose{{0, 0.034 - 1e-4 * step, 0}, {1, 0, 0, 0}};
      result = crumble_sim_step(sim, &pose, &wrench);
    }
    return result;
  };
  const std::vector<std::function<crumble_result()>> calls{
      [&] { return cube.create(&mesh); },
      [&] { return crumble_sim_create(mesh, &def, &sim); },
      [&] { return crumble_sim_add_tool(sim, &tool, nullptr); },
      [&] { return crumble_sim_fix_below(sim, 1e-6); },
      [&] { return crumble_reader_create(sim, nullptr, &reader); },
      [&] { return crumble_sim_begin_recording(sim); },
      press,
      [&] { return crumble_sim_extract_surface(sim, nullptr); },
      [&] { return crumble_reader_update(reader, nullptr); },
      [&] { return crumble_sim_set_friction(sim, 0, 1, 0.5); },
      [&] { return crumble_sim_end_recording(sim); },
      [&] { return crumble_device_open(&which, &device); },
      [&] {
        hand.device = device;
        return crumble_loop_create(sim, &how, &hand, 1, &loop);
      },
      [&] { return crumble_loop_start(loop); },
      [&] { return crumble_loop_set_friction(loop, 0, 2, 1); },
      [&] { return crumble_loop_tick(loop); },
  };
  crumble_result first = CRUMBLE_OK;
  for (const auto& call : calls) {
    if (first == CRUMBLE_OK) first = call();
  }
  const std::string text = crumble_last_error();
  for (const crumble_result result :
       {crumble_loop_destroy(loop), crumble_device_destroy(device), crumble_reader_destroy(reader),
        crumble_sim_destroy(sim), crumble_mesh_destroy(mesh)}) {
    EXPECT_RESULT(CRUMBLE_OK, result) << "after " << text;
  }
  return first;
}

class CapiMemory : public testing::Test {
 protected:
  void TearDown() override { EXPECT_RESULT(CRUMBLE_OK, crumble_memory_set_source(nullptr)); }
  Host host;
};

TEST_F(CapiMemory, AllOfItComesFromTheHostAndGoesBack) {
  const crumble_memory_source source = host.source();
  ASSERT_OK(crumble_memory_set_source(&source));
  ASSERT_OK(use_everything(Cube(4)));
  EXPECT_GT(host.takes, 300u);
  EXPECT_TRUE(host.out.empty());
  EXPECT_EQ(memory().blocks, 0u);
  EXPECT_EQ(memory().bytes, 0u);
  EXPECT_GT(memory().most_bytes, 100000u);
}

// An allocation fails once, and in another run all from there on: the call says so, nothing leaks, and the library
// works afterwards. 400 of them, spread over all; in scripts/test-long every single one.
TEST_F(CapiMemory, NoneLeftIsAnsweredWhereverItHappens) {
  const Cube cube(2);
  const crumble_memory_source source = host.source();
  ASSERT_OK(crumble_memory_set_source(&source));
  ASSERT_OK(use_everything(cube));  // with what only the first call of a process takes
  host.takes = 0;
  ASSERT_OK(use_everything(cube));
  const std::uint64_t takes = host.takes;
  const std::uint64_t stride = is_long_lane() ? 1 : takes / 400 + 1;
  for (const bool and_after : {false, true}) {
    for (std::uint64_t n = 1; n <= takes; n += stride) {
      host.takes = 0, host.refuse_at = n, host.and_after = and_after;
      const crumble_result result = use_everything(cube);
      host.refuse_at = 0;
      ASSERT_EQ(name_of(CRUMBLE_E_NO_MEMORY), name_of(result)) << "allocation " << n << ": " << crumble_last_error();
      ASSERT_TRUE(host.out.empty()) << "allocation " << n << " leaks " << host.out.size();
    }
  }
  ASSERT_OK(use_everything(cube));
}

TEST_F(CapiMemory, ABlockIsAllThatIsUsed) {
  std::vector<std::byte> room(8 << 20);
  ASSERT_OK(crumble_memory_use_block(room.data(), room.size()));
  const std::uint64_t at_first = memory().longest_free;
  EXPECT_GT(at_first, room.size() - 4096);
  for (int again = 0; again < 3; ++again) ASSERT_OK(use_everything(Cube(4)));
  EXPECT_EQ(memory().longest_free, at_first);
  const std::uint64_t needed = memory().most_bytes;
  EXPECT_LT(needed, room.size());

  ASSERT_OK(crumble_memory_use_block(room.data(), needed / 2));
  EXPECT_RESULT(CRUMBLE_E_NO_MEMORY, use_everything(Cube(4)));
  EXPECT_EQ(memory().blocks, 0u);
}

TEST_F(CapiMemory, MisuseIsAnswered) {
  crumble_memory_source source = host.source();
  source.take = nullptr;
  expect_failure(CRUMBLE_E_NULL, crumble_memory_set_source(&source), {"crumble_memory_set_source", "source.take"});
  source = host.source();
  source.give_back = nullptr;
  expect_failure(CRUMBLE_E_NULL, crumble_memory_set_source(&source), {"source.give_back"});
  source = host.source();
  source.reserved = 1;
  expect_failure(CRUMBLE_E_OUT_OF_RANGE, crumble_memory_set_source(&source), {"source.reserved"});
  source = host.source();
  source.struct_size = 0;
  expect_failure(CRUMBLE_E_UNINITIALIZED, crumble_memory_set_source(&source), {"source.struct_size"});
  std::byte few[64];
  expect_failure(CRUMBLE_E_NULL, crumble_memory_use_block(nullptr, 1 << 20), {"memory"});
  expect_failure(CRUMBLE_E_OUT_OF_RANGE, crumble_memory_use_block(few, sizeof few), {"4096", "64"});
  expect_failure(CRUMBLE_E_NULL, crumble_memory_get_info(nullptr), {"info"});

  source = host.source();
  ASSERT_OK(crumble_memory_set_source(&source));
  crumble_mesh mesh = nullptr;
  ASSERT_OK(Cube(2).create(&mesh));
  expect_failure(CRUMBLE_E_IN_USE, crumble_memory_set_source(nullptr), {"blocks"});
  expect_failure(CRUMBLE_E_IN_USE, crumble_memory_use_block(few, 4096), {"blocks"});
  const std::size_t before = host.out.size();
  EXPECT_GT(before, 0u);
  ASSERT_OK(crumble_mesh_destroy(mesh));
  EXPECT_TRUE(host.out.empty()) << "the source was not changed by calls that failed";
}

// ---- The log ----

struct Line {
  std::uint32_t level;
  std::string text;
};

class CapiLog : public CapiTest {
 protected:
  void SetUp() override {
    CapiTest::SetUp();
    ASSERT_OK(crumble_log_set(
        [](std::uint32_t level, const char* text, void* user) {
          static_cast<std::vector<Line>*>(user)->push_back({level, text});
        },
        &lines));
  }
  void TearDown() override {
    EXPECT_RESULT(CRUMBLE_OK, crumble_log_set(nullptr, nullptr));
    CapiTest::TearDown();
  }
  std::vector<Line> lines;
};

TEST_F(CapiLog, TellsOfEveryFailureOnceButNotInSteps) {
  def.stiffness = -1;
  crumble_sim none = nullptr;
  EXPECT_RESULT(CRUMBLE_E_OUT_OF_RANGE, crumble_sim_create(mesh, &def, &none));
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].level, std::uint32_t{CRUMBLE_LOG_ERROR});
  EXPECT_EQ(lines[0].text, crumble_last_error());
  EXPECT_NE(lines[0].text.find("stiffness"), std::string::npos);
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_sim_create(nullptr, nullptr, &none));  // refused two calls deep
  EXPECT_EQ(lines.size(), 2u);
  crumble_pose bad{{kNan, 0, 0}, {1, 0, 0, 0}};
  EXPECT_RESULT(CRUMBLE_E_BAD_POSE, crumble_sim_step(sim, &bad, &wrench));
  EXPECT_RESULT(CRUMBLE_E_BAD_POSE, crumble_sim_advance(sim, &bad, &wrench, 1, 3, 0, nullptr));
  EXPECT_EQ(lines.size(), 2u);
}

TEST_F(CapiLog, TellsWhatWasOpenedAndWhatWillNotBeAsWished) {
  crumble_device_def which{};
  crumble_hand_def hand{};
  crumble_loop_def how{};
  ASSERT_OK(crumble_device_def_init(&which, sizeof which));
  ASSERT_OK(crumble_hand_def_init(&hand, sizeof hand));
  ASSERT_OK(crumble_loop_def_init(&how, sizeof how));
  crumble_motion_point point{};
  which.kind = CRUMBLE_DEVICE_HAND, which.points = &point, which.point_count = 1;
  ASSERT_OK(crumble_device_open(&which, &hand.device));
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].level, std::uint32_t{CRUMBLE_LOG_NOTE});
  EXPECT_EQ(lines[0].text.find("opened "), 0u);
  hand.coupling_stiffness = 100000;  // more than sampling bears
  crumble_loop loop = nullptr;
  ASSERT_OK(crumble_loop_create(sim, &how, &hand, 1, &loop));
  crumble_loop_status status{};
  status.struct_size = sizeof status;
  ASSERT_OK(crumble_loop_get_status(loop, &status));
  ASSERT_GT(status.warning_count, 0u);
  ASSERT_EQ(lines.size(), 1u + status.warning_count);
  EXPECT_EQ(lines[1].level, std::uint32_t{CRUMBLE_LOG_WARNING});
  lines.clear();
  ASSERT_OK(crumble_loop_start(loop));
  ASSERT_OK(crumble_loop_stop(loop));
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_NE(lines[0].text.find("SCHED"), std::string::npos) << lines[0].text;
  ASSERT_OK(crumble_loop_destroy(loop));
  ASSERT_OK(crumble_device_destroy(hand.device));
}

TEST_F(CapiLog, MayCallTheApiAndFailThere) {
  ASSERT_OK(crumble_log_set(
      [](std::uint32_t, const char* text, void* user) {
        static_cast<std::vector<Line>*>(user)->push_back({0, text});
        if (std::string_view(text).find("crumble_mesh_destroy") == std::string_view::npos) {
          crumble_mesh_destroy(reinterpret_cast<crumble_mesh>(std::uintptr_t{12345}));
        }
      },
      &lines));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_sim_reset(nullptr));
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_NE(lines[0].text.find("crumble_sim_reset"), std::string::npos);
  EXPECT_NE(lines[1].text.find("crumble_mesh_destroy"), std::string::npos);
  EXPECT_EQ(lines[0].text, crumble_last_error()) << "the host's own failure";
}

}  // namespace
}  // namespace crumble
