/* Breaks the paper's tofu cube and watches it as a game would, 60 times a second: what came off, how much energy the
 * cuts released, how large the surface is. Pieces that have come to rest are put to sleep. */
#include <crumble/crumble.h>
#include <stdio.h>
#include <stdlib.h>

static void check(crumble_result result) {
  if (result == CRUMBLE_OK) return;
  fprintf(stderr, "%s\n", crumble_last_error());
  exit(1);
}

static void report_events(crumble_reader reader) {
  crumble_event events[64];
  uint32_t count;
  do {
    check(crumble_reader_read_events(reader, events, 64, &count));
    for (uint32_t i = 0; i < count; ++i) {
      if (events[i].kind != CRUMBLE_EVENT_SPLIT) continue;
      printf("%.3f s: fragment %u came off fragment %u at height %.1f mm\n", events[i].time, events[i].fragment,
             events[i].parent, 1e3 * events[i].place[1]);
    }
  } while (count == 64);
}

static void sleep_debris(crumble_sim sim) {
  crumble_view debris;
  check(crumble_sim_find_debris(sim, 8, 1e-3, &debris));
  for (uint64_t i = 0; i < debris.count; ++i) {
    check(crumble_sim_set_fragment_state(sim, ((const uint32_t*)debris.data)[i], CRUMBLE_FRAGMENT_ASLEEP));
  }
}

int main(void) {
  crumble_mesh cube;
  check(crumble_mesh_create_paper(CRUMBLE_PAPER_CUBE, &cube));
  crumble_sim_def def;
  check(crumble_sim_def_init(&def, sizeof def));
  def.length_limit = 1.1; /* a weaker tofu than the paper's: it falls to pieces sooner */
  crumble_sim sim;
  check(crumble_sim_create(cube, &def, &sim));
  check(crumble_mesh_destroy(cube));
  check(crumble_sim_fix_below(sim, 1e-6));
  crumble_tool_def stick;
  check(crumble_tool_def_init(&stick, sizeof stick));
  check(crumble_sim_add_tool(sim, &stick, NULL));

  crumble_reader reader; /* a program with two threads would use it on the other one, without crumble_sim_publish */
  check(crumble_reader_create(sim, NULL, &reader));
  crumble_reader_info info = {sizeof info};
  crumble_pose pose = {{0, 0.034, 0}, {1, 0, 0, 0}};
  crumble_wrench wrench;
  for (int step = 1; step <= 1200; ++step) {
    pose.position[1] = 0.034 - 2e-5 * step;
    check(crumble_sim_step(sim, &pose, &wrench));
    if (step % 16 != 0) continue;
    sleep_debris(sim);
    check(crumble_sim_publish(sim));
    check(crumble_reader_update(reader, &info));
    report_events(reader);
  }
  printf("%lu springs cut, %u fragments, a surface of %u triangles\n", (unsigned long)info.cuts, info.fragment_count,
         info.triangle_count);
  for (uint32_t f = 0; f < info.fragment_count; ++f) {
    crumble_fragment_info about = {sizeof about};
    check(crumble_reader_get_fragment(reader, f, &about));
    printf("fragment %2u: %3u nodes, %6.3f g%s\n", f, about.node_count, 1e3 * about.mass,
           about.state == CRUMBLE_FRAGMENT_ASLEEP ? ", asleep" : "");
  }
  check(crumble_reader_destroy(reader));
  check(crumble_sim_destroy(sim));
  return 0;
}
