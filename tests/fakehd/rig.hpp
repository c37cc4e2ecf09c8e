// The double as a test meets it: opened by path, every symbol and number typed here, none taken from its own headers
// but the probes'.
#pragma once

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <stdexcept>
#include <string>

#include "fakehd.h"

namespace fakehd_test {

struct Error {
  unsigned code;
  int internal;
  unsigned device;
};
static_assert(sizeof(Error) == 12);

using Callback = unsigned (*)(void*);
using Vec = std::array<double, 3>;

class Library {
 public:
  explicit Library(const char* path) : handle_(dlopen(path, RTLD_NOW | RTLD_LOCAL)) {
    if (!handle_) throw std::runtime_error(dlerror());
  }

  void* find(const char* name) const { return dlsym(handle_, name); }

  template <class F>
  F* get(const char* name) const {
    void* at = find(name);
    if (!at) throw std::runtime_error(std::string("no symbol ") + name);
    return reinterpret_cast<F*>(at);
  }

 private:
  void* handle_;  // never closed, as an adapter must not
};

/// The functions by their names without hd.
struct Hd {
  explicit Hd(const Library& l) : library(l) {}

  Library library;
  unsigned (*init)(const char*) = library.get<unsigned(const char*)>("hdInitDevice");
  void (*disable_device)(unsigned) = library.get<void(unsigned)>("hdDisableDevice");
  void (*make_current)(unsigned) = library.get<void(unsigned)>("hdMakeCurrentDevice");
  unsigned (*current)() = library.get<unsigned()>("hdGetCurrentDevice");
  void (*begin)(unsigned) = library.get<void(unsigned)>("hdBeginFrame");
  void (*end)(unsigned) = library.get<void(unsigned)>("hdEndFrame");
  Error (*error)() = library.get<Error()>("hdGetError");
  const char* (*error_string)(unsigned) = library.get<const char*(unsigned)>("hdGetErrorString");
  void (*enable)(unsigned) = library.get<void(unsigned)>("hdEnable");
  void (*disable)(unsigned) = library.get<void(unsigned)>("hdDisable");
  unsigned char (*is_enabled)(unsigned) = library.get<unsigned char(unsigned)>("hdIsEnabled");
  void (*get_boolean)(unsigned, unsigned char*) = library.get<void(unsigned, unsigned char*)>("hdGetBooleanv");
  void (*get_integer)(unsigned, int*) = library.get<void(unsigned, int*)>("hdGetIntegerv");
  void (*get_float)(unsigned, float*) = library.get<void(unsigned, float*)>("hdGetFloatv");
  void (*get_double)(unsigned, double*) = library.get<void(unsigned, double*)>("hdGetDoublev");
  void (*get_long)(unsigned, long*) = library.get<void(unsigned, long*)>("hdGetLongv");
  const char* (*string)(unsigned) = library.get<const char*(unsigned)>("hdGetString");
  void (*set_integer)(unsigned, const int*) = library.get<void(unsigned, const int*)>("hdSetIntegerv");
  void (*set_float)(unsigned, const float*) = library.get<void(unsigned, const float*)>("hdSetFloatv");
  void (*set_double)(unsigned, const double*) = library.get<void(unsigned, const double*)>("hdSetDoublev");
  unsigned (*calibration)() = library.get<unsigned()>("hdCheckCalibration");
  unsigned (*calibration_style)() = library.get<unsigned()>("hdCheckCalibrationStyle");
  void (*calibrate)(unsigned) = library.get<void(unsigned)>("hdUpdateCalibration");
  void (*start)() = library.get<void()>("hdStartScheduler");
  void (*stop)() = library.get<void()>("hdStopScheduler");
  void (*set_rate)(unsigned long) = library.get<void(unsigned long)>("hdSetSchedulerRate");
  unsigned long (*schedule)(Callback, void*, unsigned short) =
      library.get<unsigned long(Callback, void*, unsigned short)>("hdScheduleAsynchronous");
  void (*schedule_and_wait)(Callback, void*, unsigned short) =
      library.get<void(Callback, void*, unsigned short)>("hdScheduleSynchronous");
  void (*unschedule)(unsigned long) = library.get<void(unsigned long)>("hdUnschedule");
  unsigned char (*wait)(unsigned long,
                        unsigned) = library.get<unsigned char(unsigned long, unsigned)>("hdWaitForCompletion");
  double (*time_stamp)() = library.get<double()>("hdGetSchedulerTimeStamp");
  unsigned char (*license)(const char*, const char*, const char*) =
      library.get<unsigned char(const char*, const char*, const char*)>("hdDeploymentLicense");
};

inline const Hd& hd() {
  static const Hd only{Library(FAKEHD_LIBRARY)};
  return only;
}

/// A probe, called by its own declaration.
#define FAKEHD(name) (fakehd_test::hd().library.get<decltype(name)>(#name))

using Work = std::function<unsigned()>;

inline unsigned call_work(void* user) {
  return (*static_cast<Work*>(user))();
}

/// One device without calibration, in manual mode, unless a test says otherwise; misuse fails the test that made none
/// on purpose.
class FakeHd : public testing::Test {
 protected:
  void SetUp() override { reset(R"({"manual": true, "devices": [{"calibration": "none", "ramp_s": 0}]})"); }
  void TearDown() override {
    if (!misuse_expected) {
      EXPECT_EQ(FAKEHD(fakehd_misuse)(), 0u) << FAKEHD(fakehd_misuse_text)();
    }
    FAKEHD(fakehd_reset)(nullptr);
  }

  void reset(const char* script) { ASSERT_EQ(FAKEHD(fakehd_reset)(script), 0) << FAKEHD(fakehd_script_error)(); }

  /// One tick with `what` in it.
  void tick(const std::function<void()>& what) {
    Work once = [&] { return what(), 0u; };
    hd().schedule(call_work, &once, 100);
    ASSERT_EQ(FAKEHD(fakehd_run_ticks)(1), 1);
  }

  void frame(
      unsigned device, const std::function<void()>& what = [] {}) {
    tick([&] {
      hd().begin(device);
      what();
      hd().end(device);
    });
  }

  void frame_with_force(unsigned device, const Vec& force) {
    frame(device, [&] { hd().set_double(0x2700, force.data()); });
  }

  /// Opened, the force on, the scheduler started.
  unsigned started() {
    const unsigned device = hd().init(nullptr);
    hd().enable(0x4000);
    hd().start();
    return device;
  }

  static Vec applied(unsigned device) {
    Vec force{};
    FAKEHD(fakehd_applied_force)(device, force.data());
    return force;
  }

  static Vec position(unsigned device) {
    Vec p{};
    FAKEHD(fakehd_position)(device, p.data());
    return p;
  }

  static Vec read(unsigned name) {
    Vec v{};
    hd().get_double(name, v.data());
    return v;
  }

  static unsigned next_error() { return hd().error().code; }

  bool misuse_expected = false;
};

}  // namespace fakehd_test
