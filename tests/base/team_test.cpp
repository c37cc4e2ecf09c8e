#include "crumble/base/team.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <ctime>
#include <numeric>
#include <thread>
#include <utility>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

// Tasks write plain numbers: a task done twice, or seen too late by the caller, is a race that ThreadSanitizer names.
struct Counts {
  Vector<std::uint32_t> done;
  static void add(void* data, std::uint32_t index) { ++static_cast<Counts*>(data)->done[index]; }
};

// Returns when all threads of the team are in a task at the same time, so that none is starting or asleep afterwards;
// false if they do not come.
bool gather(Team& team) {
  struct Meeting {
    const std::uint32_t awaited;
    std::atomic<std::uint32_t> arrived{0};
  };
  Meeting meeting{team.threads()};
  Vector<std::uint8_t> met(team.threads());
  std::pair data{&meeting, &met};
  const auto meet = [](void* both, std::uint32_t index) {
    auto& [m, all_met] = *static_cast<std::pair<Meeting*, Vector<std::uint8_t>*>*>(both);
    m->arrived.fetch_add(1);
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (m->arrived.load() < m->awaited && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
    (*all_met)[index] = m->arrived.load() == m->awaited;
  };
  team.run(team.threads(), meet, &data);
  return std::all_of(met.begin(), met.end(), [](std::uint8_t one) { return one == 1; });
}

TEST(Team, DoesEveryIndexOnceInEveryRun) {
  for (const std::uint32_t threads : {1u, 2u, 3u, 8u}) {
    Team team(threads);
    EXPECT_EQ(team.threads(), threads);
    ASSERT_TRUE(gather(team));
    Counts counts{Vector<std::uint32_t>(100)};
    Vector<std::uint32_t> expected(100);
    for (std::uint32_t run = 0; run < 3000; ++run) {
      const std::uint32_t count = run * 7 % 101;
      for (std::uint32_t i = 0; i < count; ++i) ++expected[i];
      team.run(count, Counts::add, &counts);
      ASSERT_EQ(counts.done, expected) << threads << " threads, run " << run;
      // now and then long enough for the workers to fall asleep
      if (run % 300 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
}

TEST(Team, EachPhaseSeesWhatTheOneBeforeWrote) {
  struct Ring {
    Vector<std::uint64_t> from, to;
  };
  constexpr std::uint32_t kParts = 13;
  Ring ring{Vector<std::uint64_t>(kParts), Vector<std::uint64_t>(kParts)};
  std::iota(ring.from.begin(), ring.from.end(), 1);
  Vector<std::uint64_t> expected = ring.from;
  Team team(4);
  ASSERT_TRUE(gather(team));
  for (int phase = 0; phase < 20000; ++phase) {
    const auto mix = [](void* data, std::uint32_t i) {
      auto& [from, to] = *static_cast<Ring*>(data);
      to[i] = 3 * from[i] + from[(i + 1) % kParts];
    };
    team.run(kParts, mix, &ring);
    std::swap(ring.from, ring.to);
    Vector<std::uint64_t> next(kParts);
    for (std::uint32_t i = 0; i < kParts; ++i) next[i] = 3 * expected[i] + expected[(i + 1) % kParts];
    expected = next;
    ASSERT_EQ(ring.from, expected) << phase;
  }
}

TEST(Team, AllThreadsWorkAtTheSameTime) {
  for (const std::uint32_t threads : {2u, 5u, 8u}) {
    Team team(threads);
    for (int run = 0; run < 20; ++run) {
      ASSERT_TRUE(gather(team)) << threads << " threads, run " << run;
      if (run % 5 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));  // all asleep again
    }
  }
}

TEST(Team, TwoCallersAtOnceEachGetAllTheirTasksDone) {
  Team team(3);
  ASSERT_TRUE(gather(team));
  const auto call = [&team](std::uint32_t count, bool& good) {
    Counts counts{Vector<std::uint32_t>(count)};
    for (std::uint32_t run = 1; run <= 50000; ++run) {
      team.run(count, Counts::add, &counts);
      good = good && counts.done == Vector<std::uint32_t>(count, run);
    }
  };
  bool first = true, second = true;
  std::thread other([&] { call(17, first); });
  call(5, second);
  other.join();
  EXPECT_TRUE(first);
  EXPECT_TRUE(second);
}

TEST(Team, TaskMayRunTasksOfItsOwn) {
  struct Nest {
    Team team{2};
    Vector<Counts> inner = Vector<Counts>(6, Counts{Vector<std::uint32_t>(50)});
  };
  Nest nest;
  ASSERT_TRUE(gather(nest.team));
  for (std::uint32_t run = 1; run <= 500; ++run) {
    const auto outer = [](void* data, std::uint32_t i) {
      Nest& n = *static_cast<Nest*>(data);
      n.team.run(50, Counts::add, &n.inner[i]);
    };
    nest.team.run(6, outer, &nest);
    for (const Counts& counts : nest.inner) ASSERT_EQ(counts.done, Vector<std::uint32_t>(50, run));
  }
}

TEST(Team, ComesAndGoesAtAnyMoment) {
  for (int round = 0; round < 200; ++round) {
    Team team(1 + round % 4);
    Counts counts{Vector<std::uint32_t>(9)};
    for (int run = 0; run < round % 3; ++run) team.run(9, Counts::add, &counts);
    EXPECT_EQ(counts.done, Vector<std::uint32_t>(9, round % 3));
  }
}

double processor_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

TEST(Team, UsesNoProcessorWhenIdle) {
  Team team(8);
  Counts counts{Vector<std::uint32_t>(64)};
  team.run(64, Counts::add, &counts);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));  // all have gone to sleep
  const double before = processor_seconds();
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_LT(processor_seconds() - before, 0.03) << "one spinning worker takes 0.3 s on an idle processor";
  team.run(64, Counts::add, &counts);
  EXPECT_EQ(counts.done, Vector<std::uint32_t>(64, 2));
}

TEST(Team, SingleTaskRunsOnTheCaller) {
  Team team(4);
  std::thread::id id;
  for (int run = 0; run < 1000; ++run) {
    team.run(
        1, [](void* data, std::uint32_t) { *static_cast<std::thread::id*>(data) = std::this_thread::get_id(); }, &id);
    ASSERT_EQ(id, std::this_thread::get_id());
  }
}

TEST(Team, HostsThreadsDoTheWork) {
  struct Host {
    int calls = 0;
    static void run(void* context, std::uint32_t count, void (*task)(void*, std::uint32_t), void* data) {
      ++static_cast<Host*>(context)->calls;
      Vector<std::thread> threads;
      for (std::uint32_t i = 0; i < count; ++i) threads.emplace_back(task, data, i);
      for (std::thread& thread : threads) thread.join();
    }
  };
  Host host;
  Team team(ParallelFor{&Host::run, &host});
  EXPECT_GE(team.threads(), 1u);
  Counts counts{Vector<std::uint32_t>(5)};
  for (int run = 0; run < 10; ++run) team.run(5, Counts::add, &counts);
  EXPECT_EQ(counts.done, Vector<std::uint32_t>(5, 10));
  EXPECT_EQ(host.calls, 10);
}

TEST(Team, RefusesBadInput) {
  const auto code_of = [](auto&& make) {
    try {
      make();
    } catch (const Error& error) {
      return error.code();
    }
    return Code{0};
  };
  EXPECT_EQ(code_of([] { Team(0); }), Code::out_of_range);
  EXPECT_EQ(code_of([] { Team(65); }), Code::out_of_range);
  EXPECT_EQ(code_of([] { Team{ParallelFor{}}; }), Code::null);
}

}  // namespace
}  // namespace crumble
