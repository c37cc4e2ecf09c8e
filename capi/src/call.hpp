// What every entry of the C API stands in: no exception leaves, every failure leaves its text.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <new>
#include <string_view>
#include <utility>

#include "crumble/base/error.hpp"
#include "crumble/crumble.h"

namespace crumble::capi {

/// One part of an error's text: words or a number. Borrowed; formatted without memory.
class TextPart {
 public:
  TextPart(const char* words) : words_(words) {}
  TextPart(std::string_view words) : words_(words) {}
  TextPart(std::uint64_t count) : kind_(Kind::count), count_(count) {}
  TextPart(std::uint32_t count) : TextPart(std::uint64_t{count}) {}
  TextPart(double value) : kind_(Kind::value), value_(value) {}
  /// Writes into [begin, end) as much as fits and returns where it ended.
  char* write(char* begin, char* end) const noexcept;

 private:
  enum class Kind : std::uint8_t { words, count, value };
  Kind kind_ = Kind::words;
  std::string_view words_;
  std::uint64_t count_ = 0;
  double value_ = 0;
};

/// The entry that runs: whose name stands before the text.
class Call {
 public:
  explicit Call(const char* function) : function_(function) {}
  /// Sets the thread's last error and returns `result`. Allocates nothing, so a step may fail this way.
  crumble_result fail(crumble_result result, std::initializer_list<TextPart> text) const noexcept;
  /// With the names of C's fields.
  crumble_result fail(const Error& error) const noexcept;
  /// Of the last failure, unless it has been told of it or the function is for servo loops.
  void tell_log() const noexcept;

 private:
  const char* function_;
};

/// `body(call)`, which returns a crumble_result, fails through `call` or throws.
template <class Body>
crumble_result run(const Call& call, Body&& body) noexcept {
  try {
    return std::forward<Body>(body)(call);
  } catch (const Error& error) {
    return call.fail(error);
  } catch (const std::bad_alloc&) {
    return call.fail(CRUMBLE_E_NO_MEMORY, {"out of memory"});
  } catch (const std::exception& error) {
    return call.fail(CRUMBLE_E_INTERNAL, {"unexpected: ", error.what()});
  } catch (...) {
    return call.fail(CRUMBLE_E_INTERNAL, {"unexpected exception"});
  }
}

/// What every function of the API stands in: the same, and tells the log of a failure.
template <class Body>
crumble_result guard(const char* function, Body&& body) noexcept {
  const Call call(function);
  const crumble_result result = run(call, std::forward<Body>(body));
  if (result != CRUMBLE_OK) call.tell_log();
  return result;
}

/// Throws Error(null) naming the parameter.
void require_pointer(std::string_view name, const void* pointer);

}  // namespace crumble::capi
