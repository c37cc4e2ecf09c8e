/* Presses the default stick 15 mm into the paper's tofu cube and prints the last force, the number of cut springs and the
 * hash of the state. The bindings have the same program in their languages, and every one prints the same. */
#include <crumble/crumble.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

static void check(crumble_result result) {
  if (result == CRUMBLE_OK) return;
  fprintf(stderr, "%s\n", crumble_last_error());
  exit(1);
}

int main(void) {
  crumble_mesh cube;
  crumble_sim sim;
  crumble_tool_def stick;
  check(crumble_mesh_create_paper(CRUMBLE_PAPER_CUBE, &cube));
  check(crumble_sim_create(cube, NULL, &sim));
  check(crumble_sim_fix_below(sim, 1e-6));
  check(crumble_tool_def_init(&stick, sizeof stick));
  check(crumble_sim_add_tool(sim, &stick, NULL));

  crumble_pose pose = {{0, 0, 0}, {1, 0, 0, 0}};
  crumble_wrench wrench;
  for (int step = 1; step <= 1500; ++step) {
    pose.position[1] = 0.034 - 1e-5 * step;
    check(crumble_sim_step(sim, &pose, &wrench));
  }
  crumble_counters counters = {sizeof counters};
  uint64_t hash;
  check(crumble_sim_get_counters(sim, &counters));
  check(crumble_sim_state_hash(sim, &hash));
  printf("force %.12f N\ncuts %" PRIu64 "\nhash %016" PRIx64 "\n", wrench.force[1], counters.cuts, hash);
  check(crumble_sim_destroy(sim));
  check(crumble_mesh_destroy(cube));
  return 0;
}
