// 64-bit hash of state: says whether two runs have the same bits, and finds a damaged file. Not cryptographic.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace crumble {

class Hash {
 public:
  void add(std::uint64_t word);
  void add(double value);  // by its bits, so -0 and 0 differ
  void add(std::span<const double> values);
  void add(std::span<const std::uint8_t> bytes);
  std::uint64_t value() const;

 private:
  std::uint64_t state_ = 0x6372756d626c6531u;
};

}  // namespace crumble
