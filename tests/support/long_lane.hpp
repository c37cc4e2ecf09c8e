// How long tests look: the default run is short enough for every change, scripts/test-long is not.
#pragma once

#include <cstdlib>

namespace crumble {

/// `all` with CRUMBLE_LONG_TESTS in the environment, else a fifth.
inline int in_long_lane(int all) {
  return std::getenv("CRUMBLE_LONG_TESTS") ? all : all / 5;
}

}  // namespace crumble
