// feel_tofu_chai3d [SECONDS]: the paper's tofu cube under the first device that CHAI3D finds. A haptics thread as in
// CHAI3D's examples ticks the loop; the main thread, where a program would draw, looks at it. Compiled against a double
// of CHAI3D's classes, and not tested with CHAI3D.
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "crumble_chai3d.hpp"

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

static crumble_loop loop;
static std::atomic<bool> running{true}, finished{false};

static void check(crumble_result result) {
  if (result == CRUMBLE_OK) return;
  std::fprintf(stderr, "%s\n", crumble_last_error());
  std::exit(1);
}

// A tick is a millisecond of the body's time, so it has to come once a millisecond: CHAI3D's own loops run as often as
// the device lets them. A tick that was missed is missed, since catching up in a burst would shake the hand.
static void run_haptics() {
  Clock::time_point next = Clock::now();
  while (running) {
    std::this_thread::sleep_until(next);
    crumble_loop_tick(loop);
    next += milliseconds(1);
    if (next < Clock::now()) next = Clock::now();
  }
  finished = true;
}

static crumble_sim make_tofu() {
  crumble_mesh cube;
  crumble_sim sim;
  crumble_tool_def stick;
  check(crumble_mesh_create_paper(CRUMBLE_PAPER_CUBE, &cube));
  check(crumble_sim_create(cube, nullptr, &sim));
  check(crumble_mesh_destroy(cube));
  check(crumble_sim_fix_below(sim, 1e-6));
  check(crumble_tool_def_init(&stick, sizeof stick));
  check(crumble_sim_add_tool(sim, &stick, nullptr));
  return sim;
}

int main(int argc, char** argv) {
  chai3d::cHapticDeviceHandler handler;
  chai3d::cGenericHapticDevicePtr device;
  if (!handler.getDevice(device, 0) || !device->open() || !device->calibrate()) {
    std::fprintf(stderr, "no haptic device\n");
    return 1;
  }

  crumble_sim sim = make_tofu();
  crumble_chai3d::Bridge bridge(device);
  crumble_hand_def hand;
  check(crumble_hand_def_init(&hand, sizeof hand));
  hand.workspace.position[1] = 0.04;  // the middle of the device's workspace lies 6 mm above the first touch
  check(bridge.open(&hand.device));
  crumble_loop_def def;
  check(crumble_loop_def_init(&def, sizeof def));
  def.driver = CRUMBLE_DRIVER_HOST;
  check(crumble_loop_create(sim, &def, &hand, 1, &loop));
  check(crumble_loop_start(loop));  // begins the watchdog; the thread is ours

  chai3d::cThread thread;
  thread.start(run_haptics, chai3d::CTHREAD_PRIORITY_HAPTICS);
  crumble_hand_status felt = {};
  felt.struct_size = sizeof felt;
  const int pictures = (argc > 1 ? std::atoi(argv[1]) : 10) * 10;
  for (int picture = 1; picture <= pictures; ++picture) {
    std::this_thread::sleep_for(milliseconds(100));
    check(crumble_loop_get_hand(loop, 0, &felt));
    std::printf("stick at %6.2f mm  force %6.3f N  %s\n", 1e3 * felt.tool_pose.position[1], felt.force[1],
                crumble_fault_name(felt.fault));
  }
  running = false;
  while (!finished) std::this_thread::sleep_for(milliseconds(1));

  check(crumble_loop_destroy(loop));  // sends zero
  check(crumble_device_destroy(hand.device));
  check(crumble_sim_destroy(sim));
  device->close();
  return 0;
}
