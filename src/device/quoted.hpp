// Text of a file, as a message may hold it: what a file has in a line is not always short, nor text.
#pragma once

#include <string>
#include <string_view>

namespace crumble::device {

/// In quotation marks, 40 bytes at most, with \xNN for bytes that are not printable ASCII.
inline std::string quoted(std::string_view text) {
  constexpr std::size_t kMost = 40;
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string out = "'";
  for (const char c : text.substr(0, kMost)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7f) {
      out += c;
    } else {
      out += {'\\', 'x', kDigits[byte >> 4], kDigits[byte & 15]};
    }
  }
  return out + (text.size() > kMost ? "...'" : "'");
}

}  // namespace crumble::device
