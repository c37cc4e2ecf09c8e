/* A host with threads of its own: one steps the body a thousand times a second, one draws, and a job system shares the
 * steps of a body of 69 000 springs. Then it does the same on one thread. What it prints does not depend on timing. */
#define _POSIX_C_SOURCE 200112L
#include <crumble/crumble.h>
#include <pthread.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <time.h>

enum { STEPS = 400, CELLS = 21, SIDE = CELLS + 1, WORKERS = 2 };

static void check(crumble_result result) {
  if (result == CRUMBLE_OK) return;
  fprintf(stderr, "%s\n", crumble_last_error()); /* of this thread: read it where the call was made */
  exit(1);
}

/* ---- The job system: the host's, for all it does ---------------------------------------------------------------- */

typedef struct pool {
  pthread_mutex_t lock;
  pthread_cond_t work, done;
  void (*task)(void *data, uint32_t index);
  void *data;
  uint32_t count, next, left;
  unsigned long asked, ran; /* tasks */
  int quit;
} pool;

/* Runs one task, with the lock open while it does; 0 when there is none. */
static int run_one(pool *p) {
  if (p->next == p->count) return 0;
  const uint32_t index = p->next++;
  void (*const task)(void *, uint32_t) = p->task;
  void *const data = p->data;
  pthread_mutex_unlock(&p->lock);
  task(data, index);
  pthread_mutex_lock(&p->lock);
  ++p->ran;
  if (--p->left == 0) pthread_cond_signal(&p->done);
  return 1;
}

static void *work(void *context) {
  pool *p = context;
  pthread_mutex_lock(&p->lock);
  while (!p->quit) {
    if (!run_one(p)) pthread_cond_wait(&p->work, &p->lock);
  }
  pthread_mutex_unlock(&p->lock);
  return NULL;
}

/* crumble_parallel_for: called by the thread that steps, which helps, and returns when all is done. */
static void share(void *context, uint32_t count, void (*task)(void *data, uint32_t index), void *data) {
  pool *p = context;
  pthread_mutex_lock(&p->lock);
  p->task = task, p->data = data, p->count = p->left = count, p->next = 0, p->asked += count;
  pthread_cond_broadcast(&p->work);
  while (run_one(p)) {}
  while (p->left > 0) pthread_cond_wait(&p->done, &p->lock);
  pthread_mutex_unlock(&p->lock);
}

/* ---- The body: cubes of six tetrahedra each --------------------------------------------------------------------- */

static crumble_mesh make_block(void) {
  static double positions[SIDE * SIDE * SIDE][3];
  static uint32_t tets[CELLS * CELLS * CELLS * 6][4];
  static const int steps[6][2] = {{0, 1}, {1, 2}, {2, 0}, {1, 0}, {2, 1}, {0, 2}}; /* axes; the last three are odd */
  const int stride[3] = {SIDE * SIDE, SIDE, 1};
  crumble_mesh mesh;
  int node = 0, tet = 0;
  for (int x = 0; x < SIDE; ++x)
    for (int y = 0; y < SIDE; ++y)
      for (int z = 0; z < SIDE; ++z, ++node) {
        const double h = 0.03 / CELLS;
        positions[node][0] = h * x - 0.015, positions[node][1] = h * y, positions[node][2] = h * z - 0.015;
        if (x == CELLS || y == CELLS || z == CELLS) continue;
        for (int i = 0; i < 6; ++i, ++tet) { /* from corner to opposite corner along three edges */
          const int a = node + stride[steps[i][0]], b = a + stride[steps[i][1]];
          const int far = node + stride[0] + stride[1] + stride[2], odd = i >= 3;
          tets[tet][0] = node, tets[tet][1] = odd ? b : a, tets[tet][2] = odd ? a : b, tets[tet][3] = far;
        }
      }
  check(crumble_mesh_create_from_tets(&positions[0][0], node, &tets[0][0], tet, &mesh));
  return mesh;
}

static crumble_sim make_sim(crumble_mesh mesh, pool *jobs) {
  crumble_sim_def def;
  crumble_sim sim;
  crumble_tool_def stick;
  check(crumble_sim_def_init(&def, sizeof def));
  if (jobs) def.host_threads = share, def.host_context = jobs;
  check(crumble_sim_create(mesh, &def, &sim));
  check(crumble_sim_fix_below(sim, 1e-6));
  check(crumble_tool_def_init(&stick, sizeof stick));
  check(crumble_sim_add_tool(sim, &stick, NULL));
  return sim;
}

/* ---- The servo thread: no memory, no lock, no file, no printing; the only wait is for the next tick ------------- */

static void step_once(crumble_sim sim, int step) {
  crumble_pose pose = {{0, 0.034 - 1e-5 * step, 0}, {1, 0, 0, 0}}; /* a device would tell it */
  crumble_wrench wrench;                                           /* a device would get it */
  check(crumble_sim_step(sim, &pose, &wrench));
}

static void *servo(void *sim) {
  struct timespec next;
  clock_gettime(CLOCK_MONOTONIC, &next);
  for (int step = 1; step <= STEPS; ++step) {
    step_once(sim, step);
    next.tv_nsec += 1000000; /* deadlines, not pauses: a late tick does not shift the ones behind it */
    if (next.tv_nsec >= 1000000000) ++next.tv_sec, next.tv_nsec -= 1000000000;
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &next, NULL);
  }
  return NULL;
}

/* Real-time priority and locked memory, where they are allowed; without them it runs all the same. */
static pthread_t start_servo(crumble_sim sim) {
  pthread_t thread;
  struct sched_param param;
  memset(&param, 0, sizeof param);
  param.sched_priority = 80;
  if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0) fputs("memory is not locked\n", stderr);
  if (pthread_create(&thread, NULL, servo, sim) != 0) exit(1);
  if (pthread_setschedparam(thread, SCHED_FIFO, &param) != 0) fputs("no real-time priority\n", stderr);
  return thread;
}

/* ---- The drawing thread: may lock, allocate and wait as it likes ------------------------------------------------ */

typedef struct drawing {
  crumble_reader reader;
  pthread_mutex_t lock;
  int last; /* draw once more and return */
  unsigned long cuts;
  crumble_reader_info info;
} drawing;

static void *draw(void *context) {
  drawing *d = context;
  for (int last = 0; !last;) {
    static crumble_event events[4096];
    const struct timespec pause = {0, 16000000};
    uint32_t count;
    pthread_mutex_lock(&d->lock);
    last = d->last;
    pthread_mutex_unlock(&d->lock);
    check(crumble_reader_update(d->reader, &d->info)); /* then its views go to the graphics card */
    do {
      check(crumble_reader_read_events(d->reader, events, 4096, &count));
      for (uint32_t i = 0; i < count; ++i) d->cuts += events[i].kind == CRUMBLE_EVENT_CUT;
    } while (count == 4096);
    if (!last) nanosleep(&pause, NULL);
  }
  return NULL;
}

int main(void) {
  pool jobs;
  pthread_t workers[WORKERS], drawer, stepper;
  drawing picture;
  memset(&jobs, 0, sizeof jobs), memset(&picture, 0, sizeof picture);
  pthread_mutex_init(&jobs.lock, NULL), pthread_mutex_init(&picture.lock, NULL);
  pthread_cond_init(&jobs.work, NULL), pthread_cond_init(&jobs.done, NULL);
  for (int i = 0; i < WORKERS; ++i)
    if (pthread_create(&workers[i], NULL, work, &jobs) != 0) return 1;

  crumble_mesh mesh = make_block();
  crumble_sim sim = make_sim(mesh, &jobs), alone = make_sim(mesh, NULL);
  crumble_sim_info layout = {sizeof layout};
  check(crumble_sim_get_info(sim, &layout));
  check(crumble_reader_create(sim, NULL, &picture.reader)); /* before the threads run */
  picture.info.struct_size = sizeof picture.info;
  if (pthread_create(&drawer, NULL, draw, &picture) != 0) return 1;
  stepper = start_servo(sim);
  pthread_join(stepper, NULL); /* from here on the simulation is this thread's */

  check(crumble_sim_publish(sim));
  pthread_mutex_lock(&picture.lock);
  picture.last = 1;
  pthread_mutex_unlock(&picture.lock);
  pthread_join(drawer, NULL);
  for (int step = 1; step <= STEPS; ++step) step_once(alone, step);

  crumble_counters counters = {sizeof counters};
  uint64_t hash, hash_alone;
  check(crumble_sim_get_counters(sim, &counters));
  check(crumble_sim_state_hash(sim, &hash));
  check(crumble_sim_state_hash(alone, &hash_alone));
  printf("a body of %u partitions, all tasks of its steps done by the host's threads: %s\n", layout.partitions,
         jobs.asked > 0 && jobs.ran == jobs.asked ? "yes" : "no");
  printf("the last picture shows step %lu of %d\n", (unsigned long)picture.info.step, STEPS);
  printf("%lu cuts, the drawing thread heard of %lu\n", (unsigned long)counters.cuts, picture.cuts);
  printf("the same bits as on one thread: %s\n", hash == hash_alone ? "yes" : "no");

  pthread_mutex_lock(&jobs.lock);
  jobs.quit = 1;
  pthread_cond_broadcast(&jobs.work);
  pthread_mutex_unlock(&jobs.lock);
  for (int i = 0; i < WORKERS; ++i) pthread_join(workers[i], NULL);
  check(crumble_reader_destroy(picture.reader));
  check(crumble_sim_destroy(sim));
  check(crumble_sim_destroy(alone));
  check(crumble_mesh_destroy(mesh));
  return 0;
}
