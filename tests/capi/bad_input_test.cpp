// The bad-input catalogue of the set-up calls: which code, which field in the text, and nothing made or changed.
#include <sys/resource.h>

#include "capi/rig.hpp"
#include "crumble/base/memory.hpp"
#include "support/allocation_counter.hpp"

namespace crumble {
namespace {

class BadInput : public CapiTest {
 protected:
  // Creating from `bad`, and configuring with it, both refuse and leave everything as it was.
  void expect_def(crumble_result expected, const crumble_sim_def& bad, const std::string& field) {
    crumble_sim made = nullptr;
    expect_failure(expected, crumble_sim_create(mesh, &bad, &made), {"crumble_sim_create", field});
    EXPECT_EQ(made, nullptr);
    const std::uint64_t before = hash();
    expect_failure(expected, crumble_sim_configure(sim, &bad), {"crumble_sim_configure", field});
    EXPECT_EQ(hash(), before);
    crumble_sim_def now{};
    now.struct_size = sizeof now;
    ASSERT_OK(crumble_sim_get_def(sim, &now));
    EXPECT_EQ(now.stiffness, def.stiffness);
    EXPECT_EQ(now.tau, def.tau);
  }
  void expect_tool(crumble_result expected, const crumble_tool_def& bad, const Vector<std::string>& words) {
    std::uint32_t index = 99;
    expect_failure(expected, crumble_sim_add_tool(sim, &bad, &index), words);
    EXPECT_EQ(index, 99u);
    EXPECT_RESULT(CRUMBLE_OK, crumble_sim_step(sim, &kPose, &wrench));  // it still has one tool
    EXPECT_RESULT(CRUMBLE_OK, crumble_sim_reset(sim));
  }
  static void expect_mesh(crumble_result expected, const crumble_mesh_def& bad, const Vector<std::string>& words) {
    crumble_mesh made = nullptr;
    expect_failure(expected, crumble_mesh_create(&bad, &made), words);
    EXPECT_EQ(made, nullptr);
  }
  const crumble_pose kPose = pose_at(0);
};

TEST_F(BadInput, NumbersThatAreNone) {
  const struct {
    double crumble_sim_def::*field;
    const char* name;
  } fields[] = {{&crumble_sim_def::stiffness, "stiffness"},
                {&crumble_sim_def::damping_ratio, "damping_ratio"},
                {&crumble_sim_def::length_limit, "length_limit"},
                {&crumble_sim_def::mass, "mass"},
                {&crumble_sim_def::tau, "tau"},
                {&crumble_sim_def::cut_fade, "cut_fade"}};
  for (const auto& [field, name] : fields) {
    for (const double value : {kNan, kInfinity, -kInfinity}) {
      crumble_sim_def bad = def;
      bad.*field = value;
      expect_def(CRUMBLE_E_INVALID_VALUE, bad, name);
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    crumble_sim_def bad = def;
    bad.gravity[axis] = kNan;
    expect_def(CRUMBLE_E_INVALID_VALUE, bad, "gravity");
  }
}

TEST_F(BadInput, NumbersOutOfRange) {
  const auto expect_field = [&](crumble_result expected, auto field, auto value, const char* name) {
    crumble_sim_def bad = def;
    bad.*field = value;
    expect_def(expected, bad, name);
  };
  for (const double value : {0.0, -1.0}) {
    expect_field(CRUMBLE_E_OUT_OF_RANGE, &crumble_sim_def::stiffness, value, "stiffness");
    expect_field(CRUMBLE_E_OUT_OF_RANGE, &crumble_sim_def::mass, value, "mass");
    expect_field(CRUMBLE_E_OUT_OF_RANGE, &crumble_sim_def::tau, value, "tau");
  }
  expect_field(CRUMBLE_E_OUT_OF_RANGE, &crumble_sim_def::damping_ratio, -1.0, "damping_ratio");
  expect_field(CRUMBLE_E_OUT_OF_RANGE, &crumble_sim_def::length_limit, 1.0, "length_limit");
  expect_field(CRUMBLE_E_OUT_OF_RANGE, &crumble_sim_def::cut_fade, 1.5, "cut_fade");
  expect_field(CRUMBLE_E_DT_TOO_LARGE, &crumble_sim_def::tau, 0.0101, "tau");
  expect_field(CRUMBLE_E_OUT_OF_RANGE, &crumble_sim_def::floor, 2u, "floor");
  expect_field(CRUMBLE_E_OUT_OF_RANGE, &crumble_sim_def::mass_rule, 2u, "mass_rule");
  expect_field(CRUMBLE_E_OUT_OF_RANGE, &crumble_sim_def::time_step_policy, 4u, "time_step_policy");
  expect_field(CRUMBLE_E_OUT_OF_RANGE, &crumble_sim_def::contact_rule, 256u, "contact_rule");
  expect_field(CRUMBLE_E_OUT_OF_RANGE, &crumble_sim_def::mean_force, 2u, "mean_force");
  expect_field(CRUMBLE_E_OUT_OF_RANGE, &crumble_sim_def::precision, 2u, "precision must be at most 1, is 2");
  expect_field(CRUMBLE_E_OUT_OF_RANGE, &crumble_sim_def::precision, 7u, "precision");
  expect_field(CRUMBLE_E_OUT_OF_RANGE, &crumble_sim_def::cut_test, 2u, "cut_test must be at most 1, is 2");
  expect_field(CRUMBLE_E_OUT_OF_RANGE, &crumble_sim_def::drag_frame, 2u, "drag_frame must be at most 1, is 2");
  expect_field(CRUMBLE_E_OUT_OF_RANGE, &crumble_sim_def::surface_samples, 2u, "surface_samples");
  expect_field(CRUMBLE_E_OUT_OF_RANGE, &crumble_sim_def::ball_contact, 2u, "ball_contact");
  expect_field(CRUMBLE_E_OUT_OF_RANGE, &crumble_sim_def::ball_static_friction, 0.1, "static_friction 0.1");
  expect_field(CRUMBLE_E_OUT_OF_RANGE, &crumble_sim_def::ball_dynamic_friction, -1.0, "dynamic_friction");
  expect_field(CRUMBLE_E_INVALID_VALUE, &crumble_sim_def::ball_dynamic_friction, kNan, "dynamic_friction");
  expect_field(CRUMBLE_E_OUT_OF_RANGE, &crumble_sim_def::spring_damping, -1.0, "spring_damping");
  expect_field(CRUMBLE_E_INVALID_VALUE, &crumble_sim_def::spring_damping, kInfinity, "spring_damping");
  expect_field(CRUMBLE_E_OUT_OF_RANGE, &crumble_sim_def::threads, 0u, "threads must lie in [1, 64], is 0");
  expect_field(CRUMBLE_E_OUT_OF_RANGE, &crumble_sim_def::threads, 65u, "threads must lie in [1, 64], is 65");
  expect_field(CRUMBLE_E_UNSUPPORTED, &crumble_sim_def::kernel, "abacus", "kernel 'abacus'");
  expect_field(CRUMBLE_E_UNSUPPORTED, &crumble_sim_def::kernel, "Scalar", "this processor runs scalar");
  expect_field(CRUMBLE_E_OUT_OF_RANGE, &crumble_sim_def::iterations, 0u, "iterations");
  expect_field(CRUMBLE_E_OUT_OF_RANGE, &crumble_sim_def::iterations, 2u, "iterations");  // the paper's mode only
}

TEST_F(BadInput, TimeStepsByPolicy) {
  def.stiffness = 1e5;  // stable up to much less than a millisecond
  def.damping_ratio = 0.1;
  const auto create = [&](std::uint32_t policy) {
    def.time_step_policy = policy;
    crumble_sim made = nullptr;
    const crumble_result result = crumble_sim_create(mesh, &def, &made);
    crumble_sim_destroy(made);
    return result;
  };
  EXPECT_RESULT(CRUMBLE_OK, create(CRUMBLE_POLICY_GUARD));
  EXPECT_RESULT(CRUMBLE_OK, create(CRUMBLE_POLICY_UNCHECKED));
  EXPECT_RESULT(CRUMBLE_E_DT_TOO_LARGE, create(CRUMBLE_POLICY_ERROR));
  EXPECT_RESULT(CRUMBLE_E_DT_TOO_LARGE, create(CRUMBLE_POLICY_SUBSTEP));
  def.damping_ratio = 0;
  EXPECT_RESULT(CRUMBLE_OK, create(CRUMBLE_POLICY_GUARD));
  EXPECT_RESULT(CRUMBLE_E_OUT_OF_RANGE, create(CRUMBLE_POLICY_UNCHECKED));
}

TEST_F(BadInput, BodiesOfShapes) {
  crumble_mesh_def good{};
  ASSERT_OK(crumble_mesh_def_init(&good, sizeof good));
  crumble_mesh_def bad = good;
  bad.size[1] = kNan, expect_mesh(CRUMBLE_E_INVALID_VALUE, bad, {"crumble_mesh_create", "size.y"}), bad = good;
  bad.size[2] = 0, expect_mesh(CRUMBLE_E_OUT_OF_RANGE, bad, {"size.z"}), bad = good;
  bad.spacing = -0.001, expect_mesh(CRUMBLE_E_OUT_OF_RANGE, bad, {"spacing", "-0.001"}), bad = good;
  bad.spacing = kInfinity, expect_mesh(CRUMBLE_E_INVALID_VALUE, bad, {"spacing"}), bad = good;
  bad.spacing = 0.031, expect_mesh(CRUMBLE_E_TOO_COARSE, bad, {"0.031", "at most"}), bad = good;
  bad.spacing = 1e-5, expect_mesh(CRUMBLE_E_TOO_LARGE, bad, {"spacing"}), bad = good;
  bad.spacing = 2e-9, expect_mesh(CRUMBLE_E_TOO_LARGE, bad, {"spacing"}), bad = good;
  bad.shape = 3, expect_mesh(CRUMBLE_E_OUT_OF_RANGE, bad, {"shape", "3"}), bad = good;
  bad.surface_nodes = 306, expect_mesh(CRUMBLE_E_INVALID_VALUE, bad, {"surface_nodes", "inside_nodes"}), bad = good;
  bad.surface_nodes = 3, bad.inside_nodes = 9, expect_mesh(CRUMBLE_E_OUT_OF_RANGE, bad, {"surface_nodes"}), bad = good;
  bad.shape = CRUMBLE_SHAPE_SPHERE;
  bad.radius = 0, expect_mesh(CRUMBLE_E_OUT_OF_RANGE, bad, {"radius"}), bad = good;
  bad.shape = CRUMBLE_SHAPE_CYLINDER;
  bad.height = -1, expect_mesh(CRUMBLE_E_OUT_OF_RANGE, bad, {"height"}), bad = good;
  crumble_mesh made = nullptr;
  expect_failure(CRUMBLE_E_OUT_OF_RANGE, crumble_mesh_create_paper(256, &made), {"body", "256"});
  EXPECT_EQ(made, nullptr);
}

TEST_F(BadInput, BodiesOfTetrahedra) {
  const auto expect = [](crumble_result expected, const Cube& bad, const Vector<std::string>& words) {
    crumble_mesh made = nullptr;
    expect_failure(expected, bad.create(&made), words);
    EXPECT_EQ(made, nullptr);
  };
  const Cube good(1);
  Cube bad = good;
  bad.positions[3 * 5 + 1] = kNan, expect(CRUMBLE_E_INVALID_VALUE, bad, {"node 5"}), bad = good;
  bad.tetrahedra[4 * 2 + 3] = 8, expect(CRUMBLE_E_MESH, bad, {"tetrahedron 2", "node 8"}), bad = good;
  std::swap(bad.tetrahedra[4], bad.tetrahedra[5]), expect(CRUMBLE_E_MESH, bad, {"tetrahedron 1"}), bad = good;
  std::copy_n(bad.positions.begin(), 3, bad.positions.begin() + 9);
  expect(CRUMBLE_E_DUPLICATE_NODE, bad, {"nodes 0 and 3"}), bad = good;

  crumble_mesh made = nullptr;
  const double* const p = good.positions.data();
  const std::uint32_t* const t = good.tetrahedra.data();
  Vector<double> one_more = good.positions;
  one_more.insert(one_more.end(), {1, 1, 1});
  EXPECT_RESULT(CRUMBLE_E_ISOLATED_NODE, crumble_mesh_create_from_tets(one_more.data(), 9, t, 6, &made));
  EXPECT_RESULT(CRUMBLE_E_EMPTY, crumble_mesh_create_from_tets(nullptr, 0, nullptr, 0, &made));
  EXPECT_RESULT(CRUMBLE_E_EMPTY, crumble_mesh_create_from_tets(p, 8, nullptr, 0, &made));
  EXPECT_RESULT(CRUMBLE_E_TOO_LARGE, crumble_mesh_create_from_tets(p, 0x80000000u, t, 6, &made));
  EXPECT_RESULT(CRUMBLE_E_TOO_LARGE, crumble_mesh_create_from_tets(p, 8, t, 0xffffffffu, &made));
  EXPECT_EQ(made, nullptr);
}

// In a process of its own that may take little more memory than it has.
TEST_F(BadInput, MoreThanMemory) {
  if (!AllocationCounter::available()) GTEST_SKIP() << "a sanitizer needs the address space for itself";
  const Vector<double> many(3 * 4'000'000);  // 96 MB, copied by the call
  const auto run_short = [&] {
    rlimit limit{};
    getrlimit(RLIMIT_AS, &limit);
    limit.rlim_cur = 180u << 20;
    setrlimit(RLIMIT_AS, &limit);
    crumble_mesh made = nullptr;
    const crumble_result result =
        crumble_mesh_create_from_tets(many.data(), 4'000'000, cube.tetrahedra.data(), 1, &made);
    const bool usable = cube.create(&made) == CRUMBLE_OK && crumble_mesh_destroy(made) == CRUMBLE_OK;
    std::exit(result == CRUMBLE_E_NO_MEMORY && usable ? 0 : 1);
  };
  EXPECT_EXIT(run_short(), testing::ExitedWithCode(0), "");
}

TEST_F(BadInput, Tools) {
  crumble_tool_def bad = tool;
  bad.radius = 0, expect_tool(CRUMBLE_E_OUT_OF_RANGE, bad, {"crumble_sim_add_tool", "radius"}), bad = tool;
  bad.length = kNan, expect_tool(CRUMBLE_E_INVALID_VALUE, bad, {"length"}), bad = tool;
  bad.sides = 2, expect_tool(CRUMBLE_E_OUT_OF_RANGE, bad, {"sides", "2"}), bad = tool;
  bad.shape = 8, expect_tool(CRUMBLE_E_OUT_OF_RANGE, bad, {"shape", "8"}), bad = tool;
  bad.auto_orient = 2, expect_tool(CRUMBLE_E_OUT_OF_RANGE, bad, {"auto_orient", "2"}), bad = tool;
  bad.reserved_2 = 1, expect_tool(CRUMBLE_E_OUT_OF_RANGE, bad, {"reserved_2", "1"}), bad = tool;
  bad.offset.position[1] = kNan, expect_tool(CRUMBLE_E_BAD_POSE, bad, {"offset"}), bad = tool;
  bad.offset.orientation[0] = 0, expect_tool(CRUMBLE_E_BAD_POSE, bad, {"offset"}), bad = tool;
  bad.static_friction = kNan, expect_tool(CRUMBLE_E_INVALID_VALUE, bad, {"static_friction"}), bad = tool;
  bad.dynamic_friction = -1, expect_tool(CRUMBLE_E_OUT_OF_RANGE, bad, {"dynamic_friction"}), bad = tool;
  bad.static_friction = 1, bad.dynamic_friction = 2;
  expect_tool(CRUMBLE_E_OUT_OF_RANGE, bad, {"static_friction"}), bad = tool;
  bad.shape = CRUMBLE_TOOL_BAR;
  bad.size[0] = -1, expect_tool(CRUMBLE_E_OUT_OF_RANGE, bad, {"size.x"});
}

TEST_F(BadInput, ToolsOfTheOtherKinds) {
  crumble_tool_def bad = tool;
  bad.shape = CRUMBLE_TOOL_BALL;
  bad.radius = -1, expect_tool(CRUMBLE_E_OUT_OF_RANGE, bad, {"radius", "-1"}), bad = tool;
  bad.shape = CRUMBLE_TOOL_CAPSULE;
  bad.length = -1, expect_tool(CRUMBLE_E_OUT_OF_RANGE, bad, {"length", "-1"}), bad = tool;
  bad.shape = CRUMBLE_TOOL_CONE;
  bad.length = kInfinity, expect_tool(CRUMBLE_E_INVALID_VALUE, bad, {"height"}), bad = tool;
  bad.shape = CRUMBLE_TOOL_BLADE;
  bad.bevel = 0.007, expect_tool(CRUMBLE_E_OUT_OF_RANGE, bad, {"bevel", "0.007"});
  bad.bevel = kNan, expect_tool(CRUMBLE_E_INVALID_VALUE, bad, {"bevel"});
  bad.bevel = -1, expect_tool(CRUMBLE_E_OUT_OF_RANGE, bad, {"bevel", "-1"});
  bad.bevel = 0, bad.size[1] = 0, expect_tool(CRUMBLE_E_OUT_OF_RANGE, bad, {"size.y"}), bad = tool;
  bad.shape = CRUMBLE_TOOL_SUPPORT;
  expect_tool(CRUMBLE_E_NULL, bad, {"support"});
  bad.support = [](void*, const double*, double* point) { point[0] = kNan; };
  expect_tool(CRUMBLE_E_INVALID_VALUE, bad, {});
  bad.support = [](void*, const double d[3], double* point) {
    for (int axis = 0; axis < 3; ++axis) point[axis] = 0.01 * d[axis];
  };
  bad.inside[1] = kNan, expect_tool(CRUMBLE_E_INVALID_VALUE, bad, {"inside"});
  bad.inside[1] = 0.02, expect_tool(CRUMBLE_E_OUT_OF_RANGE, bad, {"inside"});
}

TEST_F(BadInput, ToolMeshes) {
  using Vertices = Vector<double>;
  using Triangles = Vector<std::uint32_t>;
  const Vertices vertices{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const Triangles triangles{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  const auto expect = [&](crumble_result expected, const Vertices& v, const Triangles& t,
                          const Vector<std::string>& words) {
    crumble_tool_def bad = tool;
    bad.shape = CRUMBLE_TOOL_MESH;
    bad.vertex_count = static_cast<std::uint32_t>(v.size() / 3);
    bad.triangle_count = static_cast<std::uint32_t>(t.size() / 3);
    bad.vertices = v.data();
    bad.triangles = t.data();
    if (expected != CRUMBLE_OK) return expect_tool(expected, bad, words);
    std::uint32_t index = 99;
    EXPECT_RESULT(CRUMBLE_OK, crumble_sim_add_tool(sim, &bad, &index));
    EXPECT_EQ(index, 1u);
  };
  const auto with = [](auto list, std::size_t at, auto value) {
    list[at] = value;
    return list;
  };
  expect(CRUMBLE_E_MESH, vertices, {0, 2, 1, 0, 1, 3, 0, 3, 2}, {"3 triangles"});
  expect(CRUMBLE_E_MESH, vertices, with(triangles, 7, 4u), {"triangle 2", "vertex 4"});
  expect(CRUMBLE_E_MESH, with(vertices, 8, kNan), triangles, {"vertex 2"});
  expect(CRUMBLE_E_MESH, with(vertices, 3, 0.0), triangles, {"fewer than 4"});
  expect(CRUMBLE_E_MESH_ORIENTATION, vertices, {2, 0, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}, {"flipped"});
  expect(CRUMBLE_E_MESH_ORIENTATION, vertices, {2, 0, 1, 1, 0, 3, 3, 0, 2, 2, 1, 3}, {"inward"});
  expect(CRUMBLE_E_MESH_OPEN, vertices, {0, 2, 1, 0, 1, 3, 0, 3, 2, 0, 2, 1}, {"open"});
  crumble_tool_def bad = tool;
  bad.shape = CRUMBLE_TOOL_MESH;
  bad.vertex_count = 4, bad.triangle_count = 4;
  expect_tool(CRUMBLE_E_NULL, bad, {"vertices"});
  bad.vertices = vertices.data();
  expect_tool(CRUMBLE_E_NULL, bad, {"triangles"});
  bad.vertex_count = 0x80000000u;
  expect_tool(CRUMBLE_E_TOO_LARGE, bad, {"vertex_count"});
  expect(CRUMBLE_OK, vertices, triangles, {});
}

TEST_F(BadInput, WallsAndFixedNodes) {
  crumble_wall_def good{};
  ASSERT_OK(crumble_wall_def_init(&good, sizeof good));
  crumble_wall_def bad = good;
  bad.normal[0] = 1, expect_failure(CRUMBLE_E_OUT_OF_RANGE, crumble_sim_add_wall(sim, &bad), {"normal"});
  bad = good;
  bad.offset = kNan, expect_failure(CRUMBLE_E_INVALID_VALUE, crumble_sim_add_wall(sim, &bad), {"offset"});
  EXPECT_RESULT(CRUMBLE_OK, crumble_sim_add_wall(sim, &good));

  const std::uint32_t nodes[] = {0, cube.node_count()};
  expect_failure(CRUMBLE_E_OUT_OF_RANGE, crumble_sim_fix_nodes(sim, nodes, 2), {std::to_string(nodes[1])});
  EXPECT_RESULT(CRUMBLE_OK, crumble_sim_fix_nodes(sim, nodes, 1));
  EXPECT_RESULT(CRUMBLE_OK, crumble_sim_fix_nodes(sim, nullptr, 0));
  expect_failure(CRUMBLE_E_INVALID_VALUE, crumble_sim_fix_below(sim, kNan), {"height", "nan"});

  const double low[3] = {0, 0, 0}, high[3] = {1, 1, 1}, none[3] = {0, kNan, 0}, up[3] = {0, 1, 0},
               long_up[3] = {0, 2, 0};
  expect_failure(CRUMBLE_E_NULL, crumble_sim_fix_box(sim, nullptr, high), {"low"});
  expect_failure(CRUMBLE_E_NULL, crumble_sim_fix_box(sim, low, nullptr), {"high"});
  expect_failure(CRUMBLE_E_INVALID_VALUE, crumble_sim_fix_box(sim, low, none), {"high.y"});
  expect_failure(CRUMBLE_E_OUT_OF_RANGE, crumble_sim_fix_box(sim, high, low), {"low.x", "1"});
  expect_failure(CRUMBLE_E_NULL, crumble_sim_fix_plane(sim, nullptr, 0), {"normal"});
  expect_failure(CRUMBLE_E_INVALID_VALUE, crumble_sim_fix_plane(sim, none, 0), {"normal.y"});
  expect_failure(CRUMBLE_E_OUT_OF_RANGE, crumble_sim_fix_plane(sim, long_up, 0), {"normal", "2"});
  expect_failure(CRUMBLE_E_INVALID_VALUE, crumble_sim_fix_plane(sim, up, kInfinity), {"offset"});
}

TEST_F(BadInput, Attachments) {
  const std::uint32_t top = cube.node_count() - 1;
  const std::uint32_t nodes[] = {top, cube.node_count()}, fixed[] = {0}, twice[] = {top, top};
  std::uint32_t index = 99;
  const auto expect = [&](crumble_result expected, const std::uint32_t* list, std::uint32_t count,
                          const Vector<std::string>& words) {
    expect_failure(expected, crumble_sim_add_attachment(sim, list, count, &index), words);
    EXPECT_EQ(index, 99u);
    EXPECT_RESULT(CRUMBLE_OK, crumble_sim_step(sim, &kPose, &wrench));  // it has none
    EXPECT_RESULT(CRUMBLE_OK, crumble_sim_reset(sim));
  };
  expect(CRUMBLE_E_NULL, nullptr, 1, {"crumble_sim_add_attachment", "nodes"});
  expect(CRUMBLE_E_EMPTY, nullptr, 0, {"nodes"});
  expect(CRUMBLE_E_OUT_OF_RANGE, nodes, 2, {std::to_string(nodes[1])});
  expect(CRUMBLE_E_OUT_OF_RANGE, nodes, cube.node_count() + 1, {"count"});
  expect(CRUMBLE_E_STATE, fixed, 1, {"fixed"});
  expect(CRUMBLE_E_STATE, twice, 2, {"attached already"});
  ASSERT_OK(crumble_sim_add_attachment(sim, nodes, 1, &index));
  EXPECT_EQ(index, 0u);
  expect_failure(CRUMBLE_E_STATE, crumble_sim_add_attachment(sim, nodes, 1, &index), {"attached already"});
  expect_failure(CRUMBLE_E_OUT_OF_RANGE, crumble_sim_step(sim, &kPose, &wrench), {"tool_count is 1", "has 2"});
}

TEST_F(BadInput, NullPointers) {
  const crumble_mesh_def mesh_def{};
  const crumble_pose pose = pose_at(0);
  std::uint64_t bytes = 0;
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_mesh_def_init(nullptr, 64));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_sim_def_init(nullptr, sizeof(crumble_sim_def)));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_tool_def_init(nullptr, 8));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_wall_def_init(nullptr, 8));
  crumble_mesh made = nullptr;
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_mesh_create(nullptr, &made));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_mesh_create(&mesh_def, nullptr));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_mesh_create_paper(0, nullptr));
  EXPECT_RESULT(CRUMBLE_E_NULL, cube.create(nullptr));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_mesh_create_from_tets(nullptr, 8, cube.tetrahedra.data(), 6, &made));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_mesh_create_from_tets(cube.positions.data(), 8, nullptr, 6, &made));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_mesh_get_info(mesh, nullptr));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_mesh_get_view(mesh, CRUMBLE_ARRAY_SPRINGS, nullptr));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_mesh_copy(mesh, CRUMBLE_ARRAY_SPRINGS, nullptr, 0, nullptr));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_sim_create(mesh, nullptr, nullptr));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_sim_get_def(sim, nullptr));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_sim_configure(sim, nullptr));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_sim_add_tool(sim, nullptr, nullptr));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_sim_add_wall(sim, nullptr));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_sim_fix_nodes(sim, nullptr, 1));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_sim_step(sim, nullptr, &wrench));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_sim_step(sim, &pose, nullptr));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_sim_get_step_info(sim, nullptr));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_sim_get_counters(sim, nullptr));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_sim_get_profile(sim, nullptr));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_sim_get_info(sim, nullptr));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_sim_get_view(sim, CRUMBLE_ARRAY_INTACT, nullptr));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_sim_copy(sim, CRUMBLE_ARRAY_INTACT, nullptr, 0, nullptr));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_sim_count_fragments(sim, nullptr));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_sim_snapshot(sim, nullptr, 0, nullptr));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_sim_restore(sim, nullptr, 8));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_sim_state_hash(sim, nullptr));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_verify_recording(nullptr, &bytes, &bytes));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_verify_recording("x", nullptr, &bytes));
  EXPECT_RESULT(CRUMBLE_E_NULL, crumble_verify_recording("x", &bytes, nullptr));
  EXPECT_EQ(made, nullptr);
  EXPECT_EQ(info().step, 0u);
}

TEST_F(BadInput, WhatOnlyANewSimulationCanGet) {
  press(1, 3);
  const std::uint64_t before = hash();
  expect_failure(CRUMBLE_E_STATE, crumble_sim_add_tool(sim, &tool, nullptr), {"crumble_sim_add_tool", "3 steps"});
  const std::uint32_t node = cube.node_count() - 1;
  EXPECT_RESULT(CRUMBLE_E_STATE, crumble_sim_add_attachment(sim, &node, 1, nullptr));
  EXPECT_RESULT(CRUMBLE_E_STATE, crumble_sim_apply_paper_preset(sim));
  EXPECT_EQ(hash(), before);
  ASSERT_OK(crumble_sim_reset(sim));
  EXPECT_RESULT(CRUMBLE_OK, crumble_sim_add_tool(sim, &tool, nullptr));
}

}  // namespace
}  // namespace crumble
