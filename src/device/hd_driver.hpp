// The driver behind HDAPI as one process has it: one servo thread for all devices, one current device, and one stack of
// errors for everybody. Each device has a place here that outlives it, so that whatever the driver's thread still does
// finds something.
//
// Rules of HDAPI that this keeps: while the servo thread runs, devices and errors are its own; devices are opened and
// closed while it does not; the scheduler is started last.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>

#include "crumble/base/memory.hpp"
#include "crumble/device/device.hpp"
#include "device/hd_errors.hpp"
#include "device/hd_library.hpp"

namespace crumble::device::hd {

/// What became of one device, and its callback.
struct Place {
  Handle handle = kInvalidHandle;  // changes only while the servo thread stands
  // Written by the servo thread
  std::atomic<std::uint64_t> lost{0};       // code and internal code of the first such error
  std::atomic<std::uint32_t> force_off{0};  // code of the last, until it is taken
  std::atomic<bool> warm{false};            // likewise
  // Between both
  ServoTick tick;
  SchedulerHandle scheduled = 0;
  bool is_ticking = false;
  bool is_leaving = false, disable = false;  // closed while the servo thread ran: to be given back, and disabled
  std::atomic<bool> stopping{false}, inside{false}, done{false};
};

class Driver {
 public:
  static constexpr std::size_t kMostDevices = 4;

  /// The one of this process. Throws what load() throws.
  static Driver& get(const std::string& library);
  const Api& api() const noexcept { return library_.api; }
  const std::string& path() const noexcept { return library_.path; }
  /// Of HDAPI, as it tells; empty while no device is open, where it does not.
  std::string version() const;

  // Threads of the host

  /// Opens the device with one of `names`, null being none, and makes it current. Throws Error, see open_phantom.
  Place& open(const Vector<const char*>& names);
  void close(Place& place, bool disable) noexcept;
  void start(Place& place, const ServoTick& tick);
  void stop(Place& place) noexcept;
  /// Sets what is to be, and gives what is.
  double agree_on_rate(double rate);
  bool has_license(const std::string& vendor, const std::string& application, const std::string& password);
  /// What the driver has to say since the last call: code 0 if nothing. Only while the servo thread stands.
  ErrorInfo take_error() noexcept;
  std::string text_of(const ErrorInfo& error) const;

  // The servo thread

  /// Sorts what the driver has to say to the devices' places.
  void sort_errors() noexcept;

 private:
  explicit Driver(const Library& library) : library_(library) {}
  static unsigned CRUMBLE_HD_CALL call(void* place) noexcept;
  Place& free_place();
  void give_back(Place& place) noexcept;
  void disable(Handle handle) noexcept;

  const Library& library_;
  std::mutex mutex_;
  std::array<Place, kMostDevices> places_;
  std::size_t ticking_ = 0;
  double rate_ = 0;  // Hz that has been asked for; 0: none
};

}  // namespace crumble::device::hd
