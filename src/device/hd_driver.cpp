#include "device/hd_driver.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/text.hpp"

namespace crumble::device::hd {
namespace {

constexpr int kMostErrors = 64;  // to take at a time: a driver that never comes to an end shall not hold us
constexpr auto kPatience = std::chrono::milliseconds(100);

bool is_error(const ErrorInfo& error) noexcept {
  return error.code != kSuccess;
}

void note(Place& place, const ErrorInfo& error) noexcept {
  switch (describe(error.code).kind) {
    case ErrorClass::warm:
      place.warm.store(true, std::memory_order_relaxed);
      break;
    case ErrorClass::force_off:
      place.force_off.store(error.code, std::memory_order_relaxed);
      break;
    case ErrorClass::lost: {
      std::uint64_t none = 0;
      const std::uint64_t code = std::uint64_t{error.code} << 32 | static_cast<std::uint32_t>(error.internal_code);
      place.lost.compare_exchange_strong(none, code, std::memory_order_relaxed);
      break;
    }
  }
}

}  // namespace

Driver& Driver::get(const std::string& library) {
  static Driver& driver = *new Driver(load(library));      // never destroyed: the driver's thread may outlive main()
  if (!library.empty()) static_cast<void>(load(library));  // is it that one?
  return driver;
}

Place& Driver::free_place() {
  for (Place& place : places_) {
    if (place.handle == kInvalidHandle) return place;
  }
  throw Error(Code::too_large, "a process opens at most " + std::to_string(kMostDevices) + " PHANToM devices");
}

Place& Driver::open(const Vector<const char*>& names) {
  const std::lock_guard lock(mutex_);
  if (ticking_ > 0) {
    throw Error(Code::state, "a PHANToM cannot be opened while the servo thread of another runs: open both first");
  }
  Place& place = free_place();
  std::string reasons;
  for (const char* name : names) {
    take_error();
    const Handle handle = api().InitDevice(name);
    const ErrorInfo error = take_error();
    const bool is_ours =
        std::ranges::any_of(places_, [&](const Place& p) { return handle != kInvalidHandle && p.handle == handle; });
    if (handle != kInvalidHandle && !is_ours && (!is_error(error) || describe(error.code).kind == ErrorClass::warm)) {
      place.handle = handle;
      place.lost = 0, place.force_off = 0, place.warm = false;
      return place;
    }
    if (handle != kInvalidHandle && !is_ours) disable(handle);
    reasons += (reasons.empty() ? "" : "; ") + (name ? "'" + std::string(name) + "': " : "first device: ") +
               (is_ours           ? "is open already"
                : is_error(error) ? text_of(error)
                                  : "no handle, and no error");
  }
  throw Error(Code::device_lost, "no PHANToM device opens: " + reasons);
}

void Driver::close(Place& place, bool disable_it) noexcept {
  stop(place);
  const std::lock_guard lock(mutex_);
  place.is_leaving = true, place.disable = disable_it;
  if (ticking_ == 0) give_back(place);
}

void Driver::give_back(Place& place) noexcept {
  if (place.disable) disable(place.handle);
  place.handle = kInvalidHandle;
  place.is_leaving = place.disable = false;
  if (std::ranges::all_of(places_, [](const Place& p) { return p.handle == kInvalidHandle; })) rate_ = 0;
}

void Driver::disable(Handle handle) noexcept {
  api().MakeCurrentDevice(handle);
  api().DisableDevice(handle);
  take_error();
}

double Driver::agree_on_rate(double rate) {
  const std::lock_guard lock(mutex_);
  if (rate_ > 0 && rate != rate_) {
    throw Error(Code::out_of_range, "phantom.rate is " + to_text(rate) + " Hz, but that of a device open already is " +
                                        to_text(rate_) + " Hz, and they share a thread");
  }
  rate_ = rate;
  api().SetSchedulerRate(static_cast<unsigned long>(rate));
  take_error();  // whichever it is, the driver has kept its own rate
  int kept = 0;
  api().GetIntegerv(kUpdateRate, &kept);
  return is_error(take_error()) || kept <= 0 ? rate : kept;
}

bool Driver::has_license(const std::string& vendor, const std::string& application, const std::string& password) {
  const std::lock_guard lock(mutex_);
  const bool accepted =
      api().DeploymentLicense && api().DeploymentLicense(vendor.c_str(), application.c_str(), password.c_str()) != 0;
  return !is_error(take_error()) && accepted;
}

void Driver::start(Place& place, const ServoTick& tick) {
  const std::lock_guard lock(mutex_);
  if (place.is_ticking) throw Error(Code::state, "the servo thread calls a tick of this device already");
  place.tick = tick;
  place.stopping = place.inside = place.done = false;
  place.scheduled = api().ScheduleAsynchronous(call, &place, kDefaultPriority);
  if (ticking_ == 0) {
    if (const ErrorInfo error = take_error(); is_error(error)) {
      throw Error(Code::device_lost, "the PHANToM's servo thread takes no callback: " + text_of(error));
    }
    api().StartScheduler();  // from here on errors are that thread's to take
  }
  place.is_ticking = true;
  ++ticking_;
}

// The last one stops the thread. Others ask their callback to leave, so that no error of an unscheduling gets among
// those that the servo thread sorts. In both cases no call goes on when this returns, whatever the driver does.
void Driver::stop(Place& place) noexcept {
  const std::lock_guard lock(mutex_);
  if (!place.is_ticking) return;
  place.stopping = true;
  if (ticking_ == 1) {
    api().StopScheduler();
    api().Unschedule(place.scheduled);
    take_error();
    for (Place& each : places_) {
      if (each.is_leaving) give_back(each);
    }
  } else {
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (!place.done && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
    if (!place.done) api().Unschedule(place.scheduled);
  }
  while (place.inside) std::this_thread::yield();
  place.is_ticking = false;
  --ticking_;
}

unsigned CRUMBLE_HD_CALL Driver::call(void* context) noexcept {
  Place& place = *static_cast<Place*>(context);
  place.inside = true;
  const bool again = !place.stopping && place.tick.call(place.tick.context);
  if (!again) place.done = true;
  place.inside = false;
  return again ? kCallbackContinue : kCallbackDone;
}

// The stack gives the newest first; the oldest of the worst kind tells most.
ErrorInfo Driver::take_error() noexcept {
  ErrorInfo worst{};
  for (int i = 0; i < kMostErrors; ++i) {
    const ErrorInfo error = api().GetError();
    if (!is_error(error)) break;
    if (!is_error(worst) || describe(error.code).kind >= describe(worst.code).kind) worst = error;
  }
  return worst;
}

std::string Driver::text_of(const ErrorInfo& error) const {
  const char* const theirs = api().GetErrorString(error.code);
  return std::string(describe(error.code).text) + " (driver: '" + (theirs ? theirs : "") + "', internal code " +
         std::to_string(error.internal_code) + ")";
}

std::string Driver::version() const {
  const char* const told = api().GetString(kVersion);
  return told ? "HDAPI " + std::string(told) : "HDAPI";
}

// Errors of no device that is ours are everybody's.
void Driver::sort_errors() noexcept {
  for (int i = 0; i < kMostErrors; ++i) {
    const ErrorInfo error = api().GetError();
    if (!is_error(error)) return;
    const auto place = std::ranges::find(places_, error.device, &Place::handle);
    if (error.device != kInvalidHandle && place != places_.end()) {
      note(*place, error);
      continue;
    }
    for (Place& each : places_) {
      if (each.handle != kInvalidHandle) note(each, error);
    }
  }
}

}  // namespace crumble::device::hd
