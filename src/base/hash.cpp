#include "crumble/base/hash.hpp"

#include <bit>
#include <cstring>

namespace crumble {

// One multiplication per word: 600 nodes hash in about a microsecond, where a hash by bytes would cost more than the
// step that it checks. The finishing mix is SplitMix64's.
void Hash::add(std::uint64_t word) {
  state_ = (state_ ^ word) * 0x9e3779b97f4a7c15u;
  state_ ^= state_ >> 29;
}

void Hash::add(double value) {
  add(std::bit_cast<std::uint64_t>(value));
}

void Hash::add(std::span<const double> values) {
  for (const double value : values) add(value);
}

void Hash::add(std::span<const std::uint8_t> bytes) {
  std::size_t i = 0;
  for (; i + 8 <= bytes.size(); i += 8) {
    std::uint64_t word;
    std::memcpy(&word, bytes.data() + i, 8);
    add(word);
  }
  std::uint64_t tail = 0;
  for (; i < bytes.size(); ++i) tail = tail << 8 | bytes[i];
  add(tail ^ static_cast<std::uint64_t>(bytes.size()) << 56);
}

std::uint64_t Hash::value() const {
  std::uint64_t z = state_;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

}  // namespace crumble
