// A small cube and a stick, made through C and, with the same numbers, through C++.
#pragma once

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "crumble/base/memory.hpp"
#include "crumble/crumble.h"
#include "crumble/sim/simulation.hpp"
#include "crumble/tetmesh/lattice_box.hpp"

namespace crumble {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// By name, so that a failure can be read.
inline std::string name_of(crumble_result result) {
  return crumble_result_name(result);
}
#define EXPECT_RESULT(expected, call) EXPECT_EQ(name_of(expected), name_of(call))
#define ASSERT_OK(call) ASSERT_EQ(name_of(CRUMBLE_OK), name_of(call)) << crumble_last_error()

/// The call fails so, and the text names the function and every one of `words`.
inline void expect_failure(crumble_result expected, crumble_result got, const Vector<std::string>& words) {
  EXPECT_EQ(name_of(expected), name_of(got));
  const std::string text = crumble_last_error();
  for (const std::string& word : words) EXPECT_NE(text.find(word), std::string::npos) << text << "\nlacks " << word;
}

/// A 3 cm cube of `cells` per edge, as crumble_mesh_create_from_tets takes it.
struct Cube {
  explicit Cube(std::uint32_t cells = 6) : mesh(make_lattice_box({0.03, 0.03, 0.03}, 0.03 / cells)) {
    mesh = make_tet_mesh(mesh.positions, mesh.tetrahedra);  // with the kinds that C gives it
    for (const Vec3& p : mesh.positions) positions.insert(positions.end(), {p.x(), p.y(), p.z()});
    for (const Tetrahedron& t : mesh.tetrahedra) tetrahedra.insert(tetrahedra.end(), t.begin(), t.end());
  }
  std::uint32_t node_count() const { return static_cast<std::uint32_t>(mesh.node_count()); }
  std::uint32_t tetrahedron_count() const { return static_cast<std::uint32_t>(mesh.tetrahedra.size()); }
  crumble_result create(crumble_mesh* out) const {
    return crumble_mesh_create_from_tets(positions.data(), node_count(), tetrahedra.data(), tetrahedron_count(), out);
  }

  TetMesh mesh;
  Vector<double> positions;
  Vector<std::uint32_t> tetrahedra;
};

/// A cube that stands fixed under a stick; its springs break early.
class CapiTest : public testing::Test {
 protected:
  explicit CapiTest(const Cube& body = Cube()) : cube(body) {}
  void SetUp() override {
    ASSERT_OK(cube.create(&mesh));
    ASSERT_OK(crumble_sim_def_init(&def, sizeof def));
    def.length_limit = 1.1;
    ASSERT_OK(crumble_tool_def_init(&tool, sizeof tool));
    tool.static_friction = 3;
    tool.dynamic_friction = 1.5;
    sim = make_sim();
  }
  void TearDown() override {
    EXPECT_RESULT(CRUMBLE_OK, crumble_sim_destroy(sim));
    EXPECT_RESULT(CRUMBLE_OK, crumble_mesh_destroy(mesh));
  }
  crumble_sim make_sim() {
    crumble_sim made = nullptr;
    EXPECT_RESULT(CRUMBLE_OK, crumble_sim_create(mesh, &def, &made));
    EXPECT_RESULT(CRUMBLE_OK, crumble_sim_add_tool(made, &tool, nullptr));
    EXPECT_RESULT(CRUMBLE_OK, crumble_sim_fix_below(made, 1e-6));
    return made;
  }
  /// Down at 20 mm/s with a turn about the vertical: forces and torques on every axis.
  static crumble_pose pose_at(int step) { return {{2e-6 * step, 0.034 - 2e-5 * step, 0}, {0.8, 0, 0.6, 0}}; }
  void press(int first, int last) {
    for (int step = first; step <= last; ++step) {
      const crumble_pose pose = pose_at(step);
      ASSERT_OK(crumble_sim_step(sim, &pose, &wrench));
    }
  }
  std::uint64_t hash() {
    std::uint64_t value = 0;
    EXPECT_RESULT(CRUMBLE_OK, crumble_sim_state_hash(sim, &value));
    return value;
  }
  crumble_step_info info() {
    crumble_step_info value{};
    value.struct_size = sizeof value;
    EXPECT_RESULT(CRUMBLE_OK, crumble_sim_get_step_info(sim, &value));
    return value;
  }
  crumble_counters counters() {
    crumble_counters value{};
    value.struct_size = sizeof value;
    EXPECT_RESULT(CRUMBLE_OK, crumble_sim_get_counters(sim, &value));
    return value;
  }

  const Cube cube;
  crumble_mesh mesh = nullptr;
  crumble_sim_def def{};
  crumble_tool_def tool{};
  crumble_sim sim = nullptr;
  crumble_wrench wrench{};
};

}  // namespace crumble
