// read and write must not allocate: this program's own operator new counts.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "crumble/device/recorder.hpp"
#include "crumble/device/replay.hpp"
#include "crumble/device/scripted.hpp"
#include "device/samples.hpp"

namespace {
std::atomic<long> allocations = 0;
}

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  ++allocations;
  const auto align = static_cast<std::size_t>(alignment);
  if (void* memory = std::aligned_alloc(align, (size + align - 1) / align * align)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

namespace crumble {
namespace {

long allocations_in_ticks(Device& device, int ticks) {
  DeviceSample sample;
  const long before = allocations;
  for (int k = 0; k < ticks; ++k) {
    static_cast<void>(device.read(sample));
    device.write(sample.pose.position, sample.linear_velocity);
  }
  return allocations - before;
}

TEST(RealTime, TheCounterCounts) {
  const long before = allocations;
  std::vector<double> some(100);
  EXPECT_GT(allocations, before);
}

TEST(RealTime, NoDeviceAllocatesInATick) {
  const Trajectory motion = random_trajectory(41, 500);
  EXPECT_EQ(allocations_in_ticks(*open_null({}, 1e-3), 1000), 0);
  EXPECT_EQ(allocations_in_ticks(*open_press({.depth = 1e-3}, 1e-3), 5000), 0);                     // past its end
  EXPECT_EQ(allocations_in_ticks(*open_replay(motion, {}, 1e-3), 10000), 0);                        // past its end
  EXPECT_EQ(allocations_in_ticks(*open_replay(motion, {.end = EndPolicy::loop}, 1e-3), 20000), 0);  // several laps
  Recorder recorder(open_null({}, 1e-3), 500);
  EXPECT_EQ(allocations_in_ticks(recorder, 1000), 0);  // past its capacity
}

}  // namespace
}  // namespace crumble
