/* feel_tofu hand|press|replay [FILE.ctraj]: the haptic loop round the paper's tofu cube. One word chooses who moves the
 * stick: a simulated hand, which feels the force, a scripted press, or a recorded motion. Prints the force over time. */
#include <crumble/crumble.h>
#include <stdio.h>
#include <stdlib.h>

static void check(crumble_result result) {
  if (result == CRUMBLE_OK) return;
  fprintf(stderr, "%s\n", crumble_last_error());
  exit(1);
}

int main(int argc, char **argv) {
  crumble_mesh cube;
  crumble_sim sim;
  crumble_tool_def stick;
  check(crumble_mesh_create_paper(CRUMBLE_PAPER_CUBE, &cube));
  check(crumble_sim_create(cube, NULL, &sim));
  check(crumble_mesh_destroy(cube));
  check(crumble_sim_fix_below(sim, 1e-6));
  check(crumble_tool_def_init(&stick, sizeof stick));
  check(crumble_sim_add_tool(sim, &stick, NULL));

  crumble_device_def who; /* what the chosen kind does not need is not looked at */
  check(crumble_device_def_init(&who, sizeof who));
  check(crumble_device_kind(argc > 1 ? argv[1] : "hand", &who.kind));
  const crumble_motion_point way[] = {{0.8, {0, 0, 0}, {0, 0, 0}}, {1.8, {0, -0.008, 0}, {0, 0, 0}}};
  who.start.position[1] = 0.003; /* 3 mm above the first touch */
  who.points = way;
  who.point_count = 2;
  who.press_speed = 0.005;
  who.trajectory = argc > 2 ? argv[2] : NULL;
  crumble_hand_def hand;
  check(crumble_hand_def_init(&hand, sizeof hand));
  hand.workspace.position[1] = 0.034; /* the device's origin: the stick touches the top face */
  check(crumble_device_open(&who, &hand.device));

  crumble_loop_def def;
  crumble_loop loop;
  check(crumble_loop_def_init(&def, sizeof def));
  def.driver = CRUMBLE_DRIVER_HOST; /* CRUMBLE_DRIVER_OWN_THREAD, and crumble_loop_start instead of the ticks */
  check(crumble_loop_create(sim, &def, &hand, 1, &loop));
  crumble_hand_status felt = {sizeof felt};
  for (int tick = 1; tick <= 2000; ++tick) {
    check(crumble_loop_tick(loop));
    if (tick % 200 != 0) continue;
    check(crumble_loop_get_hand(loop, 0, &felt));
    printf("%.1f s  stick at %5.2f mm  force %6.3f N  %s\n", 1e-3 * tick, 1e3 * felt.tool_pose.position[1],
           felt.force[1], crumble_fault_name(felt.fault));
  }
  check(crumble_loop_destroy(loop)); /* sends zero */
  check(crumble_device_destroy(hand.device));
  check(crumble_sim_destroy(sim));
  return 0;
}
