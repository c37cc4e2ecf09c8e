// Callbacks, their order and their end; on the test's own thread, and on the double's.
#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "rig.hpp"

namespace fakehd_test {
namespace {

TEST_F(FakeHd, HigherPriorityComesFirst) {
  std::vector<int> order;
  Work low = [&] { return order.push_back(1), 1u; };
  Work middle = [&] { return order.push_back(2), 0u; };
  Work high = [&] { return order.push_back(3), 1u; };
  hd().schedule(call_work, &low, 0);
  hd().schedule(call_work, &high, 65535);
  hd().schedule(call_work, &middle, 32767);
  hd().start();
  FAKEHD(fakehd_run_ticks)(2);
  EXPECT_EQ(order, (std::vector{3, 2, 1, 3, 1}));
  EXPECT_EQ(FAKEHD(fakehd_scheduled)(), 2u);
}

TEST_F(FakeHd, EqualPrioritiesHaveNoOrder) {
  std::vector<int> order;
  Work a = [&] { return order.push_back(1), 1u; };
  Work b = [&] { return order.push_back(2), 1u; };
  hd().schedule(call_work, &a, 5);
  hd().schedule(call_work, &b, 5);
  hd().start();
  FAKEHD(fakehd_run_ticks)(2);
  EXPECT_NE(order, (std::vector{1, 2, 1, 2}));
  EXPECT_EQ(order.size(), 4u);
}

TEST_F(FakeHd, NoTickBeforeTheStartAndAfterTheStop) {
  int calls = 0;
  Work work = [&] { return ++calls, 1u; };
  hd().schedule(call_work, &work, 5);
  EXPECT_EQ(FAKEHD(fakehd_run_ticks)(3), 0);
  hd().start();
  EXPECT_EQ(FAKEHD(fakehd_run_ticks)(3), 3);
  hd().stop();
  EXPECT_EQ(FAKEHD(fakehd_run_ticks)(3), 0);
  EXPECT_EQ(calls, 3);
}

TEST_F(FakeHd, HandleIsLongAndGoneOnce) {
  Work work = [] { return 1u; };
  const unsigned long handle = hd().schedule(call_work, &work, 5);
  EXPECT_GT(handle, 0xFFFFFFFFul);
  EXPECT_EQ(hd().wait(handle, 0), 1);
  hd().unschedule(handle);
  EXPECT_EQ(next_error(), 0u);
  EXPECT_EQ(hd().wait(handle, 0), 0);
  hd().unschedule(handle);
  EXPECT_EQ(next_error(), 0x102u);
}

TEST_F(FakeHd, ScheduledInTheServoRunsAtOnceAndAgain) {
  int calls = 0;
  Work inner = [&] { return ++calls, 1u; };
  hd().start();
  tick([&] {
    hd().schedule(call_work, &inner, 5);
    EXPECT_EQ(calls, 1);
  });
  EXPECT_EQ(calls, 1);
  FAKEHD(fakehd_run_ticks)(1);
  EXPECT_EQ(calls, 2);
}

TEST_F(FakeHd, SynchronousEndsWhenItIsDone) {
  int calls = 0;
  Work work = [&] { return ++calls < 5 ? 1u : 0u; };
  hd().start();
  hd().schedule_and_wait(call_work, &work, 5);
  EXPECT_EQ(calls, 5);
  const unsigned long handle = hd().schedule(call_work, &(work = [&] { return ++calls < 9 ? 1u : 0u; }), 5);
  EXPECT_EQ(hd().wait(handle, 1), 0);
  EXPECT_EQ(calls, 9);
}

TEST_F(FakeHd, SynchronousWithoutASchedulerIsRefused) {
  misuse_expected = true;
  Work work = [] { return 0u; };
  hd().schedule_and_wait(call_work, &work, 5);
  EXPECT_EQ(next_error(), 0x102u);
}

TEST_F(FakeHd, ServoMayNotWaitForItself) {
  misuse_expected = true;
  hd().start();
  tick([] {
    hd().stop();
    EXPECT_EQ(next_error(), 0x102u);
    hd().wait(1, 1);
    EXPECT_EQ(next_error(), 0x102u);
    EXPECT_EQ(FAKEHD(fakehd_run_ticks)(1), 0);
    EXPECT_EQ(FAKEHD(fakehd_reset)(nullptr), -1);
  });
  EXPECT_EQ(FAKEHD(fakehd_scheduler_running)(), 1);
}

TEST_F(FakeHd, SchedulerFillsUp) {
  reset(R"({"scheduler_slots": 2})");
  Work work = [] { return 1u; };
  for (int i = 0; i < 2; ++i) EXPECT_NE(hd().schedule(call_work, &work, 5), 0xFFFFFFFFu);
  EXPECT_EQ(hd().schedule(call_work, &work, 5), 0xFFFFFFFFu);
  EXPECT_EQ(next_error(), 0x501u);
}

TEST_F(FakeHd, OnlySomeRates) {
  for (const unsigned long rate : {500ul, 2000ul, 1000ul}) {
    hd().set_rate(rate);
    EXPECT_EQ(FAKEHD(fakehd_rate)(), rate);
  }
  const std::pair<const char*, unsigned> quirks[] = {{"value", 0x101}, {"timer", 0x304}, {"operation", 0x102}};
  for (const auto& [quirk, code] : quirks) {
    reset((R"({"rate_quirk": ")" + std::string(quirk) + "\"}").c_str());
    hd().set_rate(1234);
    EXPECT_EQ(next_error(), code);
    EXPECT_EQ(FAKEHD(fakehd_rate)(), 1000u);
  }
}

TEST_F(FakeHd, OneThreadServesAllCallbacks) {
  reset("{}");
  std::vector<std::thread::id> ids;
  std::vector<int> order;
  Work low = [&] { return ids.push_back(std::this_thread::get_id()), order.push_back(1), order.size() < 20 ? 1u : 0u; };
  Work high = [&] { return ids.push_back(std::this_thread::get_id()), order.push_back(2), 1u; };
  const unsigned long handle = hd().schedule(call_work, &low, 1);
  hd().schedule(call_work, &high, 2);
  hd().start();
  EXPECT_EQ(hd().wait(handle, 1), 0);
  hd().stop();
  EXPECT_EQ(FAKEHD(fakehd_scheduler_running)(), 0);
  const std::size_t after = order.size();
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_EQ(order[i], i % 2 == 0 ? 2 : 1);
    EXPECT_EQ(ids[i], ids[0]);
    EXPECT_NE(ids[i], std::this_thread::get_id());
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_EQ(order.size(), after) << "the thread has been joined";
  EXPECT_GE(FAKEHD(fakehd_ticks)(), 10u);
}

TEST_F(FakeHd, StopWaitsForTheCallbackThatRuns) {
  for (const bool manual : {false, true}) {
    reset(manual ? R"({"manual": true})" : "{}");
    std::atomic<bool> entered = false, left = false;
    Work work = [&] {
      entered = true;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      left = true;
      return 1u;
    };
    hd().schedule(call_work, &work, 5);
    hd().start();
    std::thread ticks([manual] {
      if (manual) FAKEHD(fakehd_run_ticks)(1);
    });
    while (!entered) std::this_thread::yield();
    hd().stop();
    EXPECT_TRUE(left);
    ticks.join();
  }
}

TEST_F(FakeHd, SynchronousBlocksUntilTheThreadHasDoneIt) {
  reset("{}");
  int calls = 0;
  Work work = [&] { return ++calls < 3 ? 1u : 0u; };
  hd().start();
  hd().schedule_and_wait(call_work, &work, 5);
  EXPECT_EQ(calls, 3);
  hd().start();  // again: there is only one
  EXPECT_EQ(FAKEHD(fakehd_scheduler_starts)(), 1u);
  hd().stop();
}

TEST_F(FakeHd, StalledThreadIsFoundWhileItStalls) {
  reset(R"({"stall_limit_s": 0.02, "devices": [{"calibration": "none", "ramp_s": 0}]})");
  const unsigned device = started();
  std::atomic<bool> go_on = false;
  Work work = [&] {
    while (!go_on) std::this_thread::yield();
    return 0u;
  };
  const unsigned long handle = hd().schedule(call_work, &work, 5);
  while (FAKEHD(fakehd_errors_pending)() == 0) std::this_thread::yield();
  EXPECT_EQ(applied(device), (Vec{0, 0, 0}));
  go_on = true;
  hd().wait(handle, 1);
  hd().stop();
  EXPECT_EQ(next_error(), 0x300u);
}

TEST_F(FakeHd, ResetStopsTheThread) {
  reset("{}");
  std::atomic<int> calls = 0;
  Work work = [&] { return ++calls, 1u; };
  hd().init(nullptr);
  hd().schedule(call_work, &work, 5);
  hd().start();
  while (calls < 3) std::this_thread::yield();
  reset("{}");
  EXPECT_EQ(FAKEHD(fakehd_ticks)(), 0u);
  EXPECT_EQ(FAKEHD(fakehd_open_devices)(), 0u);
  EXPECT_EQ(FAKEHD(fakehd_scheduled)(), 0u);
}

}  // namespace
}  // namespace fakehd_test
