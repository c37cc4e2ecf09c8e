#include "device/hd_library.hpp"

#ifdef _WIN32
#include <windows.h>
#else
#include <dlfcn.h>
#endif

#include <cstdlib>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"

namespace crumble::device::hd {
namespace {

#ifdef _WIN32
const std::vector<std::string> kNames = {"HD.dll"};
void* open(const char* name) {
  return reinterpret_cast<void*>(LoadLibraryA(name));
}
void* find(void* library, const char* name) {
  return reinterpret_cast<void*>(GetProcAddress(reinterpret_cast<HMODULE>(library), name));
}
std::string loader_error() {
  return "system error " + std::to_string(GetLastError());
}
#else
#ifdef __APPLE__
const std::vector<std::string> kNames = {"libHD.dylib"};
#else
const std::vector<std::string> kNames = {"libHD.so", "libHD.so.3.4", "libHD.so.3.0"};
#endif
void* open(const char* name) {
  return dlopen(name, RTLD_NOW | RTLD_LOCAL);
}
void* find(void* library, const char* name) {
  return dlsym(library, name);
}
std::string loader_error() {
  const char* const text = dlerror();
  return text ? text : "unknown error";
}
#endif

Vector<std::string> candidates(const std::string& path) {
  if (!path.empty()) return {path};
  if (const char* const named = std::getenv("CRUMBLE_HDAPI"); named && *named) return {named};
  return {kNames.begin(), kNames.end()};
}

template <class Function>
void bind(void* library, const std::string& path, const char* name, Function& function) {
  void* const symbol = find(library, name);
  if (!symbol) throw Error(Code::unsupported, "library '" + path + "' is no HDAPI: it has no " + name);
  function = reinterpret_cast<Function>(symbol);
}

Api bind_all(void* library, const std::string& path) {
  Api api{};
  const auto get = [&](const char* name, auto& function) { bind(library, path, name, function); };
  get("hdInitDevice", api.InitDevice);
  get("hdDisableDevice", api.DisableDevice);
  get("hdMakeCurrentDevice", api.MakeCurrentDevice);
  get("hdBeginFrame", api.BeginFrame);
  get("hdEndFrame", api.EndFrame);
  get("hdGetError", api.GetError);
  get("hdGetErrorString", api.GetErrorString);
  get("hdEnable", api.Enable);
  get("hdGetIntegerv", api.GetIntegerv);
  get("hdGetDoublev", api.GetDoublev);
  get("hdGetString", api.GetString);
  get("hdSetDoublev", api.SetDoublev);
  get("hdCheckCalibration", api.CheckCalibration);
  get("hdUpdateCalibration", api.UpdateCalibration);
  get("hdStartScheduler", api.StartScheduler);
  get("hdStopScheduler", api.StopScheduler);
  get("hdSetSchedulerRate", api.SetSchedulerRate);
  get("hdScheduleAsynchronous", api.ScheduleAsynchronous);
  get("hdUnschedule", api.Unschedule);
  api.DeploymentLicense = reinterpret_cast<decltype(api.DeploymentLicense)>(find(library, "hdDeploymentLicense"));
  return api;
}

std::unique_ptr<const Library> load_first(const Vector<std::string>& names) {
  std::string reasons;
  for (const std::string& name : names) {
    if (void* const library = open(name.c_str())) {
      return std::make_unique<const Library>(Library{bind_all(library, name), name});
    }
    reasons += (reasons.empty() ? "" : "; ") + loader_error();
  }
  throw Error(Code::unsupported, "no HDAPI can be loaded: " + reasons +
                                     ". It comes with 3D Systems' OpenHaptics and the device's driver; name it by "
                                     "phantom.library or CRUMBLE_HDAPI where it stands elsewhere");
}

}  // namespace

const Library& load(const std::string& path) {
  static std::mutex mutex;
  static const Library* loaded = nullptr;  // kept to the end of the process, as it may be in use to the last
  const std::lock_guard lock(mutex);
  if (!loaded) {
    loaded = load_first(candidates(path)).release();
  } else if (!path.empty() && path != loaded->path) {
    throw Error(Code::state, "phantom.library is '" + path + "', but this process has loaded '" + loaded->path +
                                 "', and the driver bears no second one");
  }
  return *loaded;
}

}  // namespace crumble::device::hd
