// Every kind of tool, several of them, regions and attachments: C makes what C++ makes.
#include <cmath>

#include "capi/rig.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/geometry/mesh_solid.hpp"
#include "crumble/geometry/support_solid.hpp"
#include "crumble/geometry/tool_solids.hpp"

namespace crumble {
namespace {

class ToolKinds : public CapiTest {
 protected:
  // The definition of `sim` in C++, with another tool.
  SimulationDef twin(Tool shaped) const {
    SimulationDef twin;
    twin.mesh = cube.mesh;
    twin.material.length_limit = def.length_limit;
    twin.fixed_nodes = nodes_below(twin.mesh, 1e-6);
    shaped.friction = {tool.static_friction, tool.dynamic_friction};
    twin.tools.push_back(std::move(shaped));
    return twin;
  }
  static Pose to_pose(const crumble_pose& pose) {
    const auto& [x, y, z] = pose.position;
    const double* const q = pose.orientation;
    return {{x, y, z}, Quat(q[0], q[1], q[2], q[3])};
  }
  // Presses the tool 5 mm into the cube, through C and through C++.
  void expect_the_same(const Solid& shape, const Pose& offset = {}) {
    ASSERT_OK(crumble_sim_destroy(sim));
    sim = make_sim();
    Simulation other(twin({shape, {}, offset}));
    const double lowest = lowest_point(*shape, Frame(offset));
    double greatest = 0;
    for (int step = 0; step < 250; ++step) {
      const crumble_pose pose = {{0.001, 0.03 - lowest - 2e-5 * step, 0.002}, {1, 0, 0, 0}};
      ASSERT_OK(crumble_sim_step(sim, &pose, &wrench));
      const Pose same = to_pose(pose);
      other.step({&same, 1});
      ASSERT_EQ(wrench.force[1], other.wrench(0).force.y()) << step;
      ASSERT_EQ(wrench.torque[2], other.wrench(0).torque.z()) << step;
      greatest = std::max(greatest, wrench.force[1]);
    }
    EXPECT_EQ(hash(), other.state_hash());
    EXPECT_GT(greatest, 1e-3) << "it has met the cube";
  }
};

TEST_F(ToolKinds, AreThoseOfTheLibrary) {
  tool.radius = 0.008;
  tool.shape = CRUMBLE_TOOL_BALL;
  expect_the_same(make_ball(0.008));
  tool.length = 0.03;
  tool.shape = CRUMBLE_TOOL_CAPSULE;
  expect_the_same(make_capsule(0.008, 0.03));
  tool.shape = CRUMBLE_TOOL_CONE;
  expect_the_same(make_cone(0.008, 0.03));
  tool.shape = CRUMBLE_TOOL_BLADE;
  tool.size[0] = 0.004, tool.size[1] = 0.02, tool.size[2] = 0.05;
  expect_the_same(make_blade({0.004, 0.02, 0.05}, 0.02));
  tool.bevel = 0.005;
  expect_the_same(make_blade({0.004, 0.02, 0.05}, 0.005));
}

TEST_F(ToolKinds, StandWhereTheirOffsetPutsThem) {
  tool.shape = CRUMBLE_TOOL_CONE;
  tool.radius = 0.006, tool.length = 0.02;
  tool.offset = {{0.004, -0.01, -0.002}, {std::sqrt(0.5), -std::sqrt(0.5), 0, 0}};  // the point looks down, onto a node
  expect_the_same(make_cone(0.006, 0.02), to_pose(tool.offset));
  const crumble_pose none = {{0, 0, 0}, {1, 0, 0, 0}};
  crumble_tool_def fresh;
  ASSERT_OK(crumble_tool_def_init(&fresh, sizeof fresh));
  EXPECT_EQ(std::memcmp(&fresh.offset, &none, sizeof none), 0);
}

// A block with a groove along its lower side; its inner edge would be cut off if it were taken for convex.
TEST_F(ToolKinds, MeshesMayBeConcaveAndInsideOut) {
  Vector<double> vertices;
  const double outline[6][2] = {{-8, 5}, {-8, -5}, {0, 0}, {8, -5}, {8, 5}, {0, 6}};  // mm, counter-clockwise
  for (const auto& [x, y] : outline) {
    for (const double z : {-20.0, 20.0}) vertices.insert(vertices.end(), {1e-3 * x, 1e-3 * y, 1e-3 * z});
  }
  Vector<std::uint32_t> triangles;
  for (std::uint32_t i = 0; i < 6; ++i) {
    const std::uint32_t back = 2 * i, next = 2 * ((i + 1) % 6);
    triangles.insert(triangles.end(), {back, next, next + 1, back, next + 1, back + 1});
  }
  for (const auto& [a, b, c] : {std::array{0u, 1u, 2u}, {0u, 2u, 5u}, {5u, 2u, 4u}, {4u, 2u, 3u}}) {
    triangles.insert(triangles.end(), {2 * a, 2 * c, 2 * b, 2 * a + 1, 2 * b + 1, 2 * c + 1});
  }
  TriangleMesh surface;
  for (std::size_t v = 0; v < 12; ++v)
    surface.vertices.push_back({vertices[3 * v], vertices[3 * v + 1], vertices[3 * v + 2]});
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    surface.triangles.push_back({triangles[t], triangles[t + 1], triangles[t + 2]});
  }
  tool.shape = CRUMBLE_TOOL_MESH;
  tool.vertex_count = 12, tool.vertices = vertices.data();
  tool.triangle_count = static_cast<std::uint32_t>(triangles.size() / 3), tool.triangles = triangles.data();
  expect_the_same(make_mesh_solid(surface));

  for (std::size_t t = 0; t < triangles.size(); t += 3) std::swap(triangles[t], triangles[t + 1]);
  ASSERT_OK(crumble_sim_reset(sim));
  EXPECT_RESULT(CRUMBLE_E_MESH_ORIENTATION, crumble_sim_add_tool(sim, &tool, nullptr));
  tool.auto_orient = 1;
  for (Triangle& t : surface.triangles) std::swap(t[0], t[1]);
  expect_the_same(make_mesh_solid(surface, {.auto_orient = true}));
}

TEST_F(ToolKinds, MayBeWhatAHostKnows) {
  static constexpr double kAxes[3] = {0.01, 0.006, 0.02};  // of an ellipsoid
  const crumble_support_function ellipsoid = [](void* context, const double d[3], double point[3]) {
    const auto* axes = static_cast<const double*>(context);
    double length = 0;
    for (int axis = 0; axis < 3; ++axis) length += axes[axis] * d[axis] * axes[axis] * d[axis];
    for (int axis = 0; axis < 3; ++axis) point[axis] = axes[axis] * axes[axis] * d[axis] / std::sqrt(length);
  };
  tool.shape = CRUMBLE_TOOL_SUPPORT;
  tool.support = ellipsoid;
  tool.support_context = const_cast<double*>(kAxes);
  expect_the_same(make_support_solid({ellipsoid, tool.support_context}, Vec3::Zero()));
}

TEST_F(ToolKinds, TwoHaveTheirOwnPosesAndWrenches) {
  ASSERT_OK(crumble_sim_destroy(sim));
  sim = make_sim();
  crumble_tool_def ball;
  ASSERT_OK(crumble_tool_def_init(&ball, sizeof ball));
  ball.shape = CRUMBLE_TOOL_BALL;
  ball.radius = 0.005;
  std::uint32_t index = 0;
  ASSERT_OK(crumble_sim_add_tool(sim, &ball, &index));
  EXPECT_EQ(index, 1u);
  crumble_wrench wrenches[2];
  for (int step = 0; step < 200; ++step) {
    const crumble_pose poses[2] = {{{-0.0191 + 1e-5 * step, 0.015, 0}, {1, 0, 0, 0}},
                                   {{0.0201 - 1e-5 * step, 0.015, 0}, {1, 0, 0, 0}}};
    ASSERT_OK(crumble_sim_step_tools(sim, poses, wrenches, 2));
  }
  EXPECT_LT(wrenches[0].force[0], -0.01) << "pushed back to the left";
  EXPECT_GT(wrenches[1].force[0], 0.01) << "and to the right";
}

class Regions : public CapiTest {
 protected:
  // Nodes that a body without support no longer loses when it falls: those that stand still are the fixed ones.
  Vector<std::uint32_t> fixed_nodes(crumble_sim made) {
    crumble_wrench out;
    for (int step = 0; step < 5; ++step) {
      const crumble_pose away = {{0, 1, 0}, {1, 0, 0, 0}};
      EXPECT_RESULT(CRUMBLE_OK, crumble_sim_step(made, &away, &out));
    }
    Vector<double> now(3 * cube.node_count());
    EXPECT_RESULT(CRUMBLE_OK, crumble_sim_copy(made, CRUMBLE_ARRAY_POSITIONS, now.data(), 8 * now.size(), nullptr));
    Vector<std::uint32_t> still;
    for (std::uint32_t i = 0; i < cube.node_count(); ++i) {
      if (now[3 * i] == cube.positions[3 * i] && now[3 * i + 1] == cube.positions[3 * i + 1]) still.push_back(i);
    }
    return still;
  }
};

TEST_F(Regions, AreAddedToWhatIsFixed) {
  ASSERT_OK(crumble_sim_destroy(sim));
  def.gravity[0] = 3;
  ASSERT_OK(crumble_sim_create(mesh, &def, &sim));
  ASSERT_OK(crumble_sim_add_tool(sim, &tool, nullptr));
  const double low[3] = {-1, 0.024, -1}, high[3] = {-0.0149, 1, 1}, right[3] = {-1, 0, 0};
  ASSERT_OK(crumble_sim_fix_box(sim, low, high));
  ASSERT_OK(crumble_sim_fix_plane(sim, right, -0.0149));
  Vector<std::uint32_t> expected;
  for (std::uint32_t i = 0; i < cube.node_count(); ++i) {
    const double x = cube.positions[3 * i], y = cube.positions[3 * i + 1];
    if ((x < -0.0149 && y > 0.024) || x > 0.0149) expected.push_back(i);
  }
  ASSERT_GT(expected.size(), 49u);
  EXPECT_EQ(fixed_nodes(sim), expected);
}

// The cube's top is taken 1 mm up and to the side, and turned.
TEST_F(Regions, AttachmentsGoWhereTheyAreTaken) {
  Vector<std::uint32_t> top;
  for (std::uint32_t i = 0; i < cube.node_count(); ++i) {
    if (cube.positions[3 * i + 1] > 0.0299) top.push_back(i);
  }
  std::uint32_t index = 99;
  ASSERT_OK(crumble_sim_add_attachment(sim, top.data(), static_cast<std::uint32_t>(top.size()), &index));
  EXPECT_EQ(index, 0u);
  crumble_wrench wrenches[2];
  for (int step = 0; step <= 500; ++step) {
    const double angle = 1e-4 * step;
    const crumble_pose poses[2] = {
        {{0, 1, 0}, {1, 0, 0, 0}},
        {{2e-6 * step, 0.03 + 2e-6 * step, 0}, {std::cos(angle / 2), 0, std::sin(angle / 2), 0}}};
    ASSERT_OK(crumble_sim_step_tools(sim, poses, wrenches, 2));
  }
  Vector<double> now(3 * cube.node_count());
  ASSERT_OK(crumble_sim_copy(sim, CRUMBLE_ARRAY_POSITIONS, now.data(), 8 * now.size(), nullptr));
  for (const std::uint32_t i : top) {
    const Vec3 rest(cube.positions[3 * i], 0, cube.positions[3 * i + 2]);
    const Vec3 expected = Vec3(0.001, 0.031, 0) + rotate(rotation_matrix(axis_angle({0, 1, 0}, 0.05)), rest);
    EXPECT_NEAR(norm(Vec3(now[3 * i], now[3 * i + 1], now[3 * i + 2]) - expected), 0, 1e-12) << i;
  }
  EXPECT_LT(wrenches[1].force[0], -0.01) << "the body pulls the clamp back";
  EXPECT_EQ(wrenches[0].force[0], 0);
}

TEST_F(ToolKinds, DefaultsAreThoseOfTheLibrary) {
  const SimulationDef library;
  crumble_sim_def fresh;
  ASSERT_OK(crumble_sim_def_init(&fresh, sizeof fresh));
  EXPECT_EQ(fresh.cut_test, static_cast<std::uint32_t>(library.step.cut_test));
  EXPECT_EQ(fresh.drag_frame, static_cast<std::uint32_t>(library.step.drag_frame));
  EXPECT_EQ(fresh.surface_samples, 1u);
  EXPECT_EQ(fresh.ball_contact, 1u);
  EXPECT_EQ(fresh.ball_static_friction, library.ball_friction.static_coefficient);
  EXPECT_EQ(fresh.ball_dynamic_friction, library.ball_friction.dynamic_coefficient);
  EXPECT_EQ(fresh.spring_damping, library.material.spring_damping);
}

// What is set comes back, and the paper's choices show.
TEST_F(ToolKinds, TheNewFieldsAreKept) {
  def.cut_test = CRUMBLE_CUT_TEST_AFTER_MOVE;
  def.drag_frame = CRUMBLE_DRAG_ROOM;
  def.surface_samples = def.ball_contact = 0;
  def.ball_static_friction = 0.8, def.ball_dynamic_friction = 0.7;
  def.spring_damping = 0.01;
  crumble_sim made = nullptr;
  ASSERT_OK(crumble_sim_create(mesh, &def, &made));
  crumble_sim_def now{};
  now.struct_size = sizeof now;
  ASSERT_OK(crumble_sim_get_def(made, &now));
  EXPECT_EQ(std::memcmp(&now, &def, sizeof now), 0);
  ASSERT_OK(crumble_sim_destroy(made));
  ASSERT_OK(crumble_sim_apply_paper_preset(sim));
  ASSERT_OK(crumble_sim_get_def(sim, &now));
  EXPECT_EQ(now.drag_frame, std::uint32_t{CRUMBLE_DRAG_ROOM});
  EXPECT_EQ(now.cut_test, std::uint32_t{CRUMBLE_CUT_TEST_AFTER_MOVE});
  EXPECT_EQ(now.surface_samples, 0u);
  EXPECT_EQ(now.ball_contact, 0u);
}

}  // namespace
}  // namespace crumble
