// The ABI: sizes and places as released. A line here changes only by being added to.
#include <cstring>

#include "capi/c_client.h"
#include "capi/rig.hpp"

namespace crumble {
namespace {

struct Row {
  const char *type, *field;
  std::uint32_t bytes;
};

// On hosts with 64-bit pointers.
constexpr Row kReleased[] = {
    {"crumble_view", "", 32},
    {"crumble_view", "data", 0},
    {"crumble_view", "count", 8},
    {"crumble_view", "stride", 16},
    {"crumble_view", "components", 20},
    {"crumble_view", "scalar_type", 24},
    {"crumble_view", "reserved", 28},
    {"crumble_mesh_def", "", 64},
    {"crumble_mesh_def", "struct_size", 0},
    {"crumble_mesh_def", "shape", 4},
    {"crumble_mesh_def", "surface_nodes", 8},
    {"crumble_mesh_def", "inside_nodes", 12},
    {"crumble_mesh_def", "size", 16},
    {"crumble_mesh_def", "radius", 40},
    {"crumble_mesh_def", "height", 48},
    {"crumble_mesh_def", "spacing", 56},
    {"crumble_mesh_info", "", 32},
    {"crumble_mesh_info", "struct_size", 0},
    {"crumble_mesh_info", "node_count", 4},
    {"crumble_mesh_info", "surface_node_count", 8},
    {"crumble_mesh_info", "spring_count", 12},
    {"crumble_mesh_info", "tetrahedron_count", 16},
    {"crumble_mesh_info", "boundary_triangle_count", 20},
    {"crumble_mesh_info", "volume", 24},
    {"crumble_sim_def", "", 176},
    {"crumble_sim_def", "struct_size", 0},
    {"crumble_sim_def", "floor", 4},
    {"crumble_sim_def", "gravity", 8},
    {"crumble_sim_def", "stiffness", 32},
    {"crumble_sim_def", "damping_ratio", 40},
    {"crumble_sim_def", "length_limit", 48},
    {"crumble_sim_def", "mass", 56},
    {"crumble_sim_def", "mass_rule", 64},
    {"crumble_sim_def", "time_step_policy", 68},
    {"crumble_sim_def", "tau", 72},
    {"crumble_sim_def", "iterations", 80},
    {"crumble_sim_def", "contact_rule", 84},
    {"crumble_sim_def", "cut_fade", 88},
    {"crumble_sim_def", "mean_force", 96},
    {"crumble_sim_def", "reserved", 100},
    {"crumble_sim_def", "precision", 104},
    {"crumble_sim_def", "threads", 108},
    {"crumble_sim_def", "kernel", 112},
    {"crumble_sim_def", "host_threads", 120},
    {"crumble_sim_def", "host_context", 128},
    {"crumble_sim_def", "cut_test", 136},
    {"crumble_sim_def", "drag_frame", 140},
    {"crumble_sim_def", "surface_samples", 144},
    {"crumble_sim_def", "ball_contact", 148},
    {"crumble_sim_def", "ball_static_friction", 152},
    {"crumble_sim_def", "ball_dynamic_friction", 160},
    {"crumble_sim_def", "spring_damping", 168},
    {"crumble_tool_def", "", 208},
    {"crumble_tool_def", "struct_size", 0},
    {"crumble_tool_def", "shape", 4},
    {"crumble_tool_def", "radius", 8},
    {"crumble_tool_def", "length", 16},
    {"crumble_tool_def", "size", 24},
    {"crumble_tool_def", "sides", 48},
    {"crumble_tool_def", "vertex_count", 52},
    {"crumble_tool_def", "triangle_count", 56},
    {"crumble_tool_def", "reserved", 60},
    {"crumble_tool_def", "static_friction", 64},
    {"crumble_tool_def", "dynamic_friction", 72},
    {"crumble_tool_def", "vertices", 80},
    {"crumble_tool_def", "triangles", 88},
    {"crumble_tool_def", "offset", 96},
    {"crumble_tool_def", "bevel", 152},
    {"crumble_tool_def", "auto_orient", 160},
    {"crumble_tool_def", "reserved_2", 164},
    {"crumble_tool_def", "support", 168},
    {"crumble_tool_def", "support_context", 176},
    {"crumble_tool_def", "inside", 184},
    {"crumble_wall_def", "", 56},
    {"crumble_wall_def", "struct_size", 0},
    {"crumble_wall_def", "reserved", 4},
    {"crumble_wall_def", "normal", 8},
    {"crumble_wall_def", "offset", 32},
    {"crumble_wall_def", "static_friction", 40},
    {"crumble_wall_def", "dynamic_friction", 48},
    {"crumble_pose", "", 56},
    {"crumble_pose", "position", 0},
    {"crumble_pose", "orientation", 24},
    {"crumble_wrench", "", 48},
    {"crumble_wrench", "force", 0},
    {"crumble_wrench", "torque", 24},
    {"crumble_step_info", "", 40},
    {"crumble_step_info", "struct_size", 0},
    {"crumble_step_info", "status", 4},
    {"crumble_step_info", "step", 8},
    {"crumble_step_info", "time", 16},
    {"crumble_step_info", "flags", 24},
    {"crumble_step_info", "contacts", 28},
    {"crumble_step_info", "new_cuts", 32},
    {"crumble_step_info", "bad_node", 36},
    {"crumble_counters", "", 88},
    {"crumble_counters", "struct_size", 0},
    {"crumble_counters", "reserved", 4},
    {"crumble_counters", "guarded_nodes", 8},
    {"crumble_counters", "cuts", 16},
    {"crumble_counters", "tool_jumps", 24},
    {"crumble_counters", "suspended_steps", 32},
    {"crumble_counters", "bad_poses", 40},
    {"crumble_counters", "dropped_events", 48},
    {"crumble_counters", "asleep", 56},
    {"crumble_counters", "woken", 64},
    {"crumble_counters", "removed", 72},
    {"crumble_counters", "removed_nodes", 80},
    {"crumble_profile", "", 72},
    {"crumble_profile", "struct_size", 0},
    {"crumble_profile", "reserved", 4},
    {"crumble_profile", "move_tool", 8},
    {"crumble_profile", "find_contacts", 16},
    {"crumble_profile", "project_contacts", 24},
    {"crumble_profile", "solve_network", 32},
    {"crumble_profile", "cut_springs", 40},
    {"crumble_profile", "sum_reaction", 48},
    {"crumble_profile", "finish_step", 56},
    {"crumble_profile", "touch_fragments", 64},
    {"crumble_sim_info", "", 32},
    {"crumble_sim_info", "struct_size", 0},
    {"crumble_sim_info", "kernel", 4},
    {"crumble_sim_info", "springs_in_segments", 8},
    {"crumble_sim_info", "lanes", 12},
    {"crumble_sim_info", "segments", 16},
    {"crumble_sim_info", "batches", 20},
    {"crumble_sim_info", "partitions", 24},
    {"crumble_sim_info", "sorted", 28},
    {"crumble_surface_info", "", 24},
    {"crumble_surface_info", "struct_size", 0},
    {"crumble_surface_info", "vertex_count", 4},
    {"crumble_surface_info", "triangle_count", 8},
    {"crumble_surface_info", "skin_triangle_count", 12},
    {"crumble_surface_info", "fragment_count", 16},
    {"crumble_surface_info", "reserved", 20},
    {"crumble_reader_def", "", 24},
    {"crumble_reader_def", "struct_size", 0},
    {"crumble_reader_def", "surface_mode", 4},
    {"crumble_reader_def", "settle", 8},
    {"crumble_reader_def", "crease", 16},
    {"crumble_reader_info", "", 64},
    {"crumble_reader_info", "struct_size", 0},
    {"crumble_reader_info", "fragment_count", 4},
    {"crumble_reader_info", "step", 8},
    {"crumble_reader_info", "time", 16},
    {"crumble_reader_info", "first_step", 24},
    {"crumble_reader_info", "cuts", 32},
    {"crumble_reader_info", "dropped_events", 40},
    {"crumble_reader_info", "vertex_count", 48},
    {"crumble_reader_info", "triangle_count", 52},
    {"crumble_reader_info", "skin_triangle_count", 56},
    {"crumble_reader_info", "surface_rebuilt", 60},
    {"crumble_fragment_info", "", 168},
    {"crumble_fragment_info", "struct_size", 0},
    {"crumble_fragment_info", "node_count", 4},
    {"crumble_fragment_info", "tetrahedron_count", 8},
    {"crumble_fragment_info", "least_node", 12},
    {"crumble_fragment_info", "parent", 16},
    {"crumble_fragment_info", "state", 20},
    {"crumble_fragment_info", "born", 24},
    {"crumble_fragment_info", "mass", 32},
    {"crumble_fragment_info", "rest_volume", 40},
    {"crumble_fragment_info", "center", 48},
    {"crumble_fragment_info", "low", 72},
    {"crumble_fragment_info", "high", 96},
    {"crumble_fragment_info", "inertia", 120},
    {"crumble_event", "", 72},
    {"crumble_event", "kind", 0},
    {"crumble_event", "spring", 4},
    {"crumble_event", "node", 8},
    {"crumble_event", "holder", 12},
    {"crumble_event", "fragment", 16},
    {"crumble_event", "parent", 20},
    {"crumble_event", "step", 24},
    {"crumble_event", "time", 32},
    {"crumble_event", "place", 40},
    {"crumble_event", "energy", 64},
    {"crumble_contact", "", 88},
    {"crumble_contact", "node", 0},
    {"crumble_contact", "holder", 4},
    {"crumble_contact", "state", 8},
    {"crumble_contact", "reserved", 12},
    {"crumble_contact", "point", 16},
    {"crumble_contact", "normal", 40},
    {"crumble_contact", "reaction", 64},
    {"crumble_local_contact", "", 176},
    {"crumble_local_contact", "arm", 0},
    {"crumble_local_contact", "normal", 24},
    {"crumble_local_contact", "force", 48},
    {"crumble_local_contact", "inner", 72},
    {"crumble_local_contact", "stiffness", 96},
    {"crumble_local_contact", "grip", 168},
    {"crumble_local_model", "", 17752},
    {"crumble_local_model", "at", 0},
    {"crumble_local_model", "wrench", 56},
    {"crumble_local_model", "jacobian", 104},
    {"crumble_local_model", "stiffness", 392},
    {"crumble_local_model", "radius", 464},
    {"crumble_local_model", "held_drag", 472},
    {"crumble_local_model", "fracture", 480},
    {"crumble_local_model", "contact_count", 484},
    {"crumble_local_model", "listed", 488},
    {"crumble_local_model", "reserved", 492},
    {"crumble_local_model", "rest", 496},
    {"crumble_local_model", "rest_jacobian", 544},
    {"crumble_local_model", "rest_normal", 832},
    {"crumble_local_model", "contacts", 856},
};

TEST(Layout, IsTheReleasedOne) {
  if (sizeof(void*) != 8) GTEST_SKIP() << "the table is for 64-bit hosts";
  std::size_t row = 0;
  for (const c_layout* now = c_layouts; now->type; ++now, ++row) {
    ASSERT_LT(row, std::size(kReleased));
    const std::string what = std::string(now->type) + "." + now->field;
    EXPECT_STREQ(now->type, kReleased[row].type) << what;
    EXPECT_STREQ(now->field, kReleased[row].field) << what;
    EXPECT_EQ(now->bytes, kReleased[row].bytes) << what;
  }
  EXPECT_EQ(row, std::size(kReleased));
}

TEST(Version, AgreesWithTheHeader) {
  EXPECT_EQ(crumble_version(), std::uint32_t{CRUMBLE_VERSION_NUMBER});
  EXPECT_EQ(std::string(crumble_version_string()), CRUMBLE_EXPECTED_VERSION);
  EXPECT_NE(std::string(crumble_build_info()).find(CRUMBLE_EXPECTED_VERSION), std::string::npos);
  EXPECT_RESULT(CRUMBLE_OK, crumble_check_version(CRUMBLE_VERSION_NUMBER));
  EXPECT_RESULT(CRUMBLE_OK, crumble_check_version(CRUMBLE_VERSION_NUMBER + 7));  // a patch
  EXPECT_RESULT(CRUMBLE_E_VERSION, crumble_check_version(CRUMBLE_VERSION_NUMBER + 1000));
  EXPECT_RESULT(CRUMBLE_E_VERSION, crumble_check_version(CRUMBLE_VERSION_NUMBER + 1000000));
  EXPECT_RESULT(CRUMBLE_E_VERSION, crumble_check_version(0));
}

TEST(Results, HaveNames) {
  EXPECT_STREQ(crumble_result_name(CRUMBLE_OK), "CRUMBLE_OK");
  EXPECT_STREQ(crumble_result_name(CRUMBLE_E_NULL), "CRUMBLE_E_NULL");
  EXPECT_STREQ(crumble_result_name(CRUMBLE_E_BUFFER_TOO_SMALL), "CRUMBLE_E_BUFFER_TOO_SMALL");
  for (crumble_result code = CRUMBLE_E_INTERNAL; code < 0; ++code) {
    EXPECT_EQ(name_of(code).rfind("CRUMBLE_E_", 0), 0u) << code;
    for (crumble_result other = CRUMBLE_E_INTERNAL; other < code; ++other) EXPECT_NE(name_of(code), name_of(other));
  }
  EXPECT_STREQ(crumble_result_name(1), "unknown");
  EXPECT_STREQ(crumble_result_name(CRUMBLE_E_INTERNAL - 1), "unknown");
}

}  // namespace
}  // namespace crumble
