#include "crumble/base/memory.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <random>
#include <vector>

#include "crumble/base/error.hpp"
#include "crumble/base/memory_block.hpp"

namespace crumble {
namespace {

// Counts, and refuses from the n-th on.
struct Host {
  std::size_t takes = 0, alive = 0, refuse_from = static_cast<std::size_t>(-1);
  std::map<void*, std::pair<std::size_t, std::size_t>> given;

  MemorySource source() {
    return {[](std::size_t bytes, std::size_t alignment, void* self) -> void* {
              auto& host = *static_cast<Host*>(self);
              if (++host.takes >= host.refuse_from) return nullptr;
              void* const memory = ::operator new (bytes, std::align_val_t{alignment});
              host.given[memory] = {bytes, alignment};
              return memory;
            },
            [](void* memory, std::size_t bytes, std::size_t alignment, void* self) {
              auto& host = *static_cast<Host*>(self);
              EXPECT_EQ(host.given.at(memory), std::pair(bytes, alignment)) << "as it was taken";
              host.given.erase(memory);
              ::operator delete (memory, std::align_val_t{alignment});
            },
            this};
  }
};

struct alignas(64) Line {
  double values[8];
};
struct Object : Allocated {
  virtual ~Object() = default;
  int number = 0;
};
struct Derived : Object {
  Line line{};
};

class MemorySourceTest : public testing::Test {
 protected:
  void SetUp() override { set_memory_source(host.source()); }
  void TearDown() override { set_memory_source({}); }
  Host host;
};

TEST_F(MemorySourceTest, VectorsAndObjectsComeFromTheHost) {
  {
    Vector<double> numbers(100);
    Vector<Line> lines(3);
    const std::unique_ptr<Object> object = std::make_unique<Derived>();  // deleted through its base
    const std::shared_ptr<const Line> shared = share_new<const Line>();
    EXPECT_EQ(host.given.size(), 4u);
    for (const auto& [memory, row] : host.given) {
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(memory) % row.second, 0u);
    }
    EXPECT_EQ(memory_use().blocks, 4u);
    EXPECT_GE(memory_use().bytes, 800 + 3 * sizeof(Line) + sizeof(Derived) + sizeof(Line));
  }
  EXPECT_TRUE(host.given.empty());
  EXPECT_EQ(memory_use().blocks, 0u);
  EXPECT_EQ(memory_use().bytes, 0u);
  EXPECT_GT(memory_use().most_bytes, 800u);
}

template <std::size_t Alignment>
struct alignas(Alignment) Throws : Allocated {
  Throws() { throw 1; }
};

TEST_F(MemorySourceTest, AConstructorThatThrowsLeavesNothing) {
  EXPECT_THROW(std::make_unique<Throws<8>>(), int);
  EXPECT_THROW(std::make_unique<Throws<64>>(), int);
  EXPECT_THROW(share_new<Throws<64>>(), int);
  EXPECT_EQ(host.takes, 3u);
  EXPECT_TRUE(host.given.empty());
}

TEST_F(MemorySourceTest, WhatTheHostRefusesIsBadAlloc) {
  host.refuse_from = 2;
  const Vector<int> first(10);
  EXPECT_THROW(Vector<int>(10), std::bad_alloc);
  EXPECT_EQ(memory_use().blocks, 1u);
}

TEST_F(MemorySourceTest, CannotChangeWhileAnythingIsTaken) {
  const Vector<int> first(10);
  try {
    set_memory_source({});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Code::in_use);
  }
  const Vector<int> second(10);
  EXPECT_EQ(host.given.size(), 2u) << "the source is still the host's";
}

TEST(MemoryAllocator, TooManyItemsAreRefusedBeforeTheSizeOverflows) {
  Allocator<Line> allocator;
  EXPECT_THROW((void)allocator.allocate(static_cast<std::size_t>(-1) / 32), std::bad_array_new_length);
}

TEST(MemoryBlock, TooSmall) {
  alignas(16) std::byte memory[64];
  EXPECT_THROW(MemoryBlock(memory, sizeof memory), Error);
}

// Against a book of what is out: stretches are apart, aligned, within the block, and keep what is written in them.
TEST(MemoryBlock, RandomTakesAndGivesKeepTheirBooks) {
  constexpr std::size_t kSize = 1 << 16;
  std::vector<std::byte> room(kSize + 8);
  std::byte* const begin = room.data() + 3;  // aligned to nothing
  MemoryBlock block(begin, kSize);
  const std::size_t at_first = block.longest_free();
  EXPECT_GT(at_first, kSize - 64);
  struct Taken {
    std::size_t bytes;
    std::byte mark;
  };
  std::map<std::byte*, Taken> taken;
  std::mt19937 random(7);
  std::size_t refused = 0;
  for (int i = 0; i < 20000; ++i) {
    if (random() % 3 != 0) {
      const std::size_t bytes = 1 + random() % (random() % 8 == 0 ? 6000 : 200),
                        alignment = std::size_t{1} << random() % 8;
      auto* const memory = static_cast<std::byte*>(block.take(bytes, alignment));
      if (!memory) {
        ++refused;
        EXPECT_LT(block.longest_free(), bytes + 2 * alignment + 16) << "there was room";
        continue;
      }
      ASSERT_EQ(reinterpret_cast<std::uintptr_t>(memory) % alignment, 0u);
      ASSERT_TRUE(memory >= begin && memory + bytes <= begin + kSize);
      const auto after = taken.lower_bound(memory);
      ASSERT_TRUE(after == taken.end() || memory + bytes <= after->first);
      ASSERT_TRUE(after == taken.begin() || std::prev(after)->first + std::prev(after)->second.bytes <= memory);
      const auto mark = static_cast<std::byte>(random());
      std::memset(memory, static_cast<int>(mark), bytes);
      taken[memory] = {bytes, mark};
    } else if (!taken.empty()) {
      auto it = taken.begin();
      std::advance(it, random() % taken.size());
      for (std::size_t b = 0; b < it->second.bytes; ++b) ASSERT_EQ(it->first[b], it->second.mark);
      block.give_back(it->first);
      taken.erase(it);
    }
  }
  EXPECT_GT(refused, 100u);
  for (const auto& [memory, row] : taken) block.give_back(memory);
  EXPECT_EQ(block.longest_free(), at_first) << "all has joined again";
}

}  // namespace
}  // namespace crumble
