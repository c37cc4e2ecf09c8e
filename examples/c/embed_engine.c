/* A game engine's way: 50 fixed updates a second, 20 steps of 1 ms in each, then a picture. The tool's pose is
 * interpolated over the steps, the engine's body gets the mean of the forces, a reader draws. The "engine" here is a
 * hand of 0.5 kg that a spring pulls to where the player wants it: into the paper's tofu cube. Prints the same on every
 * machine. */
#include <crumble/crumble.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { UPDATES = 50, STEPS = 20 };
static const double kUpdate = 0.02; /* s: STEPS times the simulation's tau */

static void check(crumble_result result) {
  if (result == CRUMBLE_OK) return;
  fprintf(stderr, "%s\n", crumble_last_error());
  exit(1);
}

/* Between two poses: straight, and by normalised linear blending. An update turns by a few degrees, where this and a
 * slerp are the same to the eye and to the body. */
static crumble_pose between(const crumble_pose *a, const crumble_pose *b, double t) {
  crumble_pose p;
  double dot = 0, length = 0;
  for (int i = 0; i < 3; ++i) p.position[i] = a->position[i] + t * (b->position[i] - a->position[i]);
  for (int i = 0; i < 4; ++i) dot += a->orientation[i] * b->orientation[i];
  for (int i = 0; i < 4; ++i) { /* q and -q are one rotation: take the near one */
    p.orientation[i] = (1 - t) * a->orientation[i] + (dot < 0 ? -t : t) * b->orientation[i];
    length += p.orientation[i] * p.orientation[i];
  }
  for (int i = 0; i < 4; ++i) p.orientation[i] /= sqrt(length);
  return p;
}

/* All steps of one update. The mean is what the engine needs: its force acts over the whole update, so mean x time is
 * the momentum that the steps have given. */
static crumble_wrench update_body(crumble_sim sim, const crumble_pose *from, const crumble_pose *to) {
  crumble_wrench mean = {{0, 0, 0}, {0, 0, 0}}, now;
  for (int step = 1; step <= STEPS; ++step) {
    crumble_pose pose = between(from, to, (double)step / STEPS);
    check(crumble_sim_step(sim, &pose, &now));
    for (int i = 0; i < 3; ++i) mean.force[i] += now.force[i] / STEPS;
    for (int i = 0; i < 3; ++i) mean.torque[i] += now.torque[i] / STEPS;
  }
  return mean;
}

static uint32_t cuts; /* heard so far */

/* What an engine does with a picture: positions, normals, triangles to the graphics card, events to sounds. */
static void draw(crumble_reader reader, int update, double height, double force) {
  crumble_reader_info info = {sizeof info};
  crumble_view points, triangles;
  crumble_event events[256];
  uint32_t count;
  check(crumble_reader_update(reader, &info));
  check(crumble_reader_get_view(reader, CRUMBLE_ARRAY_SURFACE_POSITIONS, &points));
  check(crumble_reader_get_view(reader, CRUMBLE_ARRAY_SURFACE_TRIANGLES, &triangles));
  do {
    check(crumble_reader_read_events(reader, events, 256, &count));
    for (uint32_t i = 0; i < count; ++i) cuts += events[i].kind == CRUMBLE_EVENT_CUT;
  } while (count == 256);
  if (update % 5 != 0) return;
  printf("%.2f s  stick at %6.2f mm  mean force %6.3f N  %4lu vertices  %4lu triangles  %3u cuts\n",
         kUpdate * update, 1e3 * height, force, (unsigned long)points.count, (unsigned long)triangles.count, cuts);
}

int main(void) {
  crumble_mesh cube;
  crumble_sim sim;
  crumble_tool_def stick;
  crumble_reader reader;
  check(crumble_mesh_create_paper(CRUMBLE_PAPER_CUBE, &cube));
  check(crumble_sim_create(cube, NULL, &sim));
  check(crumble_mesh_destroy(cube));
  check(crumble_sim_fix_below(sim, 1e-6));
  check(crumble_tool_def_init(&stick, sizeof stick));
  check(crumble_sim_add_tool(sim, &stick, NULL));
  check(crumble_reader_create(sim, NULL, &reader));

  const double mass = 0.5, pull = 200, damping = 20; /* kg, N/m, N s/m: the engine's own body */
  double speed = 0;
  crumble_pose from = {{0, 0.036, 0}, {1, 0, 0, 0}};
  for (int update = 1; update <= UPDATES; ++update) {
    const double wanted = update <= 30 ? 0.036 - 0.0006 * update : 0.036; /* 18 mm down in 0.6 s, then back */
    crumble_pose to = from;
    to.position[1] += kUpdate * speed; /* where the engine moves it in this update */
    crumble_wrench mean = update_body(sim, &from, &to);
    const double force = pull * (wanted - to.position[1]) - damping * speed + mean.force[1];
    speed += kUpdate * force / mass; /* felt by the engine's body in the next update */
    from = to;
    check(crumble_sim_publish(sim)); /* one thread: hand the state to the reader now */
    draw(reader, update, to.position[1], mean.force[1]);
  }
  check(crumble_reader_destroy(reader));
  check(crumble_sim_destroy(sim));
  return 0;
}
