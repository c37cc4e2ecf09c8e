// Debian's emscripten brings the C++ library of LLVM 13, which lacks parts of C++20. These are the ones that base,
// geometry, tetmesh and network use; scripts/verify-kernels puts this file in front of every source. Only numbers in
// messages may come out differently.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <type_traits>

static_assert(_LIBCPP_VERSION < 14000, "this library may have what stands here");

_LIBCPP_BEGIN_NAMESPACE_STD

template <class To, class From>
constexpr To bit_cast(const From& from) noexcept {
  return __builtin_bit_cast(To, from);
}

inline to_chars_result to_chars(char* first, char* last, double value) {
  return {first + std::snprintf(first, static_cast<size_t>(last - first), "%.17g", value), errc{}};
}
inline from_chars_result from_chars(const char* first, const char* last, double& value) {
  const string text(first, last);
  char* end = nullptr;
  value = std::strtod(text.c_str(), &end);
  return {first + (end - text.c_str()), end == text.c_str() ? errc::invalid_argument : errc{}};
}

namespace ranges {

template <class Range, class T>
auto find(Range&& range, const T& value) {
  return std::find(range.begin(), range.end(), value);
}
template <class Range, class T>
auto upper_bound(Range&& range, const T& value) {
  return std::upper_bound(range.begin(), range.end(), value);
}
template <class It, class T, class Projection>
It lower_bound(It first, It last, const T& value, std::less<>, Projection projection) {
  return std::lower_bound(first, last, value, [&](const auto& a, const T& b) { return projection(a) < b; });
}
template <class Range>
auto min(Range&& range) {
  return *std::min_element(range.begin(), range.end());
}
template <class Range>
void sort(Range&& range) {
  std::sort(range.begin(), range.end());
}
template <class Range, class Less>
void stable_sort(Range&& range, Less less) {
  std::stable_sort(range.begin(), range.end(), less);
}

}  // namespace ranges

_LIBCPP_END_NAMESPACE_STD
