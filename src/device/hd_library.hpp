// HDAPI, loaded when somebody wants it. A process has one: the driver fails if it is loaded a second time after having
// been closed, so it never is closed.
#pragma once

#include <string>

#include "device/hd_api.hpp"

namespace crumble::device::hd {

struct Library {
  Api api;
  std::string path;  // as it was given to the loader
};

/// `path` empty: that in the environment variable CRUMBLE_HDAPI, else the names that its installers give it. Throws
/// Error: unsupported (none can be loaded, with the loader's own words; or it is none), state (another one has been
/// loaded).
const Library& load(const std::string& path);

}  // namespace crumble::device::hd
