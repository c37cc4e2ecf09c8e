// The table behind the handles of the C API.
//
// A handle is a number in a pointer's clothes: kind, generation and index of a slot. Nobody follows it. Looking one up
// compares it with what the slot says about itself, so a destroyed object, a handle of another kind or garbage is told
// apart from a living object without touching memory that is not the table's own. Slots are never given back, a slot's
// generation grows with every object that lives in it, and a slot whose generations are used up is left alone.
//
// A look-up takes the object for one thread: one load, one exchange, one load; no lock, no wait. What any thread may
// ask while another is at work in the object looks at it instead: such looks are counted, and who destroys the object
// first lets the last of them end. Only making and destroying objects goes through a mutex.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>

#include "crumble/crumble.h"

namespace crumble::capi {

/// How the bits of a handle are shared out, from the lowest: index, generation, kind.
struct HandleLayout {
  unsigned index_bits, generation_bits, kind_bits;
};
inline constexpr HandleLayout kHandleLayout = sizeof(void*) >= 8 ? HandleLayout{24, 24, 16} : HandleLayout{12, 14, 6};

/// All objects of one kind. Lives as long as the process: use it with static storage only.
class HandleTable {
 public:
  /// `kind` is at least 1: so no handle is NULL and, on 64-bit hosts, none equals a user-space address.
  constexpr explicit HandleTable(std::uint32_t kind, HandleLayout layout = kHandleLayout)
      : kind_(kind), layout_(layout) {}

  /// A handle for `object`. Throws Error(too_large) when the table is full, std::bad_alloc.
  void* insert(void* object);
  /// Takes the object for the calling thread. On CRUMBLE_OK the caller must release() it; else
  /// CRUMBLE_E_BAD_HANDLE, _STALE_HANDLE or _BUSY.
  crumble_result acquire(const void* handle, void*& object) noexcept;
  void release(const void* handle) noexcept;
  /// Keeps the object alive for a moment, whoever has taken it. On CRUMBLE_OK the caller must leave() it, soon; else
  /// CRUMBLE_E_BAD_HANDLE or _STALE_HANDLE.
  crumble_result look(const void* handle, void*& object) noexcept;
  void leave(const void* handle) noexcept;
  /// Makes an acquired handle stale, waits for those who look, and gives its slot free; the object is the caller's
  /// again.
  void remove(const void* handle) noexcept;

 private:
  struct Slot {
    std::atomic<std::uint32_t> state{0};  // last generation given out, doubled; + 1 while its object lives
    std::atomic<bool> busy{false};
    std::atomic<std::uint32_t> lookers{0};
    std::uint32_t next_free = 0;
    void* object = nullptr;
  };
  static constexpr std::uint32_t kNone = 0xffffffffu;
  static constexpr std::uint32_t kFirstChunk = 64;  // slots; each further chunk has twice as many as the one before

  Slot* find(std::uint32_t index) const noexcept;
  crumble_result find_alive(const void* handle, Slot*& slot, std::uint32_t& alive) const noexcept;
  std::uint32_t index_of(const void* handle) const noexcept;
  std::uint32_t generation_of(const void* handle) const noexcept;
  std::uint32_t take_free_index();
  std::uint32_t last_generation() const noexcept { return (1u << layout_.generation_bits) - 1; }

  std::uint32_t kind_;
  HandleLayout layout_;
  std::array<std::atomic<Slot*>, 19> chunks_{};  // 64 (2^19 - 1) slots: more than 24 bits can name

  std::mutex mutex_;  // of what follows
  std::uint32_t slot_count_ = 0;
  std::uint32_t first_free_ = kNone;
};

}  // namespace crumble::capi
