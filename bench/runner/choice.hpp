// An option that takes one of some words.
#pragma once

#include <algorithm>
#include <string>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"

namespace crumble::bench {

/// Throws Error(unsupported) naming the option, the value and what there is.
inline void require_choice(const std::string& option, const std::string& value, const Vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), value) != known.end()) return;
  std::string list;
  for (const std::string& word : known) list += " " + word;
  throw Error(Code::unsupported, option + " '" + value + "' is not known; there are:" + list);
}

}  // namespace crumble::bench
