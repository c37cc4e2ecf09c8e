#include <memory>

#include "call.hpp"
#include "crumble/crumble.h"
#include "kernels.hpp"

// project(VERSION) is where the version is written; the header repeats it so that it can be read without CMake.
static_assert(CRUMBLE_VERSION_MAJOR == CRUMBLE_PROJECT_MAJOR && CRUMBLE_VERSION_MINOR == CRUMBLE_PROJECT_MINOR &&
                  CRUMBLE_VERSION_PATCH == CRUMBLE_PROJECT_PATCH,
              "crumble.h and project(VERSION) must agree");

#define CRUMBLE_TEXT_OF(x) #x
#define CRUMBLE_TEXT(x) CRUMBLE_TEXT_OF(x)
#define CRUMBLE_VERSION_TEXT \
  CRUMBLE_TEXT(CRUMBLE_VERSION_MAJOR) "." CRUMBLE_TEXT(CRUMBLE_VERSION_MINOR) "." CRUMBLE_TEXT(CRUMBLE_VERSION_PATCH)

uint32_t crumble_version(void) {
  return CRUMBLE_VERSION_NUMBER;
}

const char* crumble_version_string(void) {
  return CRUMBLE_VERSION_TEXT;
}

const char* crumble_build_info(void) {
  static constexpr const char* kBuild =
      "crumble " CRUMBLE_VERSION_TEXT ", revision " CRUMBLE_REVISION ", " CRUMBLE_COMPILER ", " CRUMBLE_BUILD_TYPE;
  const char* info = kBuild;
  crumble::capi::guard(__func__, [&](const crumble::capi::Call&) {
    static const auto* const text = [] {  // never destroyed, as the others
      auto made = std::make_unique<std::string>(kBuild);
      *made += ", kernels";
      for (const std::string& name : crumble::capi::kernel_texts()) *made += " " + name;
      return made.release();
    }();
    info = text->c_str();
    return CRUMBLE_OK;
  });
  return info;
}

crumble_result crumble_check_version(uint32_t header_version) {
  return crumble::capi::guard(__func__, [&](const crumble::capi::Call& call) -> crumble_result {
    const uint32_t significant = CRUMBLE_VERSION_MAJOR == 0 ? 1000 : 1000000;
    if (header_version / significant == CRUMBLE_VERSION_NUMBER / significant) return CRUMBLE_OK;
    return call.fail(CRUMBLE_E_VERSION,
                     {"header_version ", header_version, " does not fit this library, ", CRUMBLE_VERSION_TEXT});
  });
}
