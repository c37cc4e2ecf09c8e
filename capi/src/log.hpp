// What the library has to say to its host.
#pragma once

#include <cstdint>
#include <string>

#include "crumble/crumble.h"

namespace crumble::capi {

/// To the host's function, if there is one.
void log(std::uint32_t level, const char* text) noexcept;
inline void log(std::uint32_t level, const std::string& text) noexcept {
  log(level, text.c_str());
}

}  // namespace crumble::capi
