// Readers and fragments through C, against the same through C++.
#include <algorithm>
#include <atomic>
#include <cstring>
#include <thread>

#include "capi/rig.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/fracture/fragments.hpp"
#include "crumble/fracture/surface.hpp"
#include "crumble/geometry/triangle_mesh.hpp"
#include "support/allocation_counter.hpp"

namespace crumble {
namespace {

template <class T>
Vector<T> rows_of(const crumble_view& view) {
  const T* first = static_cast<const T*>(view.data);
  return {first, first + view.count * view.components};
}

class Readers : public CapiTest {
 protected:
  using CapiTest::CapiTest;
  void SetUp() override {
    CapiTest::SetUp();
    ASSERT_OK(crumble_reader_create(sim, nullptr, &reader));
  }
  void TearDown() override {
    EXPECT_RESULT(CRUMBLE_OK, crumble_reader_destroy(reader));
    CapiTest::TearDown();
  }
  crumble_reader_info update(crumble_reader of = nullptr) {
    crumble_reader_info info{};
    info.struct_size = sizeof info;
    EXPECT_RESULT(CRUMBLE_OK, crumble_reader_update(of ? of : reader, &info));
    return info;
  }
  crumble_view view(std::uint32_t which, crumble_reader of = nullptr) {
    crumble_view out{};
    EXPECT_RESULT(CRUMBLE_OK, crumble_reader_get_view(of ? of : reader, which, &out));
    return out;
  }
  template <class T>
  Vector<T> array(std::uint32_t which, crumble_reader of = nullptr) {
    return rows_of<T>(view(which, of));
  }
  crumble_fragment_info fragment(std::uint32_t id) {
    crumble_fragment_info info{};
    info.struct_size = sizeof info;
    EXPECT_RESULT(CRUMBLE_OK, crumble_reader_get_fragment(reader, id, &info));
    return info;
  }
  Vector<std::uint32_t> list(std::uint32_t id, std::uint32_t which) {
    crumble_view out{};
    EXPECT_RESULT(CRUMBLE_OK, crumble_reader_get_fragment_list(reader, id, which, &out));
    return rows_of<std::uint32_t>(out);
  }
  TriangleMesh surface(crumble_reader of = nullptr) {
    TriangleMesh mesh_of;
    const auto p = array<double>(CRUMBLE_ARRAY_SURFACE_POSITIONS, of);
    for (std::size_t v = 0; v < p.size(); v += 3) mesh_of.vertices.push_back({p[v], p[v + 1], p[v + 2]});
    const auto t = array<std::uint32_t>(CRUMBLE_ARRAY_SURFACE_TRIANGLES, of);
    for (std::size_t i = 0; i < t.size(); i += 3) mesh_of.triangles.push_back({t[i], t[i + 1], t[i + 2]});
    return mesh_of;
  }
  void break_up() {
    press(1, 1200);
    for (int step = 1200; step > 700; --step) press(step, step);  // and up again, so that nothing is held
    ASSERT_OK(crumble_sim_publish(sim));
    update();
  }

  crumble_reader reader = nullptr;
};

TEST_F(Readers, SeeTheStateThatWasPublished) {
  EXPECT_EQ(update().step, 0u);
  press(1, 300);
  ASSERT_OK(crumble_sim_publish(sim));
  const crumble_reader_info info = update();
  EXPECT_EQ(info.step, 300u);
  EXPECT_EQ(info.first_step, 300u);
  EXPECT_EQ(info.cuts, counters().cuts);
  EXPECT_GT(info.cuts, 0u);
  for (const std::uint32_t which : {CRUMBLE_ARRAY_POSITIONS_X, CRUMBLE_ARRAY_POSITIONS_Y, CRUMBLE_ARRAY_POSITIONS_Z}) {
    crumble_view direct{};
    ASSERT_OK(crumble_sim_get_view(sim, which, &direct));
    EXPECT_EQ(array<double>(which), rows_of<double>(direct));
  }
  Vector<double> rows(3 * cube.node_count()), direct(rows);
  const std::uint64_t bytes = rows.size() * sizeof(double);
  ASSERT_OK(crumble_reader_copy(reader, CRUMBLE_ARRAY_POSITIONS, rows.data(), bytes, nullptr));
  ASSERT_OK(crumble_sim_copy(sim, CRUMBLE_ARRAY_POSITIONS, direct.data(), bytes, nullptr));
  EXPECT_EQ(rows, direct);
  crumble_view intact{};
  ASSERT_OK(crumble_sim_get_view(sim, CRUMBLE_ARRAY_INTACT, &intact));
  EXPECT_EQ(array<std::uint8_t>(CRUMBLE_ARRAY_INTACT), rows_of<std::uint8_t>(intact));
}

TEST_F(Readers, GetNothingTheyHaveNotAskedFor) {
  update();      // asks
  press(1, 40);  // published once, in the first step of the next sixtieth of a second
  EXPECT_EQ(update().step, 17u);
  press(41, 60);
  EXPECT_EQ(update().step, 41u);
}

TEST_F(Readers, TheirSurfaceIsClosedInEveryMode) {
  crumble_reader_def reader_def{};
  ASSERT_OK(crumble_reader_def_init(&reader_def, sizeof reader_def));
  EXPECT_EQ(reader_def.settle, 0.05);
  reader_def.surface_mode = CRUMBLE_SURFACE_FRAGMENTS;
  crumble_reader whole = nullptr, paper = nullptr;
  ASSERT_OK(crumble_reader_create(sim, &reader_def, &whole));
  reader_def.surface_mode = CRUMBLE_SURFACE_PAPER;
  ASSERT_OK(crumble_reader_create(sim, &reader_def, &paper));
  bool differ = false;
  for (int step = 0; step < 1000; step += 50) {
    press(step + 1, step + 50);
    ASSERT_OK(crumble_sim_publish(sim));
    const crumble_reader_info cracks = update(), pieces = update(whole), drawn = update(paper);
    EXPECT_EQ(find_surface_defects(surface()).total(), 0u);
    EXPECT_EQ(find_surface_defects(surface(whole)).total(), 0u);
    EXPECT_EQ(find_surface_defects(surface(paper)).open_edges, 0u);
    EXPECT_EQ(surface().triangles.size(), cracks.triangle_count);
    EXPECT_LE(pieces.triangle_count, cracks.triangle_count);
    differ = differ || (pieces.triangle_count < cracks.triangle_count && drawn.triangle_count != cracks.triangle_count);
  }
  EXPECT_TRUE(differ);
  EXPECT_RESULT(CRUMBLE_OK, crumble_reader_destroy(whole));
  EXPECT_RESULT(CRUMBLE_OK, crumble_reader_destroy(paper));
}

// A renderer that uploads only what is said to have changed has the same arrays in the end.
TEST_F(Readers, ChangesAreAllThatChanges) {
  update();
  Vector<std::uint32_t> triangles = array<std::uint32_t>(CRUMBLE_ARRAY_SURFACE_TRIANGLES);
  Vector<double> rest = array<double>(CRUMBLE_ARRAY_SURFACE_REST_POSITIONS);
  std::size_t changed = 0;
  for (int step = 0; step < 600; step += 20) {
    press(step + 1, step + 20);
    ASSERT_OK(crumble_sim_publish(sim));
    const crumble_reader_info info = update();
    const auto now = array<std::uint32_t>(CRUMBLE_ARRAY_SURFACE_TRIANGLES);
    triangles.resize(now.size());
    rest.resize(3 * std::size_t{info.vertex_count});
    for (const std::uint32_t t : array<std::uint32_t>(CRUMBLE_ARRAY_SURFACE_CHANGED_TRIANGLES)) {
      ++changed;
      std::copy_n(now.begin() + 3 * t, 3, triangles.begin() + 3 * t);
    }
    const auto rest_now = array<double>(CRUMBLE_ARRAY_SURFACE_REST_POSITIONS);
    for (const std::uint32_t v : array<std::uint32_t>(CRUMBLE_ARRAY_SURFACE_CHANGED_VERTICES)) {
      std::copy_n(rest_now.begin() + 3 * v, 3, rest.begin() + 3 * v);
    }
    ASSERT_EQ(triangles, now);
    ASSERT_EQ(rest, rest_now);
  }
  EXPECT_GT(changed, 100u);
}

TEST_F(Readers, FragmentsAreMeasuredAndListed) {
  break_up();
  const crumble_reader_info info = update();
  ASSERT_GT(info.fragment_count, 1u);
  std::uint32_t nodes = 0, triangles = 0;
  double volume = 0, mass = 0;
  const auto labels = array<std::uint32_t>(CRUMBLE_ARRAY_NODE_FRAGMENTS);
  const TriangleMesh whole = surface();
  for (std::uint32_t f = 0; f < info.fragment_count; ++f) {
    const crumble_fragment_info about = fragment(f);
    const auto node_list = list(f, CRUMBLE_LIST_NODES);
    ASSERT_EQ(node_list.size(), about.node_count);
    EXPECT_EQ(node_list[0], about.least_node);
    for (const std::uint32_t n : node_list) EXPECT_EQ(labels[n], f);
    EXPECT_EQ(list(f, CRUMBLE_LIST_TETRAHEDRA).size(), about.tetrahedron_count);
    EXPECT_TRUE(f == 0 || about.parent < f);
    EXPECT_EQ(about.state, std::uint32_t{CRUMBLE_FRAGMENT_ACTIVE});
    for (int axis = 0; axis < 3; ++axis) {
      constexpr double kRounding = 1e-15;
      EXPECT_LE(about.low[axis], about.center[axis] + kRounding);
      EXPECT_LE(about.center[axis], about.high[axis] + kRounding);
    }
    TriangleMesh own{whole.vertices, {}};
    for (const std::uint32_t t : list(f, CRUMBLE_LIST_TRIANGLES)) own.triangles.push_back(whole.triangles[t]);
    EXPECT_EQ(find_surface_defects(own).total(), 0u);
    nodes += about.node_count, volume += about.rest_volume, mass += about.mass;
    triangles += static_cast<std::uint32_t>(own.triangles.size());
  }
  EXPECT_EQ(fragment(0).parent, CRUMBLE_NONE);
  EXPECT_EQ(nodes, cube.node_count());
  EXPECT_EQ(triangles, info.triangle_count);
  EXPECT_NEAR(volume, 2.7e-5, 2.7e-5 * 1e-12);
  EXPECT_NEAR(mass, 0.03, 0.03 * 1e-12);
}

TEST_F(Readers, EventsTellTheFamilyTreeAndEveryCut) {
  press(1, 1000);
  Vector<crumble_event> events(100);
  std::uint32_t count = 1, cuts = 0, splits = 0;
  std::uint64_t last = 0;
  while (count > 0) {
    ASSERT_OK(crumble_reader_read_events(reader, events.data(), 100, &count));
    for (std::uint32_t i = 0; i < count; ++i) {
      const crumble_event& event = events[i];
      EXPECT_GE(event.step, last);
      last = event.step;
      cuts += event.kind == CRUMBLE_EVENT_CUT;
      EXPECT_TRUE(event.kind != CRUMBLE_EVENT_CUT || (event.energy > 0 && event.node == CRUMBLE_NONE));
      if (event.kind != CRUMBLE_EVENT_SPLIT) continue;
      EXPECT_EQ(event.fragment, ++splits);
      EXPECT_LT(event.parent, event.fragment);
    }
  }
  EXPECT_EQ(cuts, counters().cuts);
  std::uint32_t fragments = 0;
  ASSERT_OK(crumble_sim_count_fragments(sim, &fragments));
  EXPECT_EQ(splits + 1, fragments);
  EXPECT_EQ(update().dropped_events, 0u);
}

TEST_F(Readers, DebrisSleepsAndGoes) {
  break_up();
  crumble_view found{};
  ASSERT_OK(crumble_sim_find_debris(sim, 100, 1e3, &found));
  const auto debris = rows_of<std::uint32_t>(found);
  ASSERT_GT(debris.size(), 0u);
  ASSERT_OK(crumble_sim_begin_recording(sim));
  ASSERT_OK(crumble_sim_set_fragment_state(sim, debris[0], CRUMBLE_FRAGMENT_ASLEEP));
  std::uint32_t state = 0;
  ASSERT_OK(crumble_sim_get_fragment_state(sim, debris[0], &state));
  EXPECT_EQ(state, std::uint32_t{CRUMBLE_FRAGMENT_ASLEEP});
  EXPECT_EQ(counters().asleep, 1u);
  ASSERT_OK(crumble_sim_set_fragment_state(sim, debris[0], CRUMBLE_FRAGMENT_REMOVED));
  EXPECT_EQ(counters().asleep, 0u);
  EXPECT_EQ(counters().removed, 1u);
  EXPECT_EQ(counters().removed_nodes, fragment(debris[0]).node_count);
  press(1001, 1010);
  ASSERT_OK(crumble_sim_publish(sim));
  update();
  EXPECT_EQ(fragment(debris[0]).node_count, 0u);
  EXPECT_EQ(fragment(debris[0]).least_node, CRUMBLE_NONE);
  EXPECT_EQ(fragment(debris[0]).state, std::uint32_t{CRUMBLE_FRAGMENT_REMOVED});
  EXPECT_TRUE(list(debris[0], CRUMBLE_LIST_TRIANGLES).empty());
  EXPECT_EQ(find_surface_defects(surface()).total(), 0u);
  const std::string path = testing::TempDir() + "crumble_reader_test.crec";
  ASSERT_OK(crumble_sim_save_recording(sim, path.c_str()));
  std::uint64_t steps = 0, equal = 0;
  EXPECT_RESULT(CRUMBLE_OK, crumble_verify_recording(path.c_str(), &steps, &equal));
  EXPECT_EQ(steps, 10u);
  EXPECT_EQ(equal, 10u);
  std::remove(path.c_str());
}

TEST_F(Readers, TextureCoordinatesFollowTheSkin) {
  break_up();
  Vector<float> boundary;
  for (const Triangle& t : cube.mesh.boundary) {
    for (const std::uint32_t n : t) {
      boundary.push_back(static_cast<float>(cube.mesh.positions[n].x()));
      boundary.push_back(static_cast<float>(cube.mesh.positions[n].z()));
    }
  }
  const crumble_reader_info info = update();
  Vector<float> skin(6 * std::size_t{info.skin_triangle_count});
  expect_failure(CRUMBLE_E_BUFFER_TOO_SMALL,
                 crumble_reader_spread_over_skin(reader, boundary.data(), skin.data(), info.skin_triangle_count - 1),
                 {"skin_count", std::to_string(info.skin_triangle_count)});
  ASSERT_OK(crumble_reader_spread_over_skin(reader, boundary.data(), skin.data(), info.skin_triangle_count));
  const auto rest = array<double>(CRUMBLE_ARRAY_SURFACE_REST_POSITIONS);
  const auto triangles = array<std::uint32_t>(CRUMBLE_ARRAY_SURFACE_TRIANGLES);
  for (std::size_t corner = 0; corner < skin.size() / 2; ++corner) {
    ASSERT_NEAR(skin[2 * corner], rest[3 * triangles[corner]], 1e-8);
    ASSERT_NEAR(skin[2 * corner + 1], rest[3 * triangles[corner] + 2], 1e-8);
  }
}

TEST_F(Readers, AnswerMisuse) {
  crumble_view out{};
  std::uint32_t count = 0;
  crumble_fragment_info info{};
  info.struct_size = sizeof info;
  crumble_reader_def bad{};
  crumble_reader made = nullptr;
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_reader_update(nullptr, nullptr));
  EXPECT_RESULT(CRUMBLE_E_BAD_HANDLE, crumble_reader_update(reinterpret_cast<crumble_reader>(sim), nullptr));
  EXPECT_RESULT(CRUMBLE_E_OUT_OF_RANGE, crumble_reader_get_view(reader, CRUMBLE_ARRAY_VELOCITIES_X, &out));
  EXPECT_RESULT(CRUMBLE_E_UNSUPPORTED, crumble_reader_get_view(reader, CRUMBLE_ARRAY_POSITIONS, &out));
  expect_failure(CRUMBLE_E_OUT_OF_RANGE, crumble_reader_get_fragment(reader, 1, &info), {"fragment", "1"});
  EXPECT_RESULT(CRUMBLE_E_OUT_OF_RANGE, crumble_reader_get_fragment_list(reader, 0, 3, &out));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_reader_read_events(reader, nullptr, 1, &count));
  EXPECT_RESULT(CRUMBLE_OK, crumble_reader_read_events(reader, nullptr, 0, &count));
  ASSERT_OK(crumble_reader_def_init(&bad, sizeof bad));
  bad.surface_mode = 3;
  expect_failure(CRUMBLE_E_OUT_OF_RANGE, crumble_reader_create(sim, &bad, &made), {"surface_mode", "3"});
  bad.surface_mode = 0, bad.settle = kNan;
  expect_failure(CRUMBLE_E_INVALID_VALUE, crumble_reader_create(sim, &bad, &made), {"settle"});
  bad.settle = -1;
  expect_failure(CRUMBLE_E_OUT_OF_RANGE, crumble_reader_create(sim, &bad, &made), {"settle", "-1"});
  expect_failure(CRUMBLE_E_OUT_OF_RANGE, crumble_sim_set_fragment_state(sim, 0, 3), {"state", "3"});
  expect_failure(CRUMBLE_E_OUT_OF_RANGE, crumble_sim_set_fragment_state(sim, 7, 1), {"fragment", "7"});
  EXPECT_RESULT(CRUMBLE_E_INVALID_VALUE, crumble_sim_find_debris(sim, 1, kNan, &out));
  expect_failure(CRUMBLE_E_IN_USE, crumble_sim_add_tool(sim, &tool, nullptr), {"1 readers"});
  ASSERT_OK(crumble_reader_create(sim, nullptr, &made));
  ASSERT_OK(crumble_reader_destroy(made));
  EXPECT_RESULT(CRUMBLE_E_STALE_HANDLE, crumble_reader_update(made, nullptr));
  EXPECT_EQ(out.data, nullptr);
}

TEST_F(Readers, TakeNoMemoryOnceTheyAreMade) {
  if (!AllocationCounter::available()) GTEST_SKIP() << "allocations are not counted here";
  const Vector<float> boundary(6 * cube.mesh.boundary.size());
  Vector<float> skin(100 * boundary.size());
  const auto room = static_cast<std::uint32_t>(skin.size() / 6);
  crumble_event events[64];
  crumble_view out{};
  std::uint32_t count = 0;
  const AllocationCounter counter;
  for (int step = 0; step < 1000; step += 50) {
    press(step + 1, step + 50);
    ASSERT_EQ(crumble_sim_publish(sim), CRUMBLE_OK);
    ASSERT_EQ(crumble_reader_update(reader, nullptr), CRUMBLE_OK);
    ASSERT_EQ(crumble_reader_get_view(reader, CRUMBLE_ARRAY_SURFACE_NORMALS, &out), CRUMBLE_OK);
    for (const std::uint32_t which : {CRUMBLE_LIST_NODES, CRUMBLE_LIST_TETRAHEDRA, CRUMBLE_LIST_TRIANGLES}) {
      ASSERT_EQ(crumble_reader_get_fragment_list(reader, 0, which, &out), CRUMBLE_OK);
    }
    crumble_fragment_info about{};
    about.struct_size = sizeof about;
    ASSERT_EQ(crumble_reader_get_fragment(reader, 0, &about), CRUMBLE_OK);
    ASSERT_EQ(crumble_reader_read_events(reader, events, 64, &count), CRUMBLE_OK);
    ASSERT_EQ(crumble_reader_spread_over_skin(reader, boundary.data(), skin.data(), room), CRUMBLE_OK);
    ASSERT_EQ(crumble_sim_find_debris(sim, 8, 1e3, &out), CRUMBLE_OK);
  }
  EXPECT_EQ(counter.count(), 0u);
}

// "A call that fails changes no object and writes no output."
TEST_F(Readers, StayWhereTheyAreWhenAnUpdateFails) {
  const auto at_rest = array<double>(CRUMBLE_ARRAY_POSITIONS_Y);
  press(1, 300);
  ASSERT_OK(crumble_sim_publish(sim));
  crumble_reader_info info{};
  std::memset(&info, 0x55, sizeof info);
  for (const std::uint32_t size : {0u, 12u, 4104u}) {
    info.struct_size = size;
    const crumble_reader_info before = info;
    EXPECT_RESULT(size == 0 ? CRUMBLE_E_UNINITIALIZED : CRUMBLE_E_VERSION, crumble_reader_update(reader, &info));
    EXPECT_EQ(std::memcmp(&info, &before, sizeof info), 0);
    EXPECT_EQ(fragment(0).node_count, cube.node_count());
    EXPECT_EQ(array<double>(CRUMBLE_ARRAY_POSITIONS_Y), at_rest);
  }
  EXPECT_EQ(update().step, 300u);
  EXPECT_NE(array<double>(CRUMBLE_ARRAY_POSITIONS_Y), at_rest);
}

TEST_F(Readers, WriteNothingWhenTheyFail) {
  crumble_fragment_info about{};
  std::memset(&about, 0x55, sizeof about);
  const crumble_fragment_info poison = about;
  about.struct_size = 20;
  EXPECT_RESULT(CRUMBLE_E_VERSION, crumble_reader_get_fragment(reader, 0, &about));
  about.struct_size = sizeof about;
  EXPECT_RESULT(CRUMBLE_E_OUT_OF_RANGE, crumble_reader_get_fragment(reader, CRUMBLE_NONE, &about));
  EXPECT_EQ(std::memcmp(&about.node_count, &poison.node_count, sizeof about - sizeof about.struct_size), 0);
  crumble_view out{reader, 7, 8, 9, 10, 11};
  const crumble_view same = out;
  EXPECT_RESULT(CRUMBLE_E_OUT_OF_RANGE, crumble_reader_get_view(reader, CRUMBLE_NONE, &out));
  EXPECT_RESULT(CRUMBLE_E_OUT_OF_RANGE, crumble_reader_get_fragment_list(reader, CRUMBLE_NONE, 0, &out));
  EXPECT_RESULT(CRUMBLE_E_OUT_OF_RANGE, crumble_reader_get_fragment_list(reader, 0, CRUMBLE_NONE, &out));
  EXPECT_RESULT(CRUMBLE_E_INVALID_VALUE, crumble_sim_find_debris(sim, 1, kNan, &out));
  EXPECT_EQ(std::memcmp(&out, &same, sizeof out), 0);
  std::uint32_t number = 77;
  crumble_event event{};
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_reader_read_events(reader, nullptr, 1, &number));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_reader_read_events(reader, &event, 1, nullptr));
  EXPECT_RESULT(CRUMBLE_E_OUT_OF_RANGE, crumble_sim_get_fragment_state(sim, CRUMBLE_NONE, &number));
  EXPECT_EQ(number, 77u);
  EXPECT_EQ(event.kind, 0u);
  std::uint64_t needed = 0;
  Vector<std::uint8_t> bytes(cube.mesh.springs.size() - 1, 0x55);
  const Vector<std::uint8_t> untouched = bytes;
  EXPECT_RESULT(CRUMBLE_E_BUFFER_TOO_SMALL,
                crumble_reader_copy(reader, CRUMBLE_ARRAY_INTACT, bytes.data(), bytes.size(), &needed));
  EXPECT_EQ(needed, cube.mesh.springs.size());
  EXPECT_RESULT(CRUMBLE_E_OUT_OF_RANGE, crumble_reader_copy(reader, CRUMBLE_NONE, bytes.data(), bytes.size(), &needed));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_reader_copy(reader, CRUMBLE_ARRAY_INTACT, nullptr, 0, nullptr));
  EXPECT_EQ(needed, cube.mesh.springs.size());
  EXPECT_EQ(bytes, untouched);
  crumble_reader made = reader;
  crumble_reader_def settings{};
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, crumble_reader_create(sim, &settings, &made));
  EXPECT_EQ(made, reader);
  expect_failure(CRUMBLE_E_IN_USE, crumble_sim_add_tool(sim, &tool, nullptr),
                 {"1 readers"});  // nor did that leave one behind
}

TEST_F(Readers, OutliveTheirSimulation) {
  crumble_sim other = make_sim();
  crumble_reader orphan = nullptr;
  ASSERT_OK(crumble_reader_create(other, nullptr, &orphan));
  ASSERT_OK(crumble_sim_destroy(other));
  EXPECT_EQ(update(orphan).vertex_count, 218u);
  ASSERT_OK(crumble_reader_destroy(orphan));
}

TEST_F(Readers, ResetAndRestoreReachThem) {
  break_up();
  EXPECT_GT(update().cuts, 0u);
  ASSERT_OK(crumble_sim_reset(sim));
  const crumble_reader_info info = update();
  EXPECT_EQ(info.cuts, 0u);
  EXPECT_EQ(info.triangle_count, 432u);
  EXPECT_EQ(info.surface_rebuilt, 1u);
}

TEST_F(Readers, WorkBesideTheSteppingThread) {
  std::atomic<bool> done{false};
  std::thread drawing([&] {
    std::uint64_t last = 0;
    while (!done) {
      const crumble_reader_info info = update();
      EXPECT_GE(info.step, last);
      last = info.step;
      EXPECT_EQ(find_surface_defects(surface()).total(), 0u);
      std::uint32_t count = 0;
      crumble_event events[16];
      EXPECT_RESULT(CRUMBLE_OK, crumble_reader_read_events(reader, events, 16, &count));
    }
  });
  press(1, 1000);
  done = true;
  drawing.join();
}

// Nothing but is_open tells the thread that makes the next reader that the last one is gone.
TEST_F(Readers, MayBeDestroyedWhileOthersAreMade) {
  std::atomic<crumble_reader> handed_over{nullptr};
  std::atomic<bool> done{false};
  std::thread drawing([&] {
    while (!done) EXPECT_RESULT(CRUMBLE_OK, crumble_reader_destroy(handed_over.exchange(nullptr)));
  });
  for (int i = 0; i < 40; ++i) {
    crumble_reader brief = nullptr;
    EXPECT_RESULT(CRUMBLE_OK, crumble_reader_create(sim, nullptr, &brief));
    EXPECT_RESULT(CRUMBLE_OK, crumble_reader_destroy(handed_over.exchange(brief)));  // if nobody has taken it
  }
  done = true;
  drawing.join();
  EXPECT_RESULT(CRUMBLE_OK, crumble_reader_destroy(handed_over));
  expect_failure(CRUMBLE_E_IN_USE, crumble_sim_add_tool(sim, &tool, nullptr), {"1 readers"});  // the fixture's
}

// A body of three slices, so that a reset finds a copy half made; under TSan this is the test of the thread rules.
class ReadersOfALargeBody : public Readers {
 protected:
  ReadersOfALargeBody() : Readers(Cube(12)) {}
  // Reads all that a reader has; every id it is told of must be one that it knows.
  void read_all(crumble_reader of) {
    const crumble_reader_info info = update(of);
    for (const std::uint32_t label : array<std::uint32_t>(CRUMBLE_ARRAY_NODE_FRAGMENTS, of)) {
      EXPECT_TRUE(label < info.fragment_count || label == CRUMBLE_NONE) << label;
    }
    EXPECT_EQ(array<std::uint32_t>(CRUMBLE_ARRAY_SURFACE_TRIANGLES, of).size(), 3 * std::size_t{info.triangle_count});
    std::uint32_t nodes = 0;
    for (std::uint32_t f = 0; f < info.fragment_count; ++f) {
      crumble_fragment_info about{};
      about.struct_size = sizeof about;
      crumble_view list{};
      EXPECT_RESULT(CRUMBLE_OK, crumble_reader_get_fragment(of, f, &about));
      EXPECT_RESULT(CRUMBLE_OK, crumble_reader_get_fragment_list(of, f, CRUMBLE_LIST_TRIANGLES, &list));
      nodes += about.node_count;
    }
    EXPECT_LE(nodes, cube.node_count());
    crumble_event events[64];
    std::uint32_t count = 0;
    EXPECT_RESULT(CRUMBLE_OK, crumble_reader_read_events(of, events, 64, &count));
  }
};

TEST_F(ReadersOfALargeBody, WorkBesideResetRestoreRemovalAndDestruction) {
  crumble_sim other = make_sim();
  crumble_reader first = nullptr;
  ASSERT_OK(crumble_reader_create(other, nullptr, &first));
  std::atomic<crumble_reader> handed_over{nullptr};
  std::atomic<bool> done{false};
  std::thread drawing([&] {
    for (bool was_done = false; !was_done;) {
      was_done = done;
      read_all(first);
      if (crumble_reader brief = handed_over.exchange(nullptr)) {  // made by the other thread, destroyed by this one
        read_all(brief);
        EXPECT_RESULT(CRUMBLE_OK, crumble_reader_destroy(brief));
      }
    }
  });
  const auto press_other = [&](int begin, int end) {
    for (int step = begin; step <= end; ++step) {
      const crumble_pose pose = pose_at(step);
      ASSERT_OK(crumble_sim_step(other, &pose, &wrench));
    }
  };
  Vector<std::uint8_t> broken;
  for (int round = 0; round < 3; ++round) {
    press_other(1, 700);
    crumble_reader brief = nullptr;
    ASSERT_OK(crumble_reader_create(other, nullptr, &brief));
    ASSERT_OK(crumble_reader_destroy(handed_over.exchange(brief)));  // the one before, if nobody has taken it
    std::uint64_t bytes = 0;
    ASSERT_OK(crumble_sim_snapshot(other, nullptr, 0, &bytes));
    broken.resize(bytes);
    ASSERT_OK(crumble_sim_snapshot(other, broken.data(), bytes, nullptr));
    std::uint32_t fragments = 0;
    ASSERT_OK(crumble_sim_count_fragments(other, &fragments));
    EXPECT_GT(fragments, 1u);
    ASSERT_OK(crumble_sim_set_fragment_state(other, fragments - 1, CRUMBLE_FRAGMENT_REMOVED));
    press_other(701, 717 + round);
    ASSERT_OK(crumble_sim_reset(other));
    press_other(1, 17 + round);
    ASSERT_OK(crumble_sim_restore(other, broken.data(), bytes));
    press_other(701, 717 + round);
    ASSERT_OK(crumble_sim_reset(other));
  }
  ASSERT_OK(crumble_sim_destroy(other));
  done = true;
  drawing.join();
  ASSERT_OK(crumble_reader_destroy(handed_over));
  EXPECT_EQ(update(first).step, 0u);
  ASSERT_OK(crumble_reader_destroy(first));
}

}  // namespace
}  // namespace crumble
