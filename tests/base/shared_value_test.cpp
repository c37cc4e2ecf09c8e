#include "crumble/base/shared_value.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

struct Many {
  std::uint64_t first = 0;
  std::array<std::uint64_t, 40> copies{};
  std::uint8_t last = 0;
};

TEST(SharedValue, ReadersSeeWholeValuesInOrder) {
  SharedValue<Many> shared;
  std::atomic<bool> stop{false};
  Vector<std::thread> readers;
  std::atomic<std::uint64_t> torn{0}, backwards{0}, reads{0};
  for (int r = 0; r < 3; ++r) {
    readers.emplace_back([&] {
      std::uint64_t before = 0;
      while (!stop) {
        const Many value = shared.load();
        for (const std::uint64_t copy : value.copies) torn += copy != value.first;
        torn += value.last != static_cast<std::uint8_t>(value.first);
        backwards += value.first < before;
        before = value.first;
        ++reads;
      }
    });
  }
  Many value;
  for (std::uint64_t k = 1; k <= 200'000; ++k) {
    value.first = k;
    value.copies.fill(k);
    value.last = static_cast<std::uint8_t>(k);
    shared.store(value);
    if (k % 64 == 0) std::this_thread::yield();
  }
  stop = true;
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(torn, 0u);
  EXPECT_EQ(backwards, 0u);
  EXPECT_EQ(shared.load().first, 200'000u);
}

}  // namespace
}  // namespace crumble
