#include "log.hpp"

#include <mutex>

#include "call.hpp"

namespace crumble::capi {
namespace {

struct Sink {
  crumble_log_function function = nullptr;
  void* user = nullptr;
};

constinit std::mutex setting;
constinit Sink sink;

}  // namespace

// Outside the lock, so that the function may call this API.
void log(std::uint32_t level, const char* text) noexcept {
  Sink now;
  {
    const std::lock_guard lock(setting);
    now = sink;
  }
  if (now.function) now.function(level, text, now.user);
}

}  // namespace crumble::capi

using namespace crumble::capi;

crumble_result crumble_log_set(crumble_log_function function, void* user) {
  return guard(__func__, [&](const Call&) {
    const std::lock_guard lock(setting);
    sink = {function, user};
    return CRUMBLE_OK;
  });
}
