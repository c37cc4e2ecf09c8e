#include "c_client.h"

#include <math.h>
#include <stddef.h>

#define SIZE(type) {#type, "", (uint32_t)sizeof(type)}
#define FIELD(type, field) {#type, #field, (uint32_t)offsetof(type, field)}

const c_layout c_layouts[] = {SIZE(crumble_view),
                              FIELD(crumble_view, data),
                              FIELD(crumble_view, count),
                              FIELD(crumble_view, stride),
                              FIELD(crumble_view, components),
                              FIELD(crumble_view, scalar_type),
                              FIELD(crumble_view, reserved),
                              SIZE(crumble_mesh_def),
                              FIELD(crumble_mesh_def, struct_size),
                              FIELD(crumble_mesh_def, shape),
                              FIELD(crumble_mesh_def, surface_nodes),
                              FIELD(crumble_mesh_def, inside_nodes),
                              FIELD(crumble_mesh_def, size),
                              FIELD(crumble_mesh_def, radius),
                              FIELD(crumble_mesh_def, height),
                              FIELD(crumble_mesh_def, spacing),
                              SIZE(crumble_mesh_info),
                              FIELD(crumble_mesh_info, struct_size),
                              FIELD(crumble_mesh_info, node_count),
                              FIELD(crumble_mesh_info, surface_node_count),
                              FIELD(crumble_mesh_info, spring_count),
                              FIELD(crumble_mesh_info, tetrahedron_count),
                              FIELD(crumble_mesh_info, boundary_triangle_count),
                              FIELD(crumble_mesh_info, volume),
                              SIZE(crumble_sim_def),
                              FIELD(crumble_sim_def, struct_size),
                              FIELD(crumble_sim_def, floor),
                              FIELD(crumble_sim_def, gravity),
                              FIELD(crumble_sim_def, stiffness),
                              FIELD(crumble_sim_def, damping_ratio),
                              FIELD(crumble_sim_def, length_limit),
                              FIELD(crumble_sim_def, mass),
                              FIELD(crumble_sim_def, mass_rule),
                              FIELD(crumble_sim_def, time_step_policy),
                              FIELD(crumble_sim_def, tau),
                              FIELD(crumble_sim_def, iterations),
                              FIELD(crumble_sim_def, contact_rule),
                              FIELD(crumble_sim_def, cut_fade),
                              FIELD(crumble_sim_def, mean_force),
                              FIELD(crumble_sim_def, reserved),
                              FIELD(crumble_sim_def, precision),
                              FIELD(crumble_sim_def, threads),
                              FIELD(crumble_sim_def, kernel),
                              FIELD(crumble_sim_def, host_threads),
                              FIELD(crumble_sim_def, host_context),
                              SIZE(crumble_tool_def),
                              FIELD(crumble_tool_def, struct_size),
                              FIELD(crumble_tool_def, shape),
                              FIELD(crumble_tool_def, radius),
                              FIELD(crumble_tool_def, length),
                              FIELD(crumble_tool_def, size),
                              FIELD(crumble_tool_def, sides),
                              FIELD(crumble_tool_def, vertex_count),
                              FIELD(crumble_tool_def, triangle_count),
                              FIELD(crumble_tool_def, reserved),
                              FIELD(crumble_tool_def, static_friction),
                              FIELD(crumble_tool_def, dynamic_friction),
                              FIELD(crumble_tool_def, vertices),
                              FIELD(crumble_tool_def, triangles),
                              SIZE(crumble_wall_def),
                              FIELD(crumble_wall_def, struct_size),
                              FIELD(crumble_wall_def, reserved),
                              FIELD(crumble_wall_def, normal),
                              FIELD(crumble_wall_def, offset),
                              FIELD(crumble_wall_def, static_friction),
                              FIELD(crumble_wall_def, dynamic_friction),
                              SIZE(crumble_pose),
                              FIELD(crumble_pose, position),
                              FIELD(crumble_pose, orientation),
                              SIZE(crumble_wrench),
                              FIELD(crumble_wrench, force),
                              FIELD(crumble_wrench, torque),
                              SIZE(crumble_step_info),
                              FIELD(crumble_step_info, struct_size),
                              FIELD(crumble_step_info, status),
                              FIELD(crumble_step_info, step),
                              FIELD(crumble_step_info, time),
                              FIELD(crumble_step_info, flags),
                              FIELD(crumble_step_info, contacts),
                              FIELD(crumble_step_info, new_cuts),
                              FIELD(crumble_step_info, bad_node),
                              SIZE(crumble_counters),
                              FIELD(crumble_counters, struct_size),
                              FIELD(crumble_counters, reserved),
                              FIELD(crumble_counters, guarded_nodes),
                              FIELD(crumble_counters, cuts),
                              FIELD(crumble_counters, tool_jumps),
                              FIELD(crumble_counters, suspended_steps),
                              FIELD(crumble_counters, bad_poses),
                              SIZE(crumble_profile),
                              FIELD(crumble_profile, struct_size),
                              FIELD(crumble_profile, reserved),
                              FIELD(crumble_profile, move_tool),
                              FIELD(crumble_profile, find_contacts),
                              FIELD(crumble_profile, project_contacts),
                              FIELD(crumble_profile, solve_network),
                              FIELD(crumble_profile, cut_springs),
                              FIELD(crumble_profile, sum_reaction),
                              FIELD(crumble_profile, finish_step),
                              SIZE(crumble_sim_info),
                              FIELD(crumble_sim_info, struct_size),
                              FIELD(crumble_sim_info, kernel),
                              FIELD(crumble_sim_info, springs_in_segments),
                              FIELD(crumble_sim_info, lanes),
                              FIELD(crumble_sim_info, segments),
                              FIELD(crumble_sim_info, batches),
                              FIELD(crumble_sim_info, partitions),
                              FIELD(crumble_sim_info, sorted),
                              SIZE(crumble_surface_info),
                              FIELD(crumble_surface_info, struct_size),
                              FIELD(crumble_surface_info, vertex_count),
                              FIELD(crumble_surface_info, triangle_count),
                              FIELD(crumble_surface_info, skin_triangle_count),
                              FIELD(crumble_surface_info, fragment_count),
                              FIELD(crumble_surface_info, reserved),
                              {NULL, NULL, 0}};

double c_press(crumble_mesh mesh) {
  crumble_sim_def def;
  crumble_tool_def tool;
  crumble_sim sim = NULL;
  crumble_pose pose = {{0, 0.034, 0}, {1, 0, 0, 0}};
  crumble_wrench wrench = {{0, 0, 0}, {0, 0, 0}};
  crumble_result result = crumble_sim_def_init(&def, sizeof def);
  int step;
  if (result == CRUMBLE_OK) result = crumble_sim_create(mesh, &def, &sim);
  if (result == CRUMBLE_OK) result = crumble_tool_def_init(&tool, sizeof tool);
  if (result == CRUMBLE_OK) result = crumble_sim_add_tool(sim, &tool, NULL);
  if (result == CRUMBLE_OK) result = crumble_sim_fix_below(sim, 1e-6);
  for (step = 1; step <= 150 && result == CRUMBLE_OK; ++step) {
    pose.position[1] = 0.034 - 2e-5 * step;
    result = crumble_sim_step(sim, &pose, &wrench);
  }
  crumble_sim_destroy(sim);
  return result == CRUMBLE_OK ? wrench.force[1] : NAN;
}
