// Words and numbers of a text, line by line.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/text.hpp"
#include "crumble/geometry/triangle_mesh.hpp"

namespace crumble {

class TextLines {
 public:
  explicit TextLines(std::string_view text) : text_(text) {}

  /// Goes to the next line that has words; false at the end.
  bool next() {
    words_.clear();
    while (words_.empty() && at_ < text_.size()) {
      ++number_;
      const std::size_t end = std::min(text_.find('\n', at_), text_.size());
      split(text_.substr(at_, end - at_));
      at_ = end + 1;
    }
    return !words_.empty();
  }
  const Vector<std::string_view>& words() const { return words_; }
  bool starts_with(std::string_view word) const { return words_[0] == word; }
  /// Where the next line begins, in bytes.
  std::size_t at() const { return std::min(at_, text_.size()); }

  double number(std::size_t word) const {
    std::string_view text = word < words_.size() ? words_[word] : std::string_view();
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto value = parse_double(text);
    if (!value || !std::isfinite(*value)) fail("has no number as its word " + std::to_string(word + 1));
    return *value;
  }
  Vec3 point(std::size_t word) const {
    const double x = number(word), y = number(word + 1);
    return {x, y, number(word + 2)};
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(Code::format, "line " + std::to_string(number_) + " " + what);
  }

 private:
  void split(std::string_view line) {
    constexpr std::string_view kSpace = " \t\r\v\f";
    for (std::size_t begin = line.find_first_not_of(kSpace); begin != std::string_view::npos;) {
      const std::size_t end = std::min(line.find_first_of(kSpace, begin), line.size());
      words_.push_back(line.substr(begin, end - begin));
      begin = line.find_first_not_of(kSpace, end);
    }
  }

  std::string_view text_;
  std::size_t at_ = 0, number_ = 0;
  Vector<std::string_view> words_;
};

/// A polygon as triangles about its first corner.
inline void add_polygon(const Vector<std::uint32_t>& corners, Vector<Triangle>& triangles) {
  for (std::size_t i = 2; i < corners.size(); ++i) triangles.push_back({corners[0], corners[i - 1], corners[i]});
}

}  // namespace crumble
