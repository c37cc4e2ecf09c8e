#include "kernels.hpp"

#include <algorithm>

#include "call.hpp"
#include "crumble/network/solver.hpp"

namespace crumble::capi {

// Never destroyed: a program may still print a name while it ends.
const std::vector<std::string>& kernel_texts() {
  static const auto* const texts = [] {
    const auto names = kernel_names();
    return new std::vector<std::string>(names.begin(), names.end());  // not the host's memory: it is never given back
  }();
  return *texts;
}

std::uint32_t kernel_number(std::string_view name) {
  const auto& texts = kernel_texts();
  return static_cast<std::uint32_t>(std::find(texts.begin(), texts.end(), name) - texts.begin());
}

}  // namespace crumble::capi

const char* crumble_kernel_name(uint32_t index) {
  const char* name = nullptr;
  crumble::capi::guard(__func__, [&](const crumble::capi::Call&) {
    const auto& texts = crumble::capi::kernel_texts();
    if (index < texts.size()) name = texts[index].c_str();
    return CRUMBLE_OK;
  });
  return name;
}
