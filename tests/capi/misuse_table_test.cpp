// The catalogue of bad input, row by row, in the build that is shipped: what a host may do wrong, and the one answer
// that it gets. Each row stands for itself; many have tests of their own elsewhere, which look closer.
#include <sys/mman.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <functional>
#include <thread>

#include "capi/rig.hpp"
#include "crumble/base/file.hpp"

namespace crumble {
namespace {

class MisuseTable : public CapiTest {
 protected:
  template <class Edit>
  crumble_result create_with(Edit&& edit) {
    crumble_sim_def bad = def;
    edit(bad);
    crumble_sim made = nullptr;
    const crumble_result result = crumble_sim_create(mesh, &bad, &made);
    EXPECT_EQ(made, nullptr) << "nothing is made";
    return result;
  }
  crumble_result from_tets(Vector<double> positions, Vector<std::uint32_t> tets) {
    crumble_mesh made = nullptr;
    const crumble_result result =
        crumble_mesh_create_from_tets(positions.data(), static_cast<std::uint32_t>(positions.size() / 3), tets.data(),
                                      static_cast<std::uint32_t>(tets.size() / 4), &made);
    EXPECT_EQ(made, nullptr);
    return result;
  }
  crumble_result tool_mesh(Vector<double> vertices, Vector<std::uint32_t> triangles) {
    crumble_tool_def bad = tool;
    bad.shape = CRUMBLE_TOOL_MESH;
    bad.vertices = vertices.data(), bad.vertex_count = static_cast<std::uint32_t>(vertices.size() / 3);
    bad.triangles = triangles.data(), bad.triangle_count = static_cast<std::uint32_t>(triangles.size() / 3);
    return crumble_sim_add_tool(make_sim_of_rig(), &bad, nullptr);
  }
  crumble_sim make_sim_of_rig() {
    if (!spare) spare = make_sim();
    return spare;
  }
  void TearDown() override {
    EXPECT_RESULT(CRUMBLE_OK, crumble_sim_destroy(spare));
    CapiTest::TearDown();
  }
  crumble_result step_at(const crumble_pose& pose) {
    wrench.force[1] = 7;
    const crumble_result result = crumble_sim_step(sim, &pose, &wrench);
    if (result != CRUMBLE_OK) {
      EXPECT_EQ(wrench.force[1], 0) << "no old force";
      EXPECT_STRNE(crumble_last_error(), "");
    }
    return result;
  }
  crumble_sim spare = nullptr;
};

const Vector<double> kTet{0, 0, 0, 0.01, 0, 0, 0, 0.01, 0, 0, 0, 0.01};
const Vector<std::uint32_t> kTetOutside{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};

TEST_F(MisuseTable, NullObjectOrOutPointer) {
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_sim_step(nullptr, nullptr, nullptr));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_sim_create(mesh, nullptr, nullptr));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_sim_get_counters(sim, nullptr));
  for (const crumble_result nothing :
       {crumble_mesh_destroy(nullptr), crumble_sim_destroy(nullptr), crumble_reader_destroy(nullptr),
        crumble_device_destroy(nullptr), crumble_loop_destroy(nullptr), crumble_recording_destroy(nullptr)}) {
    EXPECT_RESULT(CRUMBLE_OK, nothing);
  }
}

TEST_F(MisuseTable, NotANumberInTheDefinition) {
  for (double crumble_sim_def::*field :
       {&crumble_sim_def::stiffness, &crumble_sim_def::damping_ratio, &crumble_sim_def::mass,
        &crumble_sim_def::length_limit, &crumble_sim_def::tau}) {
    for (const double value : {kNan, kInfinity, -kInfinity}) {
      EXPECT_RESULT(CRUMBLE_E_INVALID_VALUE, create_with([&](crumble_sim_def& d) { d.*field = value; }));
    }
  }
  Vector<double> positions = kTet;
  positions[7] = kNan;
  expect_failure(CRUMBLE_E_INVALID_VALUE, from_tets(positions, {0, 1, 2, 3}), {"2"});
}

TEST_F(MisuseTable, NumbersThatAreNotAllowed) {
  const auto bad = [&](double crumble_sim_def::*field, double value) {
    return create_with([&](crumble_sim_def& d) { d.*field = value; });
  };
  EXPECT_RESULT(CRUMBLE_E_OUT_OF_RANGE, bad(&crumble_sim_def::stiffness, 0));
  EXPECT_RESULT(CRUMBLE_E_OUT_OF_RANGE, bad(&crumble_sim_def::mass, -0.1));
  EXPECT_RESULT(CRUMBLE_E_OUT_OF_RANGE, bad(&crumble_sim_def::length_limit, 1));
  EXPECT_RESULT(CRUMBLE_E_OUT_OF_RANGE, bad(&crumble_sim_def::tau, 0));
  EXPECT_RESULT(CRUMBLE_E_OUT_OF_RANGE, bad(&crumble_sim_def::tau, -0.001));
  crumble_tool_def thin = tool;
  thin.radius = 0;
  EXPECT_RESULT(CRUMBLE_E_OUT_OF_RANGE, crumble_sim_add_tool(sim, &thin, nullptr));
  def.damping_ratio = 0;  // undamped: only where something keeps it stable
  EXPECT_RESULT(CRUMBLE_E_DT_TOO_LARGE,
                create_with([](crumble_sim_def& d) { d.time_step_policy = CRUMBLE_POLICY_ERROR; }));
  crumble_sim undamped = nullptr;
  ASSERT_OK(crumble_sim_create(mesh, &def, &undamped));
  ASSERT_OK(crumble_sim_destroy(undamped));
}

TEST_F(MisuseTable, TooLongATimeStep) {
  EXPECT_RESULT(CRUMBLE_E_DT_TOO_LARGE, create_with([](crumble_sim_def& d) { d.tau = 0.011; }));
  EXPECT_RESULT(CRUMBLE_E_DT_TOO_LARGE, create_with([](crumble_sim_def& d) {
                  d.tau = 0.01, d.damping_ratio = 0.1, d.time_step_policy = CRUMBLE_POLICY_ERROR;
                }));
}

TEST_F(MisuseTable, PosesThatAreNone) {
  press(1, 40);
  ASSERT_GT(wrench.force[1], 0);
  const std::uint64_t before = hash();
  crumble_pose pose = pose_at(40);
  pose.position[0] = kNan;
  EXPECT_RESULT(CRUMBLE_E_BAD_POSE, step_at(pose));
  pose = pose_at(40), pose.orientation[0] *= 1.01;
  EXPECT_RESULT(CRUMBLE_E_BAD_POSE, step_at(pose));
  EXPECT_EQ(info().step, 40u) << "the body has stood still";
  EXPECT_EQ(counters().bad_poses, 2u);
  pose = pose_at(40), pose.orientation[0] *= 1.0005;  // made unit again
  EXPECT_RESULT(CRUMBLE_OK, step_at(pose));
  EXPECT_NE(hash(), before);
}

TEST_F(MisuseTable, AToolThatJumpsOrBeginsInside) {
  press(1, 40);
  crumble_pose pose = pose_at(40);
  pose.position[1] -= 0.5;  // through the body and out below
  EXPECT_RESULT(CRUMBLE_OK, step_at(pose));
  EXPECT_TRUE(info().flags & CRUMBLE_STEP_TOOL_JUMPED);
  EXPECT_EQ(wrench.force[1], 0);
  ASSERT_OK(crumble_sim_reset(sim));
  EXPECT_RESULT(CRUMBLE_OK, step_at({{0, 0.015, 0}, {1, 0, 0, 0}}));
  EXPECT_TRUE(info().flags & CRUMBLE_STEP_CONTACT_SUSPENDED);
  EXPECT_EQ(wrench.force[1], 0) << "no kick in the first step";
}

TEST_F(MisuseTable, ToolMeshes) {
  EXPECT_RESULT(CRUMBLE_E_MESH, tool_mesh(kTet, {0, 1, 2}));
  expect_failure(CRUMBLE_E_MESH, tool_mesh(kTet, {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 9}), {"9"});
  Vector<double> vertices = kTet;
  vertices[3] = kInfinity;
  EXPECT_RESULT(CRUMBLE_E_MESH, tool_mesh(vertices, kTetOutside));
  EXPECT_RESULT(CRUMBLE_E_MESH_OPEN, tool_mesh(kTet, {0, 2, 1, 0, 1, 3, 0, 3, 2, 0, 2, 1}));
  EXPECT_RESULT(CRUMBLE_E_MESH_ORIENTATION, tool_mesh(kTet, {0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2}));
  EXPECT_RESULT(CRUMBLE_E_MESH_ORIENTATION, tool_mesh(kTet, {0, 1, 2, 0, 1, 3, 0, 3, 2, 1, 2, 3}));
  EXPECT_RESULT(CRUMBLE_OK, tool_mesh(kTet, kTetOutside));
}

TEST_F(MisuseTable, BodiesThatAreNone) {
  EXPECT_RESULT(CRUMBLE_E_EMPTY, from_tets({}, {}));
  EXPECT_RESULT(CRUMBLE_E_EMPTY, from_tets(kTet, {}));
  crumble_mesh made = nullptr;
  EXPECT_RESULT(CRUMBLE_E_TOO_LARGE,
                crumble_mesh_create_from_tets(kTet.data(), 4, kTetOutside.data(), 0x80000000u, &made));
  Vector<double> twice = kTet;
  twice.insert(twice.end(), {0, 0, 0});
  expect_failure(CRUMBLE_E_DUPLICATE_NODE, from_tets(twice, {0, 1, 2, 3, 4, 1, 2, 3}), {"0", "4"});
  Vector<double> alone = kTet;
  alone.insert(alone.end(), {1, 1, 1});
  expect_failure(CRUMBLE_E_ISOLATED_NODE, from_tets(alone, {0, 1, 2, 3}), {"4"});
  expect_failure(CRUMBLE_E_MESH, from_tets(kTet, {0, 2, 1, 3}), {"0"});
  crumble_mesh_def body{};
  ASSERT_OK(crumble_mesh_def_init(&body, sizeof body));
  body.spacing = 0.05;
  expect_failure(CRUMBLE_E_TOO_COARSE, crumble_mesh_create(&body, &made), {"spacing"});
  body.spacing = 1e-6;
  EXPECT_RESULT(CRUMBLE_E_TOO_LARGE, crumble_mesh_create(&body, &made)) << "before memory is taken";
  EXPECT_EQ(made, nullptr);
}

TEST_F(MisuseTable, ABodyInPartsAndOneOfWhichNothingIsLeft) {
  Vector<double> two = kTet;
  for (std::size_t i = 0; i < kTet.size(); ++i) two.push_back(kTet[i] + 0.05);
  crumble_mesh parts = nullptr;
  crumble_sim made = nullptr;
  const std::uint32_t tets[] = {0, 1, 2, 3, 4, 5, 6, 7};
  ASSERT_OK(crumble_mesh_create_from_tets(two.data(), 8, tets, 2, &parts));
  ASSERT_OK(crumble_sim_create(parts, nullptr, &made));
  std::uint32_t count = 0;
  ASSERT_OK(crumble_sim_count_fragments(made, &count));
  EXPECT_EQ(count, 2u);
  ASSERT_OK(crumble_sim_set_fragment_state(made, 0, CRUMBLE_FRAGMENT_REMOVED));
  ASSERT_OK(crumble_sim_set_fragment_state(made, 1, CRUMBLE_FRAGMENT_REMOVED));
  for (int i = 0; i < 10; ++i) ASSERT_OK(crumble_sim_step_tools(made, nullptr, nullptr, 0));
  ASSERT_OK(crumble_sim_destroy(made));
  ASSERT_OK(crumble_mesh_destroy(parts));
}

TEST_F(MisuseTable, StructSizes) {
  EXPECT_RESULT(CRUMBLE_E_UNINITIALIZED, create_with([](crumble_sim_def& d) { d.struct_size = 0; }));
  EXPECT_RESULT(CRUMBLE_E_VERSION, create_with([](crumble_sim_def& d) { d.struct_size = sizeof d - 3; }));
  EXPECT_RESULT(CRUMBLE_E_VERSION, create_with([](crumble_sim_def& d) { d.struct_size = 1u << 30; }));
  struct {
    crumble_sim_def def;
    double more;
  } newer{def, 1};
  newer.def.struct_size = sizeof newer;
  crumble_sim made = nullptr;
  EXPECT_RESULT(CRUMBLE_E_VERSION, crumble_sim_create(mesh, &newer.def, &made));
}

TEST_F(MisuseTable, HandlesOfNothing) {
  crumble_sim gone = make_sim();
  ASSERT_OK(crumble_sim_destroy(gone));
  EXPECT_RESULT(CRUMBLE_E_STALE_HANDLE, crumble_sim_reset(gone));
  EXPECT_RESULT(CRUMBLE_E_STALE_HANDLE, crumble_sim_destroy(gone));
  EXPECT_RESULT(CRUMBLE_E_BAD_HANDLE, crumble_sim_reset(reinterpret_cast<crumble_sim>(mesh)));
  EXPECT_RESULT(CRUMBLE_E_BAD_HANDLE, crumble_sim_reset(reinterpret_cast<crumble_sim>(&gone)));
}

TEST_F(MisuseTable, TwoThreadsInOneObject) {
  // a step that waits within the object: the host's own threads run it
  ASSERT_OK(crumble_sim_get_def(sim, &def));
  crumble_result inner = CRUMBLE_OK;
  crumble_tool_def support = tool;
  struct Context {
    crumble_sim sim;
    crumble_result* result;
    bool stepping;
  } context{nullptr, &inner, false};
  support.shape = CRUMBLE_TOOL_SUPPORT;
  support.support_context = &context;
  support.support = [](void* data, const double direction[3], double point[3]) {
    auto& c = *static_cast<Context*>(data);
    for (int axis = 0; axis < 3; ++axis) point[axis] = 0.004 * direction[axis];
    if (!c.stepping) return;
    c.stepping = false;
    std::thread([&] { *c.result = crumble_sim_reset(c.sim); }).join();
  };
  crumble_sim shared = nullptr;
  ASSERT_OK(crumble_sim_create(mesh, &def, &shared));
  ASSERT_OK(crumble_sim_add_tool(shared, &support, nullptr));
  context.sim = shared, context.stepping = true;
  for (int i = 0; i < 200 && context.stepping; ++i) {
    const crumble_pose pose{{0, 0.034 - 2e-5 * i, 0}, {1, 0, 0, 0}};
    ASSERT_OK(crumble_sim_step(shared, &pose, &wrench));
  }
  EXPECT_FALSE(context.stepping) << "the function was called in a step";
  EXPECT_RESULT(CRUMBLE_E_BUSY, inner);
  ASSERT_OK(crumble_sim_destroy(shared));
}

TEST_F(MisuseTable, DestroyingWhatOthersNeed) {
  crumble_device_def which{};
  crumble_hand_def hand{};
  crumble_loop_def how{};
  crumble_loop loop = nullptr;
  ASSERT_OK(crumble_device_def_init(&which, sizeof which));
  ASSERT_OK(crumble_hand_def_init(&hand, sizeof hand));
  ASSERT_OK(crumble_loop_def_init(&how, sizeof how));
  ASSERT_OK(crumble_device_open(&which, &hand.device));
  ASSERT_OK(crumble_loop_create(sim, &how, &hand, 1, &loop));
  EXPECT_RESULT(CRUMBLE_E_IN_USE, crumble_sim_destroy(sim));
  EXPECT_RESULT(CRUMBLE_E_IN_USE, crumble_device_destroy(hand.device));
  ASSERT_OK(crumble_loop_destroy(loop));
  ASSERT_OK(crumble_device_destroy(hand.device));
}

// The buffer ends where a page begins that nobody may touch.
TEST_F(MisuseTable, BuffersToTheByte) {
  std::uint64_t needed = 0;
  ASSERT_OK(crumble_sim_copy(sim, CRUMBLE_ARRAY_POSITIONS, nullptr, 0, &needed));
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  const std::size_t room = (needed + page - 1) / page * page;
  auto* const memory =
      static_cast<std::byte*>(mmap(nullptr, room + page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
  ASSERT_NE(memory, MAP_FAILED);
  ASSERT_EQ(mprotect(memory + room, page, PROT_NONE), 0);
  std::byte* const dst = memory + room - needed;
  std::memset(dst, 0x5a, needed);
  std::uint64_t told = 0;
  EXPECT_RESULT(CRUMBLE_E_BUFFER_TOO_SMALL, crumble_sim_copy(sim, CRUMBLE_ARRAY_POSITIONS, dst, needed - 1, &told));
  EXPECT_EQ(told, needed);
  EXPECT_EQ(dst[0], std::byte{0x5a}) << "untouched";
  EXPECT_RESULT(CRUMBLE_OK, crumble_sim_copy(sim, CRUMBLE_ARRAY_POSITIONS, dst, needed, nullptr));
  EXPECT_EQ(munmap(memory, room + page), 0);
}

TEST_F(MisuseTable, ReplayFiles) {
  const auto path = (std::filesystem::temp_directory_path() / "crumble_misuse_test.ctraj").string();
  crumble_device_def which{};
  ASSERT_OK(crumble_device_def_init(&which, sizeof which));
  which.kind = CRUMBLE_DEVICE_REPLAY;
  which.trajectory = path.c_str();
  crumble_device device = nullptr;
  const auto answer = [&](const std::string& text) {
    write_text(path, text);
    return crumble_device_open(&which, &device);
  };
  std::filesystem::remove(path);
  EXPECT_RESULT(CRUMBLE_E_IO, crumble_device_open(&which, &device));
  EXPECT_RESULT(CRUMBLE_E_EMPTY, answer(""));
  EXPECT_RESULT(CRUMBLE_E_FORMAT, answer("something else\n"));
  which.kind = CRUMBLE_DEVICE_PRESS, which.record_capacity = 10, which.tick = 0.001;
  ASSERT_OK(crumble_device_open(&which, &device));
  crumble_device_sample sample{};
  sample.struct_size = sizeof sample;
  for (int i = 0; i < 5; ++i) ASSERT_OK(crumble_device_read(device, &sample));
  ASSERT_OK(crumble_device_save_trajectory(device, path.c_str()));
  ASSERT_OK(crumble_device_destroy(device));
  device = nullptr;
  which.kind = CRUMBLE_DEVICE_REPLAY, which.record_capacity = 0;
  const std::string good = read_text(path);
  ASSERT_OK(answer(good));
  for (int i = 0; i < 100; ++i)
    ASSERT_OK(crumble_device_read(device, &sample));  // past its end: the last pose, for good
  EXPECT_EQ(sample.status, std::uint32_t{CRUMBLE_READ_FINISHED});
  ASSERT_OK(crumble_device_destroy(device));
  device = nullptr;
  EXPECT_RESULT(CRUMBLE_E_CORRUPT, answer(good.substr(0, good.size() - 12)));  // in the middle of a row
  std::string flipped = good;
  flipped[flipped.rfind(' ') + 1] = 'x';
  EXPECT_NE(name_of(answer(flipped)), "CRUMBLE_OK");
  EXPECT_EQ(device, nullptr);
  std::filesystem::remove(path);
}

TEST_F(MisuseTable, ADeviceThatIsGone) {
  crumble_device_callbacks mine{};
  crumble_device_def which{};
  ASSERT_OK(crumble_device_callbacks_init(&mine, sizeof mine));
  ASSERT_OK(crumble_device_def_init(&which, sizeof which));
  mine.read = [](crumble_device_sample*, void*) -> crumble_result { return CRUMBLE_E_IO; };
  mine.write = [](const double*, const double*, void*) -> crumble_result { return CRUMBLE_OK; };
  which.kind = CRUMBLE_DEVICE_CUSTOM, which.callbacks = &mine;
  crumble_device device = nullptr;
  ASSERT_OK(crumble_device_open(&which, &device));
  crumble_device_sample sample{};
  sample.struct_size = sizeof sample;
  EXPECT_RESULT(CRUMBLE_E_DEVICE_LOST, crumble_device_read(device, &sample));
  EXPECT_RESULT(CRUMBLE_E_DEVICE_LOST, crumble_device_read(device, &sample)) << "for good";
  ASSERT_OK(crumble_device_destroy(device));
}

TEST_F(MisuseTable, ABodyThatLeavesTheWorld) {
  ASSERT_OK(crumble_sim_destroy(sim));
  def.time_step_policy = CRUMBLE_POLICY_UNCHECKED, def.damping_ratio = 0.001, def.tau = 0.01, def.stiffness = 1e6;
  sim = make_sim();
  crumble_result result = CRUMBLE_OK;
  for (int step = 0; step < 5000 && result == CRUMBLE_OK; ++step) result = step_at(pose_at(step));
  EXPECT_RESULT(CRUMBLE_E_DIVERGED, result);
  EXPECT_RESULT(CRUMBLE_E_DIVERGED, step_at(pose_at(0))) << "latched";
  ASSERT_OK(crumble_sim_reset(sim));
  EXPECT_RESULT(CRUMBLE_OK, step_at(pose_at(0)));
}

}  // namespace
}  // namespace crumble
