#include "call.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>
#include <string>
#include <utility>

#include "field_names.hpp"
#include "log.hpp"

namespace crumble::capi {
namespace {

thread_local std::array<char, 512> last_error{};
thread_local bool is_told = true;  // the log knows of it

// A log may write files, which a step must not.
bool is_for_servo_loops(std::string_view function) {
  static constexpr std::string_view kNames[] = {
      "crumble_sim_step",    "crumble_sim_step_tools",       "crumble_sim_advance",
      "crumble_loop_tick",   "crumble_local_model_evaluate", "crumble_device_read",
      "crumble_device_write"};
  return std::find(std::begin(kNames), std::end(kNames), function) != std::end(kNames);
}

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
  is_told = false;
  return result;
}

crumble_result Call::fail(const Error& error) const noexcept {
  const auto result = static_cast<crumble_result>(error.code());
  try {
    const std::string text = in_names_of_c(error.what());
    return fail(result, {std::string_view(text)});
  } catch (...) {  // no memory for another text
    return fail(result, {error.what()});
  }
}

void Call::tell_log() const noexcept {
  if (std::exchange(is_told, true) || is_for_servo_loops(function_)) return;
  const std::array<char, 512> text = last_error;
  log(CRUMBLE_LOG_ERROR, text.data());
  last_error = text;  // the log's own calls may have failed
  is_told = true;
}

void require_pointer(std::string_view name, const void* pointer) {
  if (!pointer) throw Error(Code::null, std::string(name) + " must not be NULL");
}

}  // namespace crumble::capi

const char* crumble_last_error(void) {
  return crumble::capi::last_error.data();
}
