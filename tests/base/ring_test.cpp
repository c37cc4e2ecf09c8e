#include "crumble/base/ring.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <deque>
#include <string>
#include <thread>

namespace crumble {
namespace {

// Every order in which two threads can do nine operations, whole ones: a push, or a pop of up to one, two or three.
TEST(Ring, DoesWhatAQueueDoesInEveryOrder) {
  constexpr int kLength = 9, kOrders = 1 << 2 * kLength;
  for (const std::size_t capacity : {1u, 2u, 3u}) {
    for (int order = 0; order < kOrders; ++order) {
      Ring<int> ring(capacity);
      std::deque<int> queue;
      std::uint64_t dropped = 0;
      for (int i = 0; i < kLength; ++i) {
        const auto room = static_cast<std::size_t>(order >> 2 * i & 3);
        if (room == 0) {
          ring.push(i);
          if (queue.size() < capacity)
            queue.push_back(i);
          else
            ++dropped;
          continue;
        }
        std::array<int, 3> out{};
        const std::size_t count = ring.pop({out.data(), room});
        ASSERT_EQ(count, std::min(room, queue.size())) << order << ", operation " << i;
        for (std::size_t k = 0; k < count; ++k, queue.pop_front()) ASSERT_EQ(out[k], queue.front()) << order;
      }
      ASSERT_EQ(ring.dropped(), dropped) << order;
    }
  }
}

TEST(Ring, RefusesToHoldNothing) {
  EXPECT_THROW(Ring<int>(0), Error);
  EXPECT_EQ(Ring<int>(5).capacity(), 5u);
}

// A torn item has numbers that differ; ThreadSanitizer sees the same as a race.
struct Item {
  std::array<std::uint64_t, 12> numbers;
};

TEST(Ring, TwoThreadsLoseNothingButWhatIsCounted) {
  constexpr std::uint64_t kItems = 200000, kTaken = 1000;  // at least, however the threads are scheduled
  Ring<Item> ring(64);
  std::atomic<std::uint64_t> taken{0};
  std::uint64_t pushed = 0;
  std::atomic<bool> done{false};
  std::thread producer([&] {
    Item item;
    while (pushed < kItems || taken < kTaken) {
      item.numbers.fill(++pushed);
      ring.push(item);
      if (pushed % 50 == 0) std::this_thread::yield();
    }
    done.store(true);
  });
  std::uint64_t last = 0, torn = 0, misplaced = 0;
  std::array<Item, 10> out;
  while (true) {
    const bool was_done = done.load();
    const std::size_t count = ring.pop(out);
    if (count == 0 && was_done) break;
    if (count == 0) std::this_thread::yield();
    for (std::size_t k = 0; k < count; ++k) {
      for (const std::uint64_t number : out[k].numbers) torn += number != out[k].numbers[0];
      misplaced += out[k].numbers[0] <= last;
      last = out[k].numbers[0];
    }
    taken += count;
  }
  producer.join();
  EXPECT_EQ(torn, 0u);
  EXPECT_EQ(misplaced, 0u);
  EXPECT_EQ(taken + ring.dropped(), pushed);
}

}  // namespace
}  // namespace crumble
