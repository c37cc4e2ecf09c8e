/* Pinches the paper's tofu cube between a stick and a ball, each 6 mm deep, and prints what pushes each of them back. */
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
  check(crumble_sim_create(cube, NULL, &sim));
  check(crumble_mesh_destroy(cube));
  check(crumble_sim_fix_below(sim, 1e-6));

  crumble_tool_def tool;
  check(crumble_tool_def_init(&tool, sizeof tool)); /* the 8 mm stick: tool 0 */
  check(crumble_sim_add_tool(sim, &tool, NULL));
  tool.shape = CRUMBLE_TOOL_BALL; /* tool 1 */
  tool.radius = 0.008;
  check(crumble_sim_add_tool(sim, &tool, NULL));

  crumble_pose poses[2] = {{{-0.019, 0.015, 0}, {1, 0, 0, 0}}, {{0.023, 0.015, 0}, {1, 0, 0, 0}}};
  crumble_wrench wrenches[2];
  for (int step = 1; step <= 600; ++step) {
    poses[0].position[0] = -0.019 + 1e-5 * step; /* from the left */
    poses[1].position[0] = 0.023 - 1e-5 * step;  /* from the right */
    check(crumble_sim_step_tools(sim, poses, wrenches, 2));
    if (step % 100) continue;
    printf("depth %.0f mm  stick %6.3f N  ball %6.3f N\n", 0.01 * step, wrenches[0].force[0], wrenches[1].force[0]);
  }
  check(crumble_sim_destroy(sim));
  return 0;
}
