#include "call.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <string>

namespace crumble::capi {
namespace {

thread_local std::array<char, 512> last_error{};

char* write_words(char* begin, char* end, std::string_view words) noexcept {
  return std::copy_n(words.data(), std::min(words.size(), static_cast<std::size_t>(end - begin)), begin);
}

template <class Number>
char* write_number(char* begin, char* end, Number number) noexcept {
  std::array<char, 32> digits;
  const auto [last, error] = std::to_chars(digits.data(), digits.data() + digits.size(), number);
  return write_words(begin, end, {digits.data(), last});
}

}  // namespace

char* TextPart::write(char* begin, char* end) const noexcept {
  switch (kind_) {
    case Kind::count:
      return write_number(begin, end, count_);
    case Kind::value:
      return write_number(begin, end, value_);
    default:
      return write_words(begin, end, words_);
  }
}

crumble_result Call::fail(crumble_result result, std::initializer_list<TextPart> text) const noexcept {
  char *at = last_error.data(), *const end = at + last_error.size() - 1;
  at = write_words(at, end, function_);
  at = write_words(at, end, ": ");
  for (const TextPart& part : text) at = part.write(at, end);
  *at = '\0';
  return result;
}

void require_pointer(std::string_view name, const void* pointer) {
  if (!pointer) throw Error(Code::null, std::string(name) + " must not be NULL");
}

}  // namespace crumble::capi

const char* crumble_last_error(void) {
  return crumble::capi::last_error.data();
}
