#include "network/kernels.hpp"

#include <cstdlib>
#include <string>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/network/solver.hpp"

namespace crumble {

Vector<std::string> kernel_names() {
  Vector<std::string> names{scalar_kernels().name};
  for (const KernelSet* set : simd_kernels()) names.emplace_back(set->name);
  return names;
}

const KernelSet& find_kernels(std::string_view name) {
  if (const char* wanted = std::getenv("CRUMBLE_KERNEL"); name.empty() && wanted != nullptr) name = wanted;
  const auto simd = simd_kernels();
  if (name.empty()) return simd.empty() ? scalar_kernels() : *simd.back();
  if (name == scalar_kernels().name) return scalar_kernels();
  for (const KernelSet* set : simd) {
    if (name == set->name) return *set;
  }
  std::string names;
  for (const std::string& each : kernel_names()) names += (names.empty() ? "" : ", ") + each;
  throw Error(Code::unsupported, "kernel '" + std::string(name) + "' is not there; this processor runs " + names);
}

}  // namespace crumble
