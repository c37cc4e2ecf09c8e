// The newest value, from one thread to another, without either ever waiting.
//
// Three values stand in three places. The writer owns one (back), the reader another (front), and the third lies
// between them. To publish, the writer swaps its place with the one between; to fetch, the reader does the same:
//
//    writer                  between                  reader
//   [ back ]  <-- publish -> [ value, new? ] <- fetch --> [ front ]
//
// The three numbers are always a permutation of 0, 1, 2, so the two threads never touch the same value, and each swap
// is one atomic exchange: no loop, no lock, whatever the other thread is doing and however long it sleeps. A value
// that nobody fetched is overwritten by a later one, as it should be.
//
// Why this much memory order and no more:
// - Filling a value must be seen by whoever fetches it: the exchange of publish() releases, that of fetch() acquires.
// - The writer gets back a place that the reader has left: what the reader read there must be over before the writer
//   fills it again. So fetch() also releases and publish() also acquires.
// - fetch() first looks, relaxed, whether there is anything new. Only the reader itself takes "new" away, so what it
//   then exchanges is new, if perhaps newer than what it saw.
// - The reader's wish is a hint and carries no data, but none may get lost. publish() takes it down before its
//   exchange, so a wish that follows the fetch of that value follows the taking down too (the exchanges order them)
//   and stands; a wish that was taken down came before a value that was on its way.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace crumble {

/// From one writing thread to one reading thread. Nothing here waits, locks or allocates; what filling a value does is
/// the writer's business. T is copied three times at construction and never again.
template <class T>
class LatestValue {
 public:
  /// All three places begin as `value`; the reader has fetched one of them.
  explicit LatestValue(const T& value) : places_{{{value}, {value}, {value}}} {}

  // The writing thread

  /// What the next publish() hands out. Holds some older value until filled.
  T& back() noexcept { return places_[back_].value; }
  /// back() becomes the newest value, and another place becomes back(). Fulfils the reader's wish.
  void publish() noexcept {
    wanted_.store(false, std::memory_order_relaxed);
    back_ = between_.exchange(back_ | kNew, std::memory_order_acq_rel) & kPlace;
  }
  /// The reader has asked for a value since the last publish().
  bool wanted() const noexcept { return wanted_.load(std::memory_order_relaxed); }

  // The reading thread

  /// Makes front() the newest value. False when there is none newer than that.
  bool fetch() noexcept {
    if (!(between_.load(std::memory_order_relaxed) & kNew)) return false;
    front_ = between_.exchange(front_, std::memory_order_acq_rel) & kPlace;
    return true;
  }
  /// fetch() would find one.
  bool has_new() const noexcept { return (between_.load(std::memory_order_relaxed) & kNew) != 0; }
  /// The value that the last fetch() found. Stays as it is until the next.
  const T& front() const noexcept { return places_[front_].value; }
  /// Asks for a value; a writer that publishes without being asked need not look.
  void request() noexcept { wanted_.store(true, std::memory_order_relaxed); }

 private:
  static constexpr std::uint32_t kPlace = 3, kNew = 4;
  // What one thread writes often shall not sit in a cache line that the other reads.
  static constexpr std::size_t kLine = 64;
  struct alignas(kLine) Place {
    T value;
  };

  std::array<Place, 3> places_;
  alignas(kLine) std::uint32_t back_ = 0;  // the writer's
  alignas(kLine) std::atomic<std::uint32_t> between_{1};
  std::atomic<bool> wanted_{false};
  alignas(kLine) std::uint32_t front_ = 2;  // the reader's
};

}  // namespace crumble
