/* What one call of crumble_sim_step costs: the smallest body, one tetrahedron, with a stick far away, and all that can be
 * switched off. Prints the least mean of many rounds. The bindings have the same program. */
#include <crumble/crumble.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { ROUNDS = 200, STEPS = 5000 };

static void check(crumble_result result) {
  if (result == CRUMBLE_OK) return;
  fprintf(stderr, "%s\n", crumble_last_error());
  exit(1);
}

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

int main(void) {
  static const double positions[] = {0, 0, 0, 0.01, 0, 0, 0, 0, 0.01, 0, 0.01, 0};
  static const uint32_t tetrahedra[] = {0, 2, 1, 3};
  crumble_mesh mesh;
  crumble_sim sim;
  crumble_sim_def def;
  crumble_tool_def stick;
  check(crumble_mesh_create_from_tets(positions, 4, tetrahedra, 1, &mesh));
  check(crumble_sim_def_init(&def, sizeof def));
  def.floor = def.surface_samples = def.ball_contact = 0;
  def.gravity[1] = 0; /* or it would fall out of the world */
  check(crumble_sim_create(mesh, &def, &sim));
  check(crumble_tool_def_init(&stick, sizeof stick));
  check(crumble_sim_add_tool(sim, &stick, NULL));

  crumble_pose pose = {{0, 1, 0}, {1, 0, 0, 0}};
  crumble_wrench wrench;
  double least = 1e300;
  for (int round = 0; round < ROUNDS; ++round) {
    const double start = now();
    for (int step = 0; step < STEPS; ++step) check(crumble_sim_step(sim, &pose, &wrench));
    const double each = (now() - start) / STEPS;
    if (each < least) least = each;
  }
  printf("%.0f ns a step\n", least);
  check(crumble_sim_destroy(sim));
  check(crumble_mesh_destroy(mesh));
  return 0;
}
