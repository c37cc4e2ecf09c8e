// The thread rules: one thread in an object, any number beside each other, and to each its own error text.
#include <atomic>
#include <thread>

#include "capi/rig.hpp"
#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

TEST(Threads, TheSecondInAnObjectIsTurnedAway) {
  const Cube cube(10);
  crumble_mesh mesh = nullptr;
  crumble_sim sim = nullptr;
  ASSERT_OK(cube.create(&mesh));
  ASSERT_OK(crumble_sim_create(mesh, nullptr, &sim));
  std::atomic<bool> stop = false;
  std::thread first([&] {
    while (!stop) crumble_sim_fix_below(sim, 0);  // takes milliseconds each time
  });
  crumble_counters counters{};
  counters.struct_size = sizeof counters;
  crumble_result result = CRUMBLE_OK;
  for (int i = 0; i < 50'000'000 && result == CRUMBLE_OK; ++i) result = crumble_sim_get_counters(sim, &counters);
  expect_failure(CRUMBLE_E_BUSY, result, {"crumble_sim_get_counters", "another thread"});
  stop = true;
  first.join();
  EXPECT_RESULT(CRUMBLE_OK, crumble_sim_destroy(sim));
  EXPECT_RESULT(CRUMBLE_OK, crumble_mesh_destroy(mesh));
}

TEST_F(CapiTest, ErrorTextsBelongToTheirThread) {
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_sim_state_hash(sim, nullptr));
  const std::string here = crumble_last_error();
  EXPECT_EQ(here, "crumble_sim_state_hash: hash must not be NULL");
  std::string before, after;
  std::thread([&] {
    before = crumble_last_error();
    crumble_sim_reset(nullptr);
    after = crumble_last_error();
  }).join();
  EXPECT_EQ(before, "");
  EXPECT_EQ(after, "crumble_sim_reset: sim must not be NULL");
  EXPECT_EQ(crumble_last_error(), here);
  ASSERT_OK(crumble_sim_reset(sim));
  EXPECT_EQ(crumble_last_error(), here) << "success leaves the text";
}

TEST(Threads, ManyMakeAndDestroyAtOnce) {
  const Cube cube(1);
  Vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&] {
      for (int i = 0; i < 200; ++i) {
        crumble_mesh mesh = nullptr;
        crumble_sim sim = nullptr;
        ASSERT_OK(cube.create(&mesh));
        ASSERT_OK(crumble_sim_create(mesh, nullptr, &sim));
        ASSERT_OK(crumble_sim_step_tools(sim, nullptr, nullptr, 0));
        ASSERT_OK(crumble_sim_destroy(sim));
        ASSERT_OK(crumble_mesh_destroy(mesh));
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
}

}  // namespace
}  // namespace crumble
