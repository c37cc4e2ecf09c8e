/* Presses a round stick of 8 mm diameter 15 mm into the paper's tofu cube, at 10 mm/s, and prints the force. */
#include <crumble/crumble.h>
#include <stdio.h>
#include <stdlib.h>

static void check(crumble_result result) {
  if (result == CRUMBLE_OK) return;
  fprintf(stderr, "%s\n", crumble_last_error());
  exit(1);
}

int main(void) {
  crumble_mesh cube;
  check(crumble_mesh_create_paper(CRUMBLE_PAPER_CUBE, &cube));
  crumble_sim sim;
  check(crumble_sim_create(cube, NULL, &sim)); /* tofu, 1 ms steps */
  check(crumble_mesh_destroy(cube));
  check(crumble_sim_fix_below(sim, 1e-6)); /* the bottom sticks to the table */

  crumble_tool_def stick;
  check(crumble_tool_def_init(&stick, sizeof stick)); /* the 8 mm stick */
  check(crumble_sim_add_tool(sim, &stick, NULL));

  crumble_pose pose = {{0, 0.034, 0}, {1, 0, 0, 0}}; /* lying across the top face */
  crumble_wrench wrench;
  for (int step = 1; step <= 1500; ++step) {
    pose.position[1] = 0.034 - 1e-5 * step;
    check(crumble_sim_step(sim, &pose, &wrench));
    if (step % 100 == 0) printf("depth %4.1f mm  force %6.3f N\n", 0.01 * step, wrench.force[1]);
  }
  crumble_counters counters = {sizeof counters};
  check(crumble_sim_get_counters(sim, &counters));
  printf("%lu springs cut\n", (unsigned long)counters.cuts);
  check(crumble_sim_destroy(sim));
  return 0;
}
