// Handles: the table itself with small numbers, then every misuse of the API's handles.
#include "handles.hpp"

#include <atomic>
#include <chrono>
#include <thread>

#include "capi/rig.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/random.hpp"

namespace crumble {
namespace {

using capi::HandleLayout;
using capi::HandleTable;

TEST(HandleTable, NeverGivesAHandleTwiceAndLeavesWornSlots) {
  static constinit HandleTable table(5, HandleLayout{1, 2, 6});  // 2 slots of 3 generations
  int object = 0;
  void* found = nullptr;
  Vector<void*> given;
  for (int i = 0; i < 6; ++i) {
    given.push_back(table.insert(&object));
    for (int j = 0; j < i; ++j) {
      EXPECT_NE(given[i], given[j]);
      EXPECT_RESULT(CRUMBLE_E_STALE_HANDLE, table.acquire(given[j], found));
    }
    ASSERT_OK(table.acquire(given[i], found));
    EXPECT_EQ(found, &object);
    table.remove(given[i]);
  }
  try {
    table.insert(&object);
    ADD_FAILURE() << "the table is worn out";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Code::too_large);
  }
}

TEST(HandleTable, WorksWithTheBitsOf32BitHosts) {
  static constinit HandleTable table(2, HandleLayout{12, 14, 6});
  Vector<int> objects(4096);
  Vector<void*> handles;
  for (int& object : objects) handles.push_back(table.insert(&object));
  for (std::size_t i = 0; i < objects.size(); ++i) {
    EXPECT_LE(reinterpret_cast<std::uintptr_t>(handles[i]), 0xffffffffu);
    void* found = nullptr;
    ASSERT_OK(table.acquire(handles[i], found));
    EXPECT_EQ(found, &objects[i]);
    table.release(handles[i]);
  }
  EXPECT_THROW(table.insert(&objects[0]), Error);
}

TEST(HandleTable, HoldsAnObjectForOneCallerAtATime) {
  static constinit HandleTable table(1);
  int object = 0;
  void *const handle = table.insert(&object), *found = nullptr;
  ASSERT_OK(table.acquire(handle, found));
  EXPECT_RESULT(CRUMBLE_E_BUSY, table.acquire(handle, found));
  table.release(handle);
  EXPECT_RESULT(CRUMBLE_OK, table.acquire(handle, found));
}

// Whoever looks needs the object alive, not for himself: only its removal has to wait.
TEST(HandleTable, IsLookedAtWhileTaken) {
  static constinit HandleTable table(3);
  int object = 0;
  void *const handle = table.insert(&object), *found = nullptr, *seen = nullptr;
  ASSERT_OK(table.acquire(handle, found));
  ASSERT_OK(table.look(handle, seen));
  EXPECT_EQ(seen, &object);
  EXPECT_RESULT(CRUMBLE_OK, table.look(handle, seen));
  table.leave(handle);
  std::atomic<bool> removed = false;
  std::thread remover([&] {
    table.remove(handle);
    removed = true;
  });
  while (table.look(handle, seen) == CRUMBLE_OK) table.leave(handle);  // until it is stale
  EXPECT_RESULT(CRUMBLE_E_STALE_HANDLE, table.look(handle, seen));
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_FALSE(removed) << "somebody still looks";
  table.leave(handle);
  remover.join();
  EXPECT_TRUE(removed);
  EXPECT_RESULT(CRUMBLE_E_BAD_HANDLE, table.look(&object, seen));
}

class Handles : public CapiTest {
 protected:
  // What every function that takes a sim says of `handle`; all must say the same.
  static crumble_result verdict(crumble_sim handle) {
    crumble_sim_def some_def{};
    some_def.struct_size = sizeof some_def;
    crumble_tool_def some_tool{};
    some_tool.struct_size = sizeof some_tool;
    crumble_wall_def some_wall{};
    some_wall.struct_size = sizeof some_wall;
    const std::uint32_t node = 0;
    const crumble_pose pose = pose_at(0);
    crumble_wrench wrench{};
    crumble_step_info info{};
    crumble_counters counters{};
    crumble_profile profile{};
    crumble_surface_info surface{};
    info.struct_size = sizeof info, counters.struct_size = sizeof counters, profile.struct_size = sizeof profile,
    surface.struct_size = sizeof surface;
    crumble_view view{};
    crumble_reader reader = nullptr;
    std::uint64_t bytes = 0;
    std::uint32_t count = 0;
    crumble_local_model model{};
    double drag = 0;
    const double force[3] = {0, 0, 0};
    const crumble_result results[] = {crumble_sim_get_def(handle, &some_def),
                                      crumble_sim_configure(handle, &some_def),
                                      crumble_sim_add_tool(handle, &some_tool, nullptr),
                                      crumble_sim_add_wall(handle, &some_wall),
                                      crumble_sim_fix_nodes(handle, &node, 1),
                                      crumble_sim_fix_below(handle, 0),
                                      crumble_sim_apply_paper_preset(handle),
                                      crumble_sim_step(handle, &pose, &wrench),
                                      crumble_sim_step_tools(handle, &pose, &wrench, 1),
                                      crumble_sim_get_step_info(handle, &info),
                                      crumble_sim_get_counters(handle, &counters),
                                      crumble_sim_get_profile(handle, &profile),
                                      crumble_sim_reset(handle),
                                      crumble_sim_get_view(handle, CRUMBLE_ARRAY_INTACT, &view),
                                      crumble_sim_copy(handle, CRUMBLE_ARRAY_INTACT, nullptr, 0, &bytes),
                                      crumble_sim_count_fragments(handle, &count),
                                      crumble_sim_extract_surface(handle, &surface),
                                      crumble_sim_set_fragment_state(handle, 0, CRUMBLE_FRAGMENT_ACTIVE),
                                      crumble_sim_get_fragment_state(handle, 0, &count),
                                      crumble_sim_find_debris(handle, 1, 0, &view),
                                      crumble_sim_publish(handle),
                                      crumble_sim_get_contacts(handle, nullptr, 0, &count),
                                      crumble_sim_get_local_model(handle, 0, &model),
                                      crumble_sim_get_held_drag(handle, 0, &drag),
                                      crumble_sim_set_node_forces(handle, nullptr, 0),
                                      crumble_sim_set_node_force(handle, 0, force),
                                      crumble_reader_create(handle, nullptr, &reader),
                                      crumble_sim_snapshot(handle, nullptr, 0, &bytes),
                                      crumble_sim_restore(handle, &node, sizeof node),
                                      crumble_sim_state_hash(handle, &bytes),
                                      crumble_sim_begin_recording(handle),
                                      crumble_sim_save_recording(handle, "never-written"),
                                      crumble_sim_end_recording(handle)};
    for (const crumble_result result : results) EXPECT_EQ(name_of(result), name_of(results[0]));
    return results[0];
  }
};

TEST_F(Handles, EveryFunctionAnswersBadHandles) {
  EXPECT_RESULT(CRUMBLE_E_NULL, verdict(nullptr));
  EXPECT_RESULT(CRUMBLE_E_BAD_HANDLE, verdict(reinterpret_cast<crumble_sim>(mesh)));
  EXPECT_RESULT(CRUMBLE_E_BAD_HANDLE, verdict(reinterpret_cast<crumble_sim>(&sim)));
  crumble_sim gone = make_sim();
  ASSERT_OK(crumble_sim_destroy(gone));
  EXPECT_RESULT(CRUMBLE_E_STALE_HANDLE, verdict(gone));
}

TEST_F(Handles, MeshFunctionsAnswerToo) {
  crumble_mesh gone = nullptr, out = nullptr;
  ASSERT_OK(cube.create(&gone));
  ASSERT_OK(crumble_mesh_destroy(gone));
  const auto expect_all = [&](crumble_result expected, crumble_mesh handle) {
    crumble_mesh_info info{};
    info.struct_size = sizeof info;
    crumble_view view{};
    std::uint64_t bytes = 0;
    crumble_sim made = nullptr;
    EXPECT_RESULT(expected, crumble_mesh_get_info(handle, &info));
    EXPECT_RESULT(expected, crumble_mesh_get_view(handle, CRUMBLE_ARRAY_SPRINGS, &view));
    EXPECT_RESULT(expected, crumble_mesh_copy(handle, CRUMBLE_ARRAY_SPRINGS, nullptr, 0, &bytes));
    EXPECT_RESULT(expected, crumble_sim_create(handle, nullptr, &made));
    EXPECT_EQ(made, nullptr);
  };
  expect_all(CRUMBLE_E_NULL, nullptr);
  expect_all(CRUMBLE_E_STALE_HANDLE, gone);
  expect_all(CRUMBLE_E_BAD_HANDLE, reinterpret_cast<crumble_mesh>(sim));
  EXPECT_EQ(out, nullptr);
}

TEST_F(Handles, DestroyIsSafeToRepeat) {
  EXPECT_RESULT(CRUMBLE_OK, crumble_sim_destroy(nullptr));
  EXPECT_RESULT(CRUMBLE_OK, crumble_mesh_destroy(nullptr));
  crumble_sim gone = make_sim();
  EXPECT_RESULT(CRUMBLE_OK, crumble_sim_destroy(gone));
  expect_failure(CRUMBLE_E_STALE_HANDLE, crumble_sim_destroy(gone), {"crumble_sim_destroy", "destroyed"});
  crumble_sim next = make_sim();  // takes the place of the first
  EXPECT_NE(next, gone);
  EXPECT_RESULT(CRUMBLE_E_STALE_HANDLE, crumble_sim_destroy(gone));
  EXPECT_RESULT(CRUMBLE_OK, crumble_sim_destroy(next));
  EXPECT_RESULT(CRUMBLE_E_BAD_HANDLE, crumble_mesh_destroy(reinterpret_cast<crumble_mesh>(sim)));
}

TEST_F(Handles, AMillionRandomValuesCrashNothing) {
  Random random(7);
  std::uint64_t hash = 0;
  const auto living = reinterpret_cast<std::uintptr_t>(sim);
  for (int i = 0; i < 1'000'000; ++i) {
    std::uintptr_t value = random.next();
    if (i % 2) value = living ^ (value >> 40 & value);  // near misses: few bits of the low 24
    if (i % 4 == 3) value = living ^ (std::uintptr_t{1} << i % 64) ^ (std::uintptr_t{1} << (i / 64) % 64);
    if (value == living || value == 0) continue;
    const crumble_result result = crumble_sim_state_hash(reinterpret_cast<crumble_sim>(value), &hash);
    ASSERT_TRUE(result == CRUMBLE_E_BAD_HANDLE || result == CRUMBLE_E_STALE_HANDLE) << value << name_of(result);
  }
  EXPECT_EQ(hash, 0u);
}

TEST_F(Handles, AMeshMayGoBeforeItsSimulation) {
  crumble_mesh other = nullptr;
  ASSERT_OK(cube.create(&other));
  crumble_sim made = nullptr;
  ASSERT_OK(crumble_sim_create(other, nullptr, &made));
  ASSERT_OK(crumble_mesh_destroy(other));
  EXPECT_RESULT(CRUMBLE_OK, crumble_sim_step_tools(made, nullptr, nullptr, 0));
  EXPECT_RESULT(CRUMBLE_OK, crumble_sim_extract_surface(made, nullptr));
  EXPECT_RESULT(CRUMBLE_OK, crumble_sim_destroy(made));
}

}  // namespace
}  // namespace crumble
