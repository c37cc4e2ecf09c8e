#include "crumble/base/reserved_vector.hpp"

#include <gtest/gtest.h>

#include <cstdint>

#include "crumble/base/memory.hpp"

#if defined(__linux__)
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace crumble {
namespace {

// Whole pages of the vector's memory that the system has not given yet.
[[maybe_unused]] std::size_t missing_pages(const void* data, std::size_t bytes) {
  std::size_t missing = 0;
#if defined(__linux__)
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  const auto begin = reinterpret_cast<std::uintptr_t>(data), first = (begin + page - 1) / page * page;
  for (std::uintptr_t at = first; at + page <= begin + bytes; at += page) {
    unsigned char is_there = 0;
    mincore(reinterpret_cast<void*>(at), page, &is_there);
    missing += (is_there & 1) == 0;
  }
#endif
  return missing;
}

TEST(ReservedVector, HasItsPagesBeforeTheyAreUsed) {
#if !defined(__linux__)
  GTEST_SKIP() << "asks Linux which pages are there";
#endif
  constexpr std::size_t kCount = 1 << 20;
  Vector<double> plain;
  plain.reserve(kCount);
  if (missing_pages(plain.data(), kCount * sizeof(double)) == 0) GTEST_SKIP() << "this malloc gives touched memory";
  ReservedVector<double> reserved;
  reserved.reserve(kCount);
  EXPECT_TRUE(reserved.empty());
  EXPECT_EQ(missing_pages(reserved.data(), kCount * sizeof(double)), 0u);
  reserved.push_back(3);
  const ReservedVector<double> copy = reserved;
  EXPECT_EQ(copy, reserved);
  EXPECT_EQ(copy.capacity(), kCount);
  EXPECT_EQ(missing_pages(copy.data(), kCount * sizeof(double)), 0u);
}

}  // namespace
}  // namespace crumble
