/* any_device replay|phantom|custom|hand|...: the paper's tofu cube under whatever device one word names, for 3 s. */
#include <crumble/crumble.h>
#include <stdio.h>

#define TRY(call) if ((call) != CRUMBLE_OK) return fprintf(stderr, "%s\n", crumble_last_error()), 1

static crumble_result sink(crumble_device_sample *sample, void *height) { /* custom: down at 5 mm/s */
  sample->pose.position[1] = *(double *)height -= 5e-6;
  return CRUMBLE_OK;
}
static crumble_result feel(const double *force, const double *torque, void *height) {
  return force && torque && height ? CRUMBLE_OK : CRUMBLE_E_NULL;
}

int main(int argc, char **argv) {
  double height = 0.006;
  crumble_device_callbacks own = {sizeof own, CRUMBLE_SENSES_POSITION, 0, 0, &height, sink, feel};
  crumble_motion_point way[] = {{0.8, {0, 0, 0}, {0, 0, 0}}, {1.8, {0, -0.008, 0}, {0, 0, 0}}}; /* of hand and path */
  crumble_mesh cube; crumble_sim sim; crumble_loop loop;
  crumble_tool_def stick; crumble_device_def who; crumble_hand_def hand;
  crumble_loop_status now = {sizeof now}; crumble_hand_status felt = {sizeof felt};
  TRY(crumble_mesh_create_paper(CRUMBLE_PAPER_CUBE, &cube));
  TRY(crumble_sim_create(cube, NULL, &sim));
  TRY(crumble_sim_fix_below(sim, 1e-6));
  TRY(crumble_tool_def_init(&stick, sizeof stick));
  TRY(crumble_sim_add_tool(sim, &stick, NULL));
  TRY(crumble_device_def_init(&who, sizeof who));
  TRY(crumble_device_kind(argc > 1 ? argv[1] : "hand", &who.kind)); /* the word; the rest is what each kind needs */
  who.trajectory = argc > 2 ? argv[2] : NULL, who.callbacks = &own, who.points = way, who.point_count = 2;
  TRY(crumble_hand_def_init(&hand, sizeof hand));
  hand.workspace.position[1] = 0.036; /* the device's origin: 2 mm above the cube */
  TRY(crumble_device_open(&who, &hand.device));
  TRY(crumble_loop_create(sim, NULL, &hand, 1, &loop));
  TRY(crumble_loop_start(loop));
  while (now.ticks < 3000 && felt.fault == CRUMBLE_FAULT_NONE) {
    TRY(crumble_loop_get_status(loop, &now));
    TRY(crumble_loop_get_hand(loop, 0, &felt));
  }
  printf("%.3f N at %.2f mm, %s\n", felt.force[1], 1e3 * felt.tool_pose.position[1], crumble_fault_reason(felt.fault));
  TRY(crumble_loop_destroy(loop)); /* zero has been sent */
  TRY(crumble_device_destroy(hand.device));
  return crumble_sim_destroy(sim) != CRUMBLE_OK || crumble_mesh_destroy(cube) != CRUMBLE_OK;
}
