// A vector whose memory is taken once: copies keep the capacity, so a copied simulation still never allocates in a
// step. The system gives a page when it is first written to; reserve() writes to all of them, so that no step has to
// wait for one.
#pragma once

#include "crumble/base/memory.hpp"

namespace crumble {

template <class T>
class ReservedVector : public Vector<T> {
 public:
  ReservedVector() = default;
  ReservedVector(const ReservedVector& other) : Vector<T>() { *this = other; }
  ReservedVector(ReservedVector&&) noexcept = default;
  ReservedVector& operator=(const ReservedVector& other) {
    reserve(other.capacity());
    this->assign(other.begin(), other.end());
    return *this;
  }
  ReservedVector& operator=(ReservedVector&&) noexcept = default;

  /// Of an empty vector, or of one that has as much already.
  void reserve(std::size_t count) {
    if (count <= this->capacity()) return;
    this->resize(count);
    this->clear();
  }
};

}  // namespace crumble
