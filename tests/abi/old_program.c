/* A program of the day when the C API was finished: compiled against the header of that day (first/crumble/crumble.h,
 * never to be edited) and linked with today's library. It uses every group of functions, keeps a canary behind every
 * struct that the library fills, and says "old program: all is well" if the library still serves it. */
#include <crumble/crumble.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void fail(const char *what, int line) {
  fprintf(stderr, "line %d: %s: %s\n", line, what, crumble_last_error());
  exit(1);
}
#define CHECK(call) ((call) == CRUMBLE_OK ? (void)0 : fail(#call, __LINE__))
#define EXPECT(truth) ((truth) ? (void)0 : fail(#truth, __LINE__))

/* `type name` with a canary behind it, struct_size set */
static const char kCanary[16] = "untouched here!";
#define GUARDED(type, name)    \
  struct {                     \
    type value;                \
    char canary[sizeof kCanary]; \
  } name;                      \
  memset(&name, 0, sizeof name); \
  memcpy(name.canary, kCanary, sizeof kCanary)
#define FILLED(name) EXPECT(memcmp(name.canary, kCanary, sizeof kCanary) == 0)

static crumble_sim make_tofu(void) {
  crumble_mesh cube;
  CHECK(crumble_mesh_create_paper(CRUMBLE_PAPER_CUBE, &cube));
  GUARDED(crumble_mesh_info, mesh);
  mesh.value.struct_size = sizeof mesh.value;
  CHECK(crumble_mesh_get_info(cube, &mesh.value));
  FILLED(mesh);
  EXPECT(mesh.value.node_count == 600);

  GUARDED(crumble_sim_def, def);
  CHECK(crumble_sim_def_init(&def.value, sizeof def.value));
  FILLED(def);
  EXPECT(def.value.struct_size == sizeof def.value && def.value.stiffness == 30 && def.value.tau == 0.001);
  def.value.stiffness = 35;
  crumble_sim sim;
  CHECK(crumble_sim_create(cube, &def.value, &sim));
  CHECK(crumble_mesh_destroy(cube));
  EXPECT(crumble_mesh_get_info(cube, &mesh.value) == CRUMBLE_E_STALE_HANDLE);

  CHECK(crumble_sim_fix_below(sim, 1e-6));
  GUARDED(crumble_tool_def, stick);
  CHECK(crumble_tool_def_init(&stick.value, sizeof stick.value));
  FILLED(stick);
  CHECK(crumble_sim_add_tool(sim, &stick.value, NULL));
  GUARDED(crumble_wall_def, wall);
  CHECK(crumble_wall_def_init(&wall.value, sizeof wall.value));
  FILLED(wall);
  wall.value.offset = -0.001;
  CHECK(crumble_sim_add_wall(sim, &wall.value));
  memset(&def.value, 0, sizeof def.value);
  def.value.struct_size = sizeof def.value;
  CHECK(crumble_sim_get_def(sim, &def.value));
  FILLED(def);
  EXPECT(def.value.stiffness == 35 && def.value.floor == 1);
  return sim;
}

static uint64_t press(crumble_sim sim, int from, int to, double *most) {
  crumble_pose pose = {{0, 0, 0}, {1, 0, 0, 0}};
  for (int step = from; step <= to; ++step) {
    GUARDED(crumble_wrench, wrench);
    pose.position[1] = 0.034 - 1e-5 * step;
    CHECK(crumble_sim_step(sim, &pose, &wrench.value));
    FILLED(wrench);
    *most = fmax(*most, wrench.value.force[1]);
  }
  uint64_t hash;
  CHECK(crumble_sim_state_hash(sim, &hash));
  return hash;
}

static void look_at(crumble_sim sim) {
  GUARDED(crumble_step_info, step);
  GUARDED(crumble_counters, counters);
  GUARDED(crumble_profile, profile);
  GUARDED(crumble_sim_info, info);
  GUARDED(crumble_surface_info, surface);
  GUARDED(crumble_view, view);
  step.value.struct_size = sizeof step.value;
  counters.value.struct_size = sizeof counters.value;
  profile.value.struct_size = sizeof profile.value;
  info.value.struct_size = sizeof info.value;
  surface.value.struct_size = sizeof surface.value;
  CHECK(crumble_sim_get_step_info(sim, &step.value));
  CHECK(crumble_sim_get_counters(sim, &counters.value));
  CHECK(crumble_sim_get_profile(sim, &profile.value));
  CHECK(crumble_sim_get_info(sim, &info.value));
  CHECK(crumble_sim_extract_surface(sim, &surface.value));
  CHECK(crumble_sim_get_view(sim, CRUMBLE_ARRAY_POSITIONS_Y, &view.value));
  FILLED(step), FILLED(counters), FILLED(profile), FILLED(info), FILLED(surface), FILLED(view);
  EXPECT(step.value.status == CRUMBLE_OK && step.value.contacts > 0 && counters.value.cuts > 0);
  EXPECT(surface.value.triangle_count > surface.value.skin_triangle_count);
  EXPECT(view.value.count == 600 && view.value.scalar_type == CRUMBLE_SCALAR_FLOAT64);

  uint32_t contacts = 0;
  CHECK(crumble_sim_get_contacts(sim, NULL, 0, &contacts));
  EXPECT(contacts >= step.value.contacts);
  static struct {
    crumble_local_model value;
    char canary[sizeof kCanary];
  } model;
  memcpy(model.canary, kCanary, sizeof kCanary);
  CHECK(crumble_sim_get_local_model(sim, 0, &model.value));
  FILLED(model);
  GUARDED(crumble_wrench, there);
  CHECK(crumble_local_model_evaluate(&model.value, &model.value.at, &there.value));
  FILLED(there);
  EXPECT(there.value.force[1] > 0);
}

static void save_and_restore(crumble_sim sim) {
  uint64_t bytes = 0, before, after;
  double most = 0;
  CHECK(crumble_sim_snapshot(sim, NULL, 0, &bytes));
  void *const snapshot = malloc((size_t)bytes);
  CHECK(crumble_sim_snapshot(sim, snapshot, bytes, &bytes));
  before = press(sim, 801, 850, &most);
  CHECK(crumble_sim_restore(sim, snapshot, bytes));
  after = press(sim, 801, 850, &most);
  EXPECT(before == after);
  free(snapshot);
}

static void read_along(crumble_sim sim) {
  GUARDED(crumble_reader_def, def);
  CHECK(crumble_reader_def_init(&def.value, sizeof def.value));
  FILLED(def);
  crumble_reader reader;
  CHECK(crumble_reader_create(sim, &def.value, &reader));
  double most = 0;
  press(sim, 851, 900, &most);
  CHECK(crumble_sim_publish(sim));
  GUARDED(crumble_reader_info, info);
  info.value.struct_size = sizeof info.value;
  CHECK(crumble_reader_update(reader, &info.value));
  FILLED(info);
  GUARDED(crumble_fragment_info, fragment);
  fragment.value.struct_size = sizeof fragment.value;
  CHECK(crumble_reader_get_fragment(reader, 0, &fragment.value));
  FILLED(fragment);
  EXPECT(fragment.value.node_count > 0 && info.value.triangle_count > 0);
  crumble_event events[64];
  uint32_t count = 0;
  CHECK(crumble_reader_read_events(reader, events, 64, &count));
  EXPECT(count > 0 && events[0].kind >= CRUMBLE_EVENT_CUT && events[0].kind <= CRUMBLE_EVENT_CONTACT_END);
  CHECK(crumble_reader_destroy(reader));
}

static crumble_result still(crumble_device_sample *sample, void *user) {
  sample->pose.position[1] = *(double *)user;
  return CRUMBLE_OK;
}

static crumble_result feel(const double *force, const double *torque, void *user) {
  (void)torque, (void)user;
  return isfinite(force[0]) ? CRUMBLE_OK : CRUMBLE_E_INVALID_VALUE;
}

static void run_a_loop(crumble_sim sim) {
  double height = 0.05;
  GUARDED(crumble_device_callbacks, mine);
  GUARDED(crumble_device_def, which);
  GUARDED(crumble_loop_def, def);
  GUARDED(crumble_hand_def, hand);
  CHECK(crumble_device_callbacks_init(&mine.value, sizeof mine.value));
  CHECK(crumble_device_def_init(&which.value, sizeof which.value));
  CHECK(crumble_loop_def_init(&def.value, sizeof def.value));
  CHECK(crumble_hand_def_init(&hand.value, sizeof hand.value));
  FILLED(mine), FILLED(which), FILLED(def), FILLED(hand);
  mine.value.read = still, mine.value.write = feel, mine.value.user = &height;
  which.value.kind = CRUMBLE_DEVICE_CUSTOM, which.value.callbacks = &mine.value;
  CHECK(crumble_device_open(&which.value, &hand.value.device));
  GUARDED(crumble_device_info, device);
  device.value.struct_size = sizeof device.value;
  CHECK(crumble_device_get_info(hand.value.device, &device.value));
  FILLED(device);
  EXPECT(device.value.kind == CRUMBLE_DEVICE_CUSTOM);

  crumble_loop loop;
  def.value.driver = CRUMBLE_DRIVER_HOST;
  CHECK(crumble_loop_create(sim, &def.value, &hand.value, 1, &loop));
  for (int tick = 0; tick < 300; ++tick) CHECK(crumble_loop_tick(loop));
  GUARDED(crumble_loop_status, status);
  GUARDED(crumble_hand_status, felt);
  GUARDED(crumble_loop_times, times);
  status.value.struct_size = sizeof status.value;
  felt.value.struct_size = sizeof felt.value;
  times.value.struct_size = sizeof times.value;
  CHECK(crumble_loop_get_status(loop, &status.value));
  CHECK(crumble_loop_get_hand(loop, 0, &felt.value));
  CHECK(crumble_loop_get_times(loop, &times.value));
  FILLED(status), FILLED(felt), FILLED(times);
  EXPECT(status.value.ticks == 300 && felt.value.fault == CRUMBLE_FAULT_NONE && felt.value.device_pose.position[1] == height);
  EXPECT(crumble_sim_destroy(sim) == CRUMBLE_E_IN_USE);
  CHECK(crumble_loop_destroy(loop));
  CHECK(crumble_device_destroy(hand.value.device));
}

int main(void) {
  CHECK(crumble_check_version(CRUMBLE_VERSION_NUMBER));
  crumble_sim sim = make_tofu();
  double most = 0;
  const uint64_t first = press(sim, 1, 800, &most);
  EXPECT(most > 0.5 && most < 5);
  look_at(sim);
  save_and_restore(sim);
  read_along(sim);
  CHECK(crumble_sim_reset(sim));
  EXPECT(press(sim, 1, 800, &most) == first);
  run_a_loop(sim);
  CHECK(crumble_sim_destroy(sim));
  EXPECT(crumble_sim_destroy(sim) == CRUMBLE_E_STALE_HANDLE);
  EXPECT(crumble_sim_step(NULL, NULL, NULL) == CRUMBLE_E_NULL);
  puts("old program: all is well");
  return 0;
}
