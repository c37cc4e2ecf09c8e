#include "crumble/base/latest_value.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <string>
#include <thread>

namespace crumble {
namespace {

enum Operation { kPublish, kFetch, kRequest, kOperations };

// What the two threads agree on, without places: the newest value, whether the reader has it, and its wish.
struct Model {
  int newest = 0, front = 0;
  bool fresh = false, wanted = false;
};

void apply(Operation operation, int value, LatestValue<int>& latest, Model& model) {
  if (operation == kPublish) {
    latest.back() = value;
    latest.publish();
    model.newest = value, model.fresh = true, model.wanted = false;
  } else if (operation == kFetch) {
    ASSERT_EQ(latest.fetch(), model.fresh);
    model.front = model.newest, model.fresh = false;
  } else {
    latest.request();
    model.wanted = true;
  }
}

// Every order in which two threads can do nine operations, whole ones.
TEST(LatestValue, DoesWhatTheModelDoesInEveryOrder) {
  constexpr int kLength = 9, kOrders = 19683;  // kOperations to the power of kLength
  for (int order = 0; order < kOrders; ++order) {
    LatestValue<int> latest(0);
    Model model;
    std::string story;
    for (int i = 1, rest = order; i <= kLength; ++i, rest /= kOperations) {
      const auto operation = static_cast<Operation>(rest % kOperations);
      story += "PFR"[operation];
      ASSERT_NO_FATAL_FAILURE(apply(operation, i, latest, model)) << story;
      ASSERT_EQ(latest.front(), model.front) << story;
      ASSERT_EQ(latest.wanted(), model.wanted) << story;
      ASSERT_NE(&latest.front(), &latest.back()) << story;
    }
  }
}

TEST(LatestValue, BeginsWithTheGivenValueAsFetched) {
  LatestValue<std::string> latest("first");
  EXPECT_FALSE(latest.fetch());
  EXPECT_EQ(latest.front(), "first");
  EXPECT_EQ(latest.back(), "first");
  EXPECT_FALSE(latest.wanted());
}

// A value is torn when its numbers differ; ThreadSanitizer sees the same as a race.
using Wide = std::array<std::uint64_t, 200>;

TEST(LatestValue, TwoThreadsNeverSeeATornOrAnOlderValue) {
  constexpr std::uint64_t kValues = 100000, kFetched = 100;  // at least, however the threads are scheduled
  LatestValue<Wide> latest(Wide{});
  std::atomic<std::uint64_t> fetched{0};
  std::atomic<bool> done{false};
  std::thread writer([&] {
    for (std::uint64_t value = 1; value <= kValues || fetched < kFetched; ++value) {
      latest.back().fill(value);
      latest.publish();
    }
    done = true;
  });
  std::uint64_t last = 0, torn = 0, older = 0;
  while (true) {
    const bool was_done = done;
    if (!latest.fetch()) {
      if (was_done) break;
      std::this_thread::yield();
      continue;
    }
    const Wide& value = latest.front();
    torn += std::count(value.begin(), value.end(), value[0]) != static_cast<std::ptrdiff_t>(value.size());
    older += value[0] <= last;
    last = value[0];
    ++fetched;
  }
  writer.join();
  EXPECT_EQ(torn, 0u);
  EXPECT_EQ(older, 0u);
}

// A writer that publishes only when asked, a reader that asks once for each value: a wish that got lost would end it.
TEST(LatestValue, NoWishGetsLost) {
  constexpr std::uint64_t kValues = 20000;
  LatestValue<std::uint64_t> latest(0);
  std::thread writer([&] {
    for (std::uint64_t value = 1; value <= kValues;) {
      if (!latest.wanted()) {
        std::this_thread::yield();
        continue;
      }
      latest.back() = value++;
      latest.publish();
    }
  });
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  std::uint64_t last = 0;
  while (last < kValues && std::chrono::steady_clock::now() < deadline) {
    latest.request();
    while (!latest.fetch() && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
    EXPECT_EQ(latest.front(), last + 1);
    last = latest.front();
  }
  EXPECT_EQ(last, kValues);
  while (latest.front() < kValues) latest.request(), latest.fetch();  // a test that has failed still ends
  writer.join();
}

}  // namespace
}  // namespace crumble
