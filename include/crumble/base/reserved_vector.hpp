// A vector whose memory is taken once: copies keep the capacity, so a copied simulation still never allocates in a
// step.
#pragma once

#include <vector>

namespace crumble {

template <class T>
class ReservedVector : public std::vector<T> {
 public:
  ReservedVector() = default;
  ReservedVector(const ReservedVector& other) : std::vector<T>() { *this = other; }
  ReservedVector(ReservedVector&&) noexcept = default;
  ReservedVector& operator=(const ReservedVector& other) {
    this->reserve(other.capacity());
    this->assign(other.begin(), other.end());
    return *this;
  }
  ReservedVector& operator=(ReservedVector&&) noexcept = default;
};

}  // namespace crumble
