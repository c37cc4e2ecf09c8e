// The names of C's fields in texts that speak of the C++ library's.
#pragma once

#include <string>
#include <string_view>

namespace crumble::capi {

/// "safety.max_force must be ..." as "max_force must be ...", and so on.
std::string in_names_of_c(std::string_view text);

}  // namespace crumble::capi
