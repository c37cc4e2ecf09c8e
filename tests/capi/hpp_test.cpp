// crumble.hpp beside crumble.h: the same bits, errors as exceptions, objects that go by themselves.
#include <algorithm>
#include <filesystem>
#include <type_traits>

#include "capi/hpp_rig.hpp"
#include "support/allocation_counter.hpp"

namespace crumble {
namespace {

static_assert(!std::is_copy_constructible_v<c::Sim> && !std::is_copy_assignable_v<c::Sim>);
static_assert(std::is_nothrow_move_constructible_v<c::Sim> && std::is_nothrow_move_assignable_v<c::Loop>);
static_assert(sizeof(c::Sim) == sizeof(crumble_sim) && sizeof(c::ToolDef) == sizeof(crumble_tool_def));
static_assert(std::is_convertible_v<std::vector<double>&, c::Span<const double>>);
static_assert(!std::is_convertible_v<const std::vector<double>&, c::Span<double>>);
static_assert(!std::is_convertible_v<std::vector<float>&, c::Span<const double>>);
// rows of a derived type would be read wrongly if it ever grew
static_assert(!std::is_convertible_v<std::vector<c::HandDef>&, c::Span<const crumble_hand_def>>);

TEST_F(Hpp, HasTheBitsOfC) {
  CapiTest::press(1, 300);
  const crumble_wrench felt = press(twin, 1, 300);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(felt.force[axis], wrench.force[axis]);
    EXPECT_EQ(felt.torque[axis], wrench.torque[axis]);
    EXPECT_NE(felt.torque[axis], 0);
  }
  EXPECT_EQ(twin.state_hash(), hash());
  EXPECT_EQ(twin.get_counters().cuts, counters().cuts);
  EXPECT_GT(twin.get_counters().cuts, 20u);
  EXPECT_EQ(twin.get_step_info().contacts, info().contacts);
  EXPECT_GT(twin.get_profile().solve_network, 0);
  EXPECT_EQ(body.get_info().node_count, cube.node_count());
}

TEST_F(Hpp, DefinitionsBeginWithDefaults) {
  EXPECT_EQ(c::MeshDef().spacing, 0.0044);
  EXPECT_EQ(c::SimDef().stiffness, 30);
  EXPECT_EQ(c::ToolDef().struct_size, sizeof(crumble_tool_def));
  EXPECT_EQ(c::WallDef().normal[1], 1);
  EXPECT_EQ(c::ReaderDef().settle, 0.05);
  EXPECT_EQ(c::DeviceDef().inverse3_port, 10001u);
  EXPECT_EQ(c::DeviceCallbacks().measured, std::uint32_t{CRUMBLE_SENSES_POSITION});
  EXPECT_EQ(c::LoopDef().tick, 0.001);
  EXPECT_EQ(c::HandDef().max_force, 3);
  EXPECT_NO_THROW(c::check_version());
  c::SimDef changed;
  changed.mass = 0.05;
  twin.configure(changed);
  EXPECT_EQ(twin.get_def().mass, 0.05);
  crumble_hand_def hand = c::HandDef();
  c::LoopDef loop;
  c::loop_apply_paper_preset(loop, {&hand, 1});
  EXPECT_EQ(loop.coupling, std::uint32_t{CRUMBLE_COUPLING_PAPER});
  EXPECT_EQ(hand.coupling, 0u);
}

TEST_F(Hpp, ErrorsSayCodeNameAndText) {
  c::MeshDef bad;
  bad.spacing = -1;
  expect_error(CRUMBLE_E_OUT_OF_RANGE, {"crumble_mesh_create", "spacing", "-1"}, [&] { c::Mesh none(bad); });
  expect_error(CRUMBLE_E_OUT_OF_RANGE, {"77"}, [] { c::Mesh::create_paper(77); });
  crumble_pose nowhere = pose_at(1);
  nowhere.position[2] = kNan;
  expect_error(CRUMBLE_E_BAD_POSE, {"crumble_sim_step", "position[2]"}, [&] { twin.step(nowhere); });
  wrench.force[0] = 9;
  EXPECT_RESULT(CRUMBLE_E_BAD_POSE, twin.try_step(nowhere, wrench));
  EXPECT_EQ(wrench.force[0], 0);
  expect_error(CRUMBLE_E_INVALID_VALUE, {"whole number of rows"},
               [&] { c::Mesh::create_from_tets(c::Span<const double>(cube.positions.data(), 7), cube.tetrahedra); });
}

TEST_F(Hpp, ObjectsMoveAndGo) {
  const crumble_sim raw = twin.get();
  c::Sim moved = std::move(twin);
  EXPECT_EQ(moved.get(), raw);
  EXPECT_EQ(twin.get(), nullptr);  // NOLINT(bugprone-use-after-move)
  expect_error(CRUMBLE_E_NULL, {"crumble_sim_step"}, [&] { twin.step(pose_at(1)); });
  moved = make();  // the first one goes
  std::uint64_t ignored = 0;
  EXPECT_RESULT(CRUMBLE_E_STALE_HANDLE, crumble_sim_state_hash(raw, &ignored));
  const crumble_sim second = moved.get();
  {
    const c::Sim dies = std::move(moved);
    EXPECT_RESULT(CRUMBLE_OK, crumble_sim_state_hash(second, &ignored));
  }
  EXPECT_RESULT(CRUMBLE_E_STALE_HANDLE, crumble_sim_state_hash(second, &ignored));
  twin = make();
  twin.destroy();
  expect_error(CRUMBLE_E_NULL, {"crumble_sim_state_hash"}, [&] { twin.state_hash(); });
  twin.destroy();  // nothing to do
  // a handle that somebody else destroyed
  c::Mesh other = make_body();
  ASSERT_OK(crumble_mesh_destroy(other.get()));
  expect_error(CRUMBLE_E_STALE_HANDLE, {"crumble_mesh_get_info"}, [&] { other.get_info(); });
  expect_error(CRUMBLE_E_STALE_HANDLE, {"crumble_mesh_destroy"}, [&] { other.destroy(); });
  const c::Mesh taken(make_body().release());
  EXPECT_EQ(taken.get_info().node_count, cube.node_count());
}

TEST_F(Hpp, ArraysHaveTheirTypes) {
  const auto same = [](const auto& a, const auto& b) { return std::equal(a.begin(), a.end(), b.begin(), b.end()); };
  EXPECT_TRUE(same(body.copy(c::kTetrahedra), cube.tetrahedra));
  EXPECT_TRUE(same(body.copy(c::kRestPositions), cube.positions));
  press(twin, 1, 200);
  const std::vector<double> packed = twin.copy(c::kPositions);
  const c::Span<const double> y = twin.get_view(c::kPositionsY);
  ASSERT_EQ(y.size(), cube.node_count());
  for (std::size_t i = 0; i < y.size(); ++i) ASSERT_EQ(y[i], packed[3 * i + 1]);
  std::size_t cut = 0;
  for (const std::uint8_t intact : twin.get_view(c::kIntact)) cut += intact == 0;
  EXPECT_EQ(cut, twin.get_counters().cuts);
  std::vector<double> room(packed.size() + 1, 7);
  EXPECT_EQ(twin.copy(c::kVelocities, room), packed.size());
  EXPECT_EQ(room.back(), 7);
  room.resize(5);
  expect_error(CRUMBLE_E_BUFFER_TOO_SMALL, {}, [&] { twin.copy(c::kPositions, room); });
  room.clear();
  room.shrink_to_fit();
  expect_error(CRUMBLE_E_BUFFER_TOO_SMALL, {}, [&] { twin.copy(c::kPositions, room); });
  expect_error(CRUMBLE_E_UNSUPPORTED, {}, [&] { (void)twin.get_view(c::kPositions); });
  expect_error(CRUMBLE_E_STATE, {}, [&] { (void)twin.get_view(c::kSurfacePositions); });
  const crumble_surface_info surface = twin.extract_surface();
  EXPECT_EQ(twin.get_view(c::kSurfaceNormals).size(), 9 * std::size_t{surface.triangle_count});
}

// The types that crumble.hpp gives the arrays are those that the library tells of its views.
TEST_F(Hpp, TypesAreThoseOfTheViews) {
  twin.extract_surface();
  const c::Reader reader(twin);
  const auto expect_type = [](std::uint32_t scalar, auto array, auto&& get_view) {
    crumble_view view{};
    ASSERT_OK(get_view(array.which, &view)) << array.which;
    EXPECT_EQ(view.scalar_type, scalar) << array.which;
  };
  const auto of_mesh = [&](std::uint32_t i, crumble_view* v) { return crumble_mesh_get_view(body.get(), i, v); };
  const auto of_sim = [&](std::uint32_t i, crumble_view* v) { return crumble_sim_get_view(twin.get(), i, v); };
  const auto of_reader = [&](std::uint32_t i, crumble_view* v) { return crumble_reader_get_view(reader.get(), i, v); };
  const auto each = [&](std::uint32_t scalar, auto&& get_view, auto... arrays) {
    (expect_type(scalar, arrays, get_view), ...);
  };
  each(CRUMBLE_SCALAR_FLOAT64, of_mesh, c::kRestPositions, c::kNodeVolumes);
  each(CRUMBLE_SCALAR_UINT8, of_mesh, c::kNodeKinds);
  each(CRUMBLE_SCALAR_UINT32, of_mesh, c::kTetrahedra, c::kSprings, c::kBoundary);
  each(CRUMBLE_SCALAR_FLOAT64, of_sim, c::kPositionsX, c::kPositionsY, c::kPositionsZ, c::kVelocitiesX, c::kVelocitiesY,
       c::kVelocitiesZ, c::kSurfacePositions, c::kSurfaceRestPositions);
  each(CRUMBLE_SCALAR_UINT8, of_sim, c::kIntact);
  each(CRUMBLE_SCALAR_UINT32, of_sim, c::kNewCuts, c::kNodeFragments, c::kSurfaceTriangles, c::kSurfaceFragments,
       c::kSurfaceTetrahedra);
  each(CRUMBLE_SCALAR_FLOAT32, of_sim, c::kSurfaceNormals);
  each(CRUMBLE_SCALAR_UINT32, of_reader, c::kSurfaceSkinSources, c::kSurfaceChangedTriangles,
       c::kSurfaceChangedVertices);
}

TEST_F(Hpp, ToolsWallsAndNodes) {
  c::ToolDef ball;
  ball.shape = CRUMBLE_TOOL_BALL;
  ball.radius = 0.008;
  EXPECT_EQ(twin.add_tool(ball), 1u);
  EXPECT_EQ(twin.add_attachment(std::vector<std::uint32_t>{cube.node_count() - 1}), 0u);
  twin.add_wall(c::WallDef());
  twin.fix_box({-1, -1, -1}, {1, 0.001, 1});
  twin.fix_plane({0, 1, 0}, 0.001);
  std::vector<crumble_pose> poses{c::pose_at(-0.01, 0.034, 0), c::pose_at(0.01, 0.04, 0), c::pose_at(0, 0, 0)};
  std::vector<crumble_wrench> wrenches(3);
  for (int step = 0; step < 60; ++step) {
    poses[0].position[1] -= 5e-6;
    poses[1].position[1] -= 5e-5;
    twin.step_tools(poses, wrenches);
  }
  EXPECT_GT(wrenches[0].force[1], 0.03);
  EXPECT_GT(wrenches[1].force[1], 0.03);
  const std::vector<crumble_contact> contacts = twin.get_contacts();
  double sum = 0;
  for (const crumble_contact& contact : contacts) sum += contact.holder == 1 ? contact.reaction[1] : 0;
  EXPECT_NEAR(wrenches[1].force[1], -sum, 1e-12);
  crumble_local_model model;
  twin.get_local_model(1, model);
  EXPECT_NEAR(c::local_model_evaluate(model, model.at).force[1], model.wrench.force[1], 1e-12);
  EXPECT_GT(twin.get_held_drag(1), 0);
  twin.set_node_force(3, {0, 0.001, 0});
  twin.set_node_forces({});
  wrenches.pop_back();
  expect_error(CRUMBLE_E_OUT_OF_RANGE, {"step_tools"}, [&] { twin.step_tools(poses, wrenches); });
}

TEST_F(Hpp, SnapshotsAndRecordings) {
  const std::string path = (std::filesystem::temp_directory_path() / "crumble_hpp_test.crec").string();
  twin.begin_recording();
  press(twin, 1, 100);
  twin.save_recording(path);
  twin.end_recording();
  const c::Verified verified = c::verify_recording(path);
  EXPECT_EQ(verified.step_count, 100u);
  EXPECT_EQ(verified.equal_steps, 100u);
  std::filesystem::remove(path);
  const std::vector<std::uint8_t> snapshot = twin.snapshot();
  press(twin, 101, 200);
  c::Sim other = make();
  other.restore(snapshot);
  EXPECT_NE(other.state_hash(), twin.state_hash());
  press(other, 101, 200);
  EXPECT_EQ(other.state_hash(), twin.state_hash());
  twin.reset();
  EXPECT_EQ(twin.get_step_info().step, 0u);
}

TEST_F(Hpp, ReadersFollow) {
  c::Reader reader(twin);
  expect_error(CRUMBLE_E_IN_USE, {"crumble_sim_add_tool"}, [&] { twin.add_tool(c::ToolDef()); });
  press(twin, 1, 300);
  twin.publish();
  const crumble_reader_info info = reader.update();
  EXPECT_EQ(info.step, 300u);
  EXPECT_EQ(reader.copy(c::kPositions), twin.copy(c::kPositions));
  EXPECT_EQ(reader.get_view(c::kSurfaceTriangles).size(), 3 * std::size_t{info.triangle_count});
  std::vector<crumble_event> events(16384);
  events.resize(reader.read_events(events));
  const auto cut = [](const crumble_event& event) { return event.kind == CRUMBLE_EVENT_CUT; };
  EXPECT_EQ(std::count_if(events.begin(), events.end(), cut), static_cast<std::ptrdiff_t>(info.cuts));
  EXPECT_EQ(reader.get_fragment_list(0, CRUMBLE_LIST_NODES).size(), reader.get_fragment(0).node_count);
  const std::vector<float> boundary(2 * body.get_view(c::kBoundary).size(), 0.25F);
  std::vector<float> skin(6 * std::size_t{info.skin_triangle_count});
  reader.spread_over_skin(boundary, skin);
  EXPECT_EQ(skin.front(), 0.25F);
  twin.set_fragment_state(0, CRUMBLE_FRAGMENT_ASLEEP);
  EXPECT_EQ(twin.get_fragment_state(0), std::uint32_t{CRUMBLE_FRAGMENT_ASLEEP});
  ASSERT_EQ(twin.find_debris(1000000, 1e9).size(), 1u);
  EXPECT_EQ(twin.find_debris(1000000, 1e9)[0], 0u);
  EXPECT_TRUE(twin.find_debris(1, 1e9).empty());
}

/// A device of the host's own.
struct Falling {
  crumble_result read(crumble_device_sample& sample) noexcept {
    if (++reads > 700 && height > -0.004) height -= 1e-5;
    sample.pose.position[1] = height;
    return reads < lost_at ? CRUMBLE_OK : CRUMBLE_E_IO;
  }
  crumble_result write(const double* force, const double*) noexcept {
    most = std::max(most, force[1]);
    return CRUMBLE_OK;
  }
  int reads = 0, lost_at = 1 << 30;
  double height = 0.002, most = 0;
};

TEST_F(Hpp, LoopsFeelTheBodyThroughACustomDevice) {
  Falling falling;
  const c::DeviceCallbacks table = c::callbacks_of(falling);
  c::DeviceDef who;
  who.kind = c::device_kind("custom");
  who.callbacks = &table;
  c::Device device(who);
  c::HandDef hand;
  hand.device = device.get();
  hand.workspace.position[1] = 0.034;
  c::LoopDef host;
  host.driver = CRUMBLE_DRIVER_HOST;
  c::Loop loop(twin, host, hand);
  for (int i = 0; i < 1500; ++i) loop.tick();
  EXPECT_GT(falling.most, 0.05);
  EXPECT_EQ(loop.get_status().ticks, 1500u);
  EXPECT_EQ(loop.get_hand(0).fault, std::uint32_t{CRUMBLE_FAULT_NONE});
  expect_error(CRUMBLE_E_IN_USE, {"crumble_sim_destroy"}, [&] { twin.destroy(); });
  expect_error(CRUMBLE_E_IN_USE, {"crumble_device_destroy"}, [&] { device.destroy(); });
  falling.lost_at = 0;
  EXPECT_RESULT(CRUMBLE_OK, loop.try_tick());
  EXPECT_EQ(loop.get_hand(0).fault, std::uint32_t{CRUMBLE_FAULT_DEVICE_LOST});
  loop.destroy();
  twin.destroy();
}

TEST_F(Hpp, LoopsHaveAThreadOfTheirOwn) {
  c::DeviceDef who;
  who.kind = CRUMBLE_DEVICE_HAND;
  const crumble_motion_point way[] = {{0.7, {0, 0, 0}, {}}};
  who.points = way;
  who.point_count = 1;
  const c::Device device(who);
  c::HandDef hand;
  hand.device = device.get();
  c::LoopDef own;
  own.priority = 0;
  c::Loop loop(twin, own, hand);
  EXPECT_FALSE(loop.is_running());
  loop.start();
  EXPECT_TRUE(loop.is_running());
  while (loop.get_status().ticks < 20) {
  }
  expect_error(CRUMBLE_E_BUSY, {"crumble_sim_state_hash"}, [&] { twin.state_hash(); });
  expect_error(CRUMBLE_E_STATE, {"crumble_loop_start"}, [&] { loop.start(); });
  loop.halt();
  loop.stop();
  loop.reset_fault(0);
  EXPECT_GE(loop.get_times().tick_wall.count, 20u);
  EXPECT_NO_THROW(loop.get_scheduling());
  for (std::uint32_t i = 0; i < loop.get_status().warning_count; ++i) EXPECT_NE(loop.get_warning(i), "");
  expect_error(CRUMBLE_E_OUT_OF_RANGE, {}, [&] { (void)loop.get_warning(99); });
}

TEST(HppDevice, ReadsAndRecords) {
  c::DeviceDef who;
  who.kind = CRUMBLE_DEVICE_PRESS;
  who.press_speed = 0.01;
  who.record_capacity = 100;
  c::Device device(who);
  EXPECT_EQ(device.get_info().kind, std::uint32_t{CRUMBLE_DEVICE_PRESS});
  crumble_device_sample sample = device.read();
  for (int i = 0; i < 50; ++i) {
    sample = device.read();
    device.write({0, 0.1, 0});
  }
  EXPECT_NEAR(sample.pose.position[1], -5e-4, 1e-12);
  EXPECT_STREQ(device.get_text(), "");
  const std::string path = (std::filesystem::temp_directory_path() / "crumble_hpp_test.ctraj").string();
  device.save_trajectory(path);
  EXPECT_TRUE(std::filesystem::remove(path));
  expect_error(CRUMBLE_E_UNSUPPORTED, {"spoon"}, [] { c::device_kind("spoon"); });
  expect_error(CRUMBLE_E_IO, {"none.log"}, [] { c::trajectory_import_hapi("/none.log", 1, "/none.ctraj"); });
  EXPECT_NO_THROW(c::device_find_attached());
}

TEST_F(Hpp, StepsAllocateNothing) {
  if (!AllocationCounter::available()) GTEST_SKIP() << "allocations are not counted here";
  double most = 0;
  std::size_t allocations = 0;
  {
    const AllocationCounter counter;
    for (int step = 1; step <= 400; ++step) {
      most = std::max(most, twin.step(pose_at(step)).force[1]);
      crumble_pose bad = pose_at(step);
      bad.position[0] = kNan;
      if (twin.try_step(bad, wrench) != CRUMBLE_E_BAD_POSE) break;
    }
    allocations = counter.count();
  }
  EXPECT_EQ(allocations, 0u);
  EXPECT_GT(most, 0.1);
  EXPECT_EQ(twin.get_step_info().step, 400u);
}

}  // namespace
}  // namespace crumble
