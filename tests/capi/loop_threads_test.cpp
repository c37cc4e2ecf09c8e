// Loops that run by themselves: who may do what meanwhile, and that everybody else is turned away at once.
#include <chrono>
#include <thread>

#include "capi/loop_rig.hpp"
#include "crumble/base/memory.hpp"
#include "support/allocation_counter.hpp"

namespace crumble {
namespace {

using namespace std::chrono_literals;

class RunningLoops : public LoopTest {
 protected:
  void SetUp() override {
    LoopTest::SetUp();
    loop_def.driver = CRUMBLE_DRIVER_OWN_THREAD;
    loop_def.priority = 0;
  }
  /// Until `done()`, at most some seconds.
  template <class Done>
  static bool wait_for(Done&& done) {
    for (int i = 0; i < 5000 && !done(); ++i) std::this_thread::sleep_for(2ms);
    return done();
  }
};

TEST_F(RunningLoops, RunAndStopWithZeroWritten) {
  make_loop(strings.open());
  EXPECT_FALSE(running());
  ASSERT_OK(crumble_loop_start(loop));
  EXPECT_TRUE(running());
  expect_failure(CRUMBLE_E_STATE, crumble_loop_start(loop), {"crumble_loop_start", "runs already"});
  expect_failure(CRUMBLE_E_STATE, crumble_loop_tick(loop), {"CRUMBLE_DRIVER_HOST"});
  std::this_thread::sleep_for(300ms);
  EXPECT_EQ(status().running, 1u);
  ASSERT_OK(crumble_loop_stop(loop));
  EXPECT_FALSE(running());
  EXPECT_RESULT(CRUMBLE_OK, crumble_loop_stop(loop));
  EXPECT_GT(status().ticks, 20u);
  EXPECT_LE(status().steps, status().ticks);
  EXPECT_EQ(strings.last_force, 0);
  const std::uint64_t writes = strings.writes;
  std::this_thread::sleep_for(20ms);
  EXPECT_EQ(strings.writes, writes) << "nobody is there any more";
  crumble_loop_times times{};
  times.struct_size = sizeof times;
  ASSERT_OK(crumble_loop_get_times(loop, &times));
  EXPECT_LE(times.tick_wall.count, status().ticks);
  EXPECT_GT(times.tick_wall.count, 20u);
  EXPECT_GT(times.tick_wall.p50, 0);
  EXPECT_LE(times.tick_wall.p50, times.tick_wall.p99);
  EXPECT_LE(times.tick_wall.p99_9, times.tick_wall.max);
  EXPECT_GT(times.lateness.count, 0u);
  EXPECT_GT(times.tick_cpu.max, 0);
  EXPECT_GT(times.rate, 10);
  EXPECT_EQ(info().step, status().steps);
  const crumble_pose pose = pose_at(0);
  EXPECT_RESULT(CRUMBLE_OK, crumble_sim_step(sim, &pose, &wrench));
}

TEST_F(RunningLoops, KeepEverybodyElseOut) {
  make_loop(strings.open());
  ASSERT_OK(crumble_loop_start(loop));
  const crumble_pose pose = pose_at(0);
  crumble_device_sample sample{};
  sample.struct_size = sizeof sample;
  crumble_reader reader = nullptr;
  expect_failure(CRUMBLE_E_BUSY, crumble_sim_step(sim, &pose, &wrench), {"crumble_sim_step", "a loop that runs"});
  EXPECT_RESULT(CRUMBLE_E_BUSY, crumble_sim_reset(sim));
  EXPECT_RESULT(CRUMBLE_E_BUSY, crumble_sim_fix_below(sim, 0));
  EXPECT_RESULT(CRUMBLE_E_BUSY, crumble_sim_destroy(sim));
  EXPECT_RESULT(CRUMBLE_E_BUSY, crumble_sim_begin_recording(sim));
  EXPECT_RESULT(CRUMBLE_E_BUSY, crumble_reader_create(sim, nullptr, &reader));
  EXPECT_RESULT(CRUMBLE_E_BUSY, crumble_device_read(device, &sample));
  EXPECT_RESULT(CRUMBLE_E_BUSY, crumble_device_destroy(device));
  EXPECT_RESULT(CRUMBLE_E_STATE, crumble_loop_place(loop, 0, &pose));
  crumble_loop second = nullptr;
  EXPECT_RESULT(CRUMBLE_E_BUSY, crumble_loop_create(sim, &loop_def, &hand_def, 1, &second));
  ASSERT_OK(crumble_loop_stop(loop));
  ASSERT_OK(crumble_device_read(device, &sample));
  ASSERT_OK(crumble_loop_create(sim, &loop_def, &hand_def, 1, &second));
  ASSERT_OK(crumble_loop_start(second));
  expect_failure(CRUMBLE_E_BUSY, crumble_loop_start(loop), {"crumble_loop_start", "sim"});
  ASSERT_OK(crumble_loop_destroy(second));  // while it runs
  ASSERT_OK(crumble_loop_start(loop));
  ASSERT_OK(crumble_loop_stop(loop));
}

TEST_F(RunningLoops, AnswerManyThreadsAtOnce) {
  make_loop(strings.open());
  ASSERT_OK(crumble_loop_start(loop));
  std::atomic<bool> stop = false;
  Vector<std::thread> threads;
  for (int t = 0; t < 3; ++t) {
    threads.emplace_back([&, t] {
      std::uint64_t before = 0;
      while (!stop) {
        const std::uint64_t now = status().ticks;
        ASSERT_GE(now, before);
        before = now;
        ASSERT_LE(hand().fault, std::uint32_t{CRUMBLE_FAULT_HALTED});
        EXPECT_RESULT(CRUMBLE_OK, t == 0 ? crumble_loop_halt(loop) : crumble_loop_reset_fault(loop, 0));
      }
    });
  }
  std::this_thread::sleep_for(100ms);
  for (int i = 0; i < 5; ++i) {  // nor are start and stop in anybody's way
    ASSERT_OK(crumble_loop_stop(loop));
    ASSERT_OK(crumble_loop_start(loop));
  }
  stop = true;
  for (std::thread& thread : threads) thread.join();
  ASSERT_OK(crumble_loop_stop(loop));
}

TEST_F(RunningLoops, MayBeDestroyedWhileOthersLook) {
  for (int i = 0; i < 50; ++i) {
    make_loop(strings.open());
    const crumble_loop mine = loop;
    std::atomic<bool> looking = false;
    std::thread thread([&] {
      crumble_loop_status out{};
      out.struct_size = sizeof out;
      crumble_result result = CRUMBLE_OK;
      while (result == CRUMBLE_OK) {
        result = crumble_loop_get_status(mine, &out);
        looking = true;
      }
      EXPECT_RESULT(CRUMBLE_E_STALE_HANDLE, result);
    });
    while (!looking) std::this_thread::yield();
    ASSERT_OK(crumble_loop_destroy(loop));
    loop = nullptr;
    thread.join();
    ASSERT_OK(crumble_device_destroy(device));
    device = nullptr;
  }
}

TEST_F(RunningLoops, HaltFromAnotherThreadTakesTheForceAway) {
  hand_def.ramp_time = 0.01, hand_def.good_samples = 5;
  make_loop(strings.open());
  ASSERT_OK(crumble_loop_start(loop));
  ASSERT_TRUE(wait_for([&] {
    const crumble_hand_status now = hand();
    if (now.state == CRUMBLE_HAND_RUNNING) strings.height = std::max(-0.003, strings.height - 5e-5);
    if (now.state == CRUMBLE_HAND_FAULTED) {  // a machine that is busy elsewhere stalls the loop
      crumble_loop_reset_fault(loop, 0);
      strings.height = 0.002;
    }
    return strings.last_force > 0.05;
  }));
  ASSERT_OK(crumble_loop_halt(loop));
  ASSERT_TRUE(wait_for([&] { return hand().state == CRUMBLE_HAND_FAULTED; }));
  EXPECT_EQ(strings.last_force, 0);
  EXPECT_EQ(hand().fault, std::uint32_t{CRUMBLE_FAULT_HALTED});
  ASSERT_OK(crumble_loop_stop(loop));
}

TEST_F(RunningLoops, ReadersGoOn) {
  crumble_reader reader = nullptr, closed = nullptr, late = nullptr;
  ASSERT_OK(crumble_reader_create(sim, nullptr, &reader));
  ASSERT_OK(crumble_reader_create(sim, nullptr, &closed));
  make_loop(strings.open());
  crumble_reader_info seen{};
  seen.struct_size = sizeof seen;
  const auto sees = [&](crumble_reader who, std::uint64_t step) {
    return wait_for([&] { return crumble_reader_update(who, &seen) == CRUMBLE_OK && seen.step > step; });
  };
  ASSERT_OK(crumble_loop_start(loop));
  ASSERT_OK(crumble_reader_destroy(closed));  // it never was in anybody's way
  EXPECT_TRUE(sees(reader, 50)) << seen.step;
  ASSERT_OK(crumble_loop_stop(loop));
  const std::uint64_t before = info().step;
  ASSERT_OK(crumble_reader_create(sim, nullptr, &late));  // between two runs
  ASSERT_OK(crumble_loop_start(loop));
  EXPECT_TRUE(sees(late, before)) << seen.step;
  EXPECT_TRUE(sees(reader, before)) << seen.step;
  ASSERT_OK(crumble_loop_stop(loop));
  EXPECT_RESULT(CRUMBLE_OK, crumble_reader_destroy(reader));
  EXPECT_RESULT(CRUMBLE_OK, crumble_reader_destroy(late));
}

TEST_F(RunningLoops, ABodyInAThreadOfItsOwnPublishesToo) {
  loop_def.coupling = CRUMBLE_COUPLING_LOCAL_MODEL;
  loop_def.body_thread = 1;
  crumble_reader reader = nullptr;
  ASSERT_OK(crumble_reader_create(sim, nullptr, &reader));
  make_loop(strings.open());
  ASSERT_OK(crumble_loop_start(loop));
  crumble_reader_info seen{};
  seen.struct_size = sizeof seen;
  EXPECT_TRUE(wait_for([&] { return crumble_reader_update(reader, &seen) == CRUMBLE_OK && seen.step > 20; }));
  ASSERT_OK(crumble_loop_stop(loop));
  EXPECT_RESULT(CRUMBLE_OK, crumble_reader_destroy(reader));
}

// A device with a thread of its own, as a driver has.
struct Driver : Strings {
  crumble_device_callbacks callbacks() {
    crumble_device_callbacks table = Strings::callbacks();
    table.user = this;
    table.flags = CRUMBLE_DEVICE_SERVO_DRIVEN;
    table.start = [](crumble_device_tick tick, void* context, void* user) -> crumble_result {
      auto* const self = static_cast<Driver*>(user);
      if (self->start_answer != CRUMBLE_OK) return self->start_answer;
      self->thread = std::thread([=] {
        while (!self->stopping && tick(context)) std::this_thread::sleep_for(500us);
      });
      return CRUMBLE_OK;
    };
    table.stop = [](void* user) -> crumble_result {
      auto* const self = static_cast<Driver*>(user);
      self->stopping = true;
      self->thread.join();
      self->stopping = false;
      return CRUMBLE_OK;
    };
    return table;
  }
  std::thread thread;
  std::atomic<bool> stopping = false;
  crumble_result start_answer = CRUMBLE_OK;
};

TEST_F(RunningLoops, ADeviceMayDrive) {
  loop_def.driver = CRUMBLE_DRIVER_DEVICE;
  Driver driver;
  make_loop(Strings::open(driver.callbacks()));
  for (int run = 0; run < 2; ++run) {
    const std::uint64_t before = status().ticks;
    ASSERT_OK(crumble_loop_start(loop));
    EXPECT_TRUE(wait_for([&] { return status().ticks > before + 20; }));
    ASSERT_OK(crumble_loop_stop(loop));
    EXPECT_EQ(driver.last_force, 0);
  }
  driver.start_answer = -77;
  expect_failure(CRUMBLE_E_DEVICE_LOST, crumble_loop_start(loop), {"crumble_loop_start", "`start`", "-77"});
  EXPECT_FALSE(running());
  crumble_device_info about{};
  about.struct_size = sizeof about;
  ASSERT_OK(crumble_device_get_info(device, &about)) << "given back";
  EXPECT_EQ(about.callback_error, -77);
  EXPECT_EQ(about.flags, std::uint32_t{CRUMBLE_DEVICE_SERVO_DRIVEN});
  close();
}

// Read and written by the host, then by a loop that the device drives, and again by the host.
TEST_F(RunningLoops, ADeviceWithAThreadServesOneAtATime) {
  Driver driver;
  driver.height = 0.004;
  device = Strings::open(driver.callbacks());
  crumble_device_sample sample{};
  sample.struct_size = sizeof sample;
  bool any = false;
  const auto has_sample = [&] {
    EXPECT_RESULT(CRUMBLE_OK, crumble_device_read(device, &sample));
    return any = any || sample.status == CRUMBLE_READ_OK;
  };
  EXPECT_TRUE(wait_for(has_sample));
  EXPECT_EQ(sample.pose.position[1], 0.004);
  EXPECT_TRUE(driver.thread.joinable()) << "its thread was started";
  const double force[3] = {0, 0.5, 0};
  ASSERT_OK(crumble_device_write(device, force, nullptr));

  loop_def.driver = CRUMBLE_DRIVER_AUTOMATIC;
  make_loop(device);
  EXPECT_FALSE(driver.thread.joinable()) << "and stopped for the loop";
  EXPECT_EQ(driver.last_force, 0);
  expect_failure(CRUMBLE_E_IN_USE, crumble_device_read(device, &sample), {"a loop has the device"});
  ASSERT_OK(crumble_loop_start(loop));
  EXPECT_TRUE(wait_for([&] { return status().ticks > 20; }));
  ASSERT_OK(crumble_loop_destroy(loop));
  loop = nullptr;
  any = false;
  EXPECT_TRUE(wait_for(has_sample));
  close();
}

TEST_F(RunningLoops, ACallbackMayAskButNotStop) {
  struct Asker : Strings {
    crumble_loop loop = nullptr;
    std::atomic<bool> armed = false;
    std::atomic<crumble_result> stop = CRUMBLE_OK, destroy = CRUMBLE_OK, ask = CRUMBLE_E_INTERNAL;
  } asker;
  crumble_device_callbacks table = asker.callbacks();
  table.user = &asker;
  table.read = [](crumble_device_sample*, void* user) -> crumble_result {
    auto* const self = static_cast<Asker*>(user);
    crumble_loop_status out{};
    out.struct_size = sizeof out;
    self->ask = crumble_loop_get_status(self->loop, &out);
    ++self->reads;
    if (!self->armed.exchange(false)) return CRUMBLE_OK;
    self->stop = crumble_loop_stop(self->loop);
    self->destroy = crumble_loop_destroy(self->loop);
    return CRUMBLE_OK;
  };
  make_loop(Strings::open(table));
  asker.loop = loop;
  ASSERT_OK(crumble_loop_start(loop));
  asker.armed = true;
  const std::uint64_t before = asker.reads;
  EXPECT_TRUE(wait_for([&] { return asker.reads > before + 3; }));
  ASSERT_OK(crumble_loop_stop(loop));
  EXPECT_RESULT(CRUMBLE_E_STATE, asker.stop);
  EXPECT_RESULT(CRUMBLE_E_STATE, asker.destroy);
  EXPECT_RESULT(CRUMBLE_OK, asker.ask);
  close();
}

TEST_F(RunningLoops, ATickByTheHostTakesNoMemory) {
  loop_def.driver = CRUMBLE_DRIVER_HOST;
  crumble_reader reader = nullptr;
  ASSERT_OK(crumble_reader_create(sim, nullptr, &reader));
  make_loop(strings.open());
  tick(2);
  if (!AllocationCounter::available()) GTEST_SKIP() << "a sanitizer counts for itself";
  const AllocationCounter counter;
  for (int i = 0; i < 300; ++i) crumble_loop_tick(loop);
  EXPECT_EQ(counter.count(), 0u);
  EXPECT_EQ(status().ticks, 302u);
  EXPECT_RESULT(CRUMBLE_OK, crumble_reader_destroy(reader));
}

}  // namespace
}  // namespace crumble
