#include "crumble/base/memory_block.hpp"

#include <algorithm>
#include <cstdint>
#include <string>

#include "crumble/base/error.hpp"

namespace crumble {
namespace {

std::byte* up(std::byte* at, std::size_t alignment) {
  const auto address = reinterpret_cast<std::uintptr_t>(at);
  return at + ((alignment - address % alignment) % alignment);
}

std::size_t up(std::size_t bytes, std::size_t grain) {
  return (bytes + grain - 1) / grain * grain;
}

}  // namespace

void MemoryBlock::check_size(std::uint64_t bytes) {
  if (bytes < kLeast) {
    throw Error(Code::out_of_range,
                "bytes must be at least " + std::to_string(kLeast) + ", is " + std::to_string(bytes));
  }
  if (bytes > static_cast<std::size_t>(-1)) throw Error(Code::too_large, "bytes do not fit into an address");
}

MemoryBlock::MemoryBlock(void* memory, std::size_t bytes) {
  check_size(bytes);
  auto* const given = static_cast<std::byte*>(memory);
  std::byte* const begin = up(given, kGrain);
  const auto usable = static_cast<std::size_t>(given + bytes - begin) / kGrain * kGrain;
  first_ = new (begin) Stretch{usable, nullptr};
}

void* MemoryBlock::take(std::size_t bytes, std::size_t alignment) noexcept {
  const std::lock_guard lock(mutex_);
  alignment = std::max(alignment, kGrain);
  for (Stretch** link = &first_; *link; link = &(*link)->next) {
    auto* const begin = reinterpret_cast<std::byte*>(*link);
    std::byte* const place = up(begin + sizeof(Head), alignment);
    std::byte* const stretch_end = begin + (*link)->bytes;
    if (place > stretch_end || bytes > static_cast<std::size_t>(stretch_end - place)) continue;
    return take_from(link, place, place + up(bytes, kGrain));
  }
  return nullptr;
}

// What lies before `place` goes with it; what lies behind `end` stays free.
void* MemoryBlock::take_from(Stretch** link, std::byte* place, std::byte* end) noexcept {
  Stretch* const stretch = *link;
  auto* const begin = reinterpret_cast<std::byte*>(stretch);
  const auto rest = static_cast<std::size_t>(begin + stretch->bytes - end);
  *link = rest > 0 ? new (end) Stretch{rest, stretch->next} : stretch->next;
  new (place - sizeof(Head)) Head{begin, static_cast<std::size_t>(end - begin)};
  return place;
}

void MemoryBlock::give_back(void* memory) noexcept {
  const std::lock_guard lock(mutex_);
  const Head head = *reinterpret_cast<Head*>(static_cast<std::byte*>(memory) - sizeof(Head));
  Stretch* before = nullptr;
  Stretch* after = first_;
  while (after && reinterpret_cast<std::byte*>(after) < head.begin) before = after, after = after->next;
  auto* stretch = new (head.begin) Stretch{head.bytes, after};
  const auto joins = [](const Stretch* a, const Stretch* b) {
    return b && reinterpret_cast<const std::byte*>(a) + a->bytes == reinterpret_cast<const std::byte*>(b);
  };
  if (joins(stretch, after)) *stretch = {stretch->bytes + after->bytes, after->next};
  if (!before) {
    first_ = stretch;
  } else if (joins(before, stretch)) {
    *before = {before->bytes + stretch->bytes, stretch->next};
  } else {
    before->next = stretch;
  }
}

std::size_t MemoryBlock::longest_free() const noexcept {
  const std::lock_guard lock(mutex_);
  std::size_t longest = 0;
  for (const Stretch* s = first_; s; s = s->next) longest = std::max(longest, s->bytes - sizeof(Head));
  return longest;
}

MemorySource MemoryBlock::source() noexcept {
  return {
      [](std::size_t bytes, std::size_t alignment, void* block) {
        return static_cast<MemoryBlock*>(block)->take(bytes, alignment);
      },
      [](void* memory, std::size_t, std::size_t, void* block) { static_cast<MemoryBlock*>(block)->give_back(memory); },
      this};
}

}  // namespace crumble
