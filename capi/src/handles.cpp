#include "handles.hpp"

#include <bit>
#include <thread>

#include "crumble/base/error.hpp"

namespace crumble::capi {
namespace {

// Chunk that holds slot `index`, and where in it.
struct Place {
  std::uint32_t chunk, offset;
};

constexpr Place place_of(std::uint32_t index, std::uint32_t first_chunk) {
  const auto chunk = static_cast<std::uint32_t>(std::bit_width(index / first_chunk + 1) - 1);
  return {chunk, index - first_chunk * ((1u << chunk) - 1)};
}

std::uintptr_t bits(const void* handle) {
  return reinterpret_cast<std::uintptr_t>(handle);
}

}  // namespace

std::uint32_t HandleTable::index_of(const void* handle) const noexcept {
  return static_cast<std::uint32_t>(bits(handle) & ((std::uintptr_t{1} << layout_.index_bits) - 1));
}

std::uint32_t HandleTable::generation_of(const void* handle) const noexcept {
  return static_cast<std::uint32_t>(bits(handle) >> layout_.index_bits) & last_generation();
}

HandleTable::Slot* HandleTable::find(std::uint32_t index) const noexcept {
  const Place place = place_of(index, kFirstChunk);
  Slot* const chunk = chunks_[place.chunk].load(std::memory_order_acquire);
  return chunk ? chunk + place.offset : nullptr;
}

// `alive`: the slot's state as long as the object lives.
crumble_result HandleTable::find_alive(const void* handle, Slot*& slot, std::uint32_t& alive) const noexcept {
  if (bits(handle) >> (layout_.index_bits + layout_.generation_bits) != kind_) return CRUMBLE_E_BAD_HANDLE;
  slot = find(index_of(handle));
  const std::uint32_t generation = generation_of(handle);
  if (!slot || generation == 0) return CRUMBLE_E_BAD_HANDLE;
  alive = generation * 2 + 1;
  const std::uint32_t state = slot->state.load(std::memory_order_acquire);
  if (state == alive) return CRUMBLE_OK;
  return generation <= state / 2 ? CRUMBLE_E_STALE_HANDLE : CRUMBLE_E_BAD_HANDLE;
}

crumble_result HandleTable::acquire(const void* handle, void*& object) noexcept {
  Slot* slot = nullptr;
  std::uint32_t alive = 0;
  if (const crumble_result result = find_alive(handle, slot, alive); result != CRUMBLE_OK) return result;
  if (slot->busy.exchange(true, std::memory_order_acquire)) return CRUMBLE_E_BUSY;
  if (slot->state.load(std::memory_order_relaxed) != alive) {  // destroyed between the two looks
    slot->busy.store(false, std::memory_order_release);
    return CRUMBLE_E_STALE_HANDLE;
  }
  object = slot->object;
  return CRUMBLE_OK;
}

void HandleTable::release(const void* handle) noexcept {
  find(index_of(handle))->busy.store(false, std::memory_order_release);
}

// Either remove() sees that somebody looks, or the look sees that the object is gone: both in one order of all threads.
crumble_result HandleTable::look(const void* handle, void*& object) noexcept {
  Slot* slot = nullptr;
  std::uint32_t alive = 0;
  if (const crumble_result result = find_alive(handle, slot, alive); result != CRUMBLE_OK) return result;
  slot->lookers.fetch_add(1, std::memory_order_seq_cst);
  if (slot->state.load(std::memory_order_seq_cst) != alive) {
    leave(handle);
    return CRUMBLE_E_STALE_HANDLE;
  }
  object = slot->object;
  return CRUMBLE_OK;
}

void HandleTable::leave(const void* handle) noexcept {
  find(index_of(handle))->lookers.fetch_sub(1, std::memory_order_release);
}

std::uint32_t HandleTable::take_free_index() {
  if (first_free_ != kNone) {
    const std::uint32_t index = first_free_;
    first_free_ = find(index)->next_free;
    return index;
  }
  if (slot_count_ >> layout_.index_bits != 0) throw Error(Code::too_large, "there are too many objects of this kind");
  std::atomic<Slot*>& chunk = chunks_[place_of(slot_count_, kFirstChunk).chunk];
  if (!chunk.load(std::memory_order_relaxed)) {
    chunk.store(new Slot[std::size_t{kFirstChunk} << (&chunk - chunks_.data())], std::memory_order_release);
  }
  return slot_count_++;
}

void* HandleTable::insert(void* object) {
  const std::lock_guard lock(mutex_);
  const std::uint32_t index = take_free_index();
  Slot& slot = *find(index);
  const std::uint32_t generation = slot.state.load(std::memory_order_relaxed) / 2 + 1;
  slot.object = object;
  slot.state.store(generation * 2 + 1, std::memory_order_release);
  return reinterpret_cast<void*>(
      ((std::uintptr_t{kind_} << layout_.generation_bits | generation) << layout_.index_bits) | index);
}

void HandleTable::remove(const void* handle) noexcept {
  const std::uint32_t index = index_of(handle), generation = generation_of(handle);
  Slot& slot = *find(index);
  slot.state.store(generation * 2, std::memory_order_seq_cst);
  while (slot.lookers.load(std::memory_order_seq_cst) != 0) std::this_thread::yield();
  slot.object = nullptr;
  slot.busy.store(false, std::memory_order_release);
  if (generation == last_generation()) return;
  const std::lock_guard lock(mutex_);
  slot.next_free = first_free_;
  first_free_ = index;
}

}  // namespace crumble::capi
