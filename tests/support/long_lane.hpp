// How long tests look: the default run is short enough for every change, scripts/test-long is not.
#pragma once

#include <cstdlib>

namespace crumble {

/// CRUMBLE_LONG_TESTS in the environment.
inline bool is_long_lane() {
  return std::getenv("CRUMBLE_LONG_TESTS") != nullptr;
}

/// `all` in the long lane, else a fifth.
inline int in_long_lane(int all) {
  return is_long_lane() ? all : all / 5;
}

}  // namespace crumble
