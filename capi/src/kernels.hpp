// Names of kernels as C may hold on to them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace crumble::capi {

/// kernel_names(), kept until the process ends.
const std::vector<std::string>& kernel_texts();
/// Of one of these.
std::uint32_t kernel_number(std::string_view name);

}  // namespace crumble::capi
