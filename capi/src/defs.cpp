#include "defs.hpp"

namespace crumble::capi {

void check_struct_size(const char* name, std::uint32_t struct_size) {
  if (struct_size == 0) throw Error(Code::uninitialized, std::string(name) + ".struct_size is 0");
  if (struct_size % kSizeStep != 0 || struct_size > kMostSize) {
    throw Error(Code::version,
                std::string(name) + ".struct_size " + std::to_string(struct_size) + " is no size of this struct");
  }
}

void require_zero_tail(const char* name, const void* given, std::size_t from, std::size_t to) {
  const auto* const bytes = static_cast<const unsigned char*>(given);
  for (std::size_t i = from; i < to; ++i) {
    if (bytes[i] == 0) continue;
    throw Error(Code::version, std::string(name) + " of " + std::to_string(to) +
                                   " bytes sets a field that this library does not have, at byte " + std::to_string(i));
  }
}

std::filesystem::path path_of(const char* path) {
  require_pointer("path", path);
  const auto* const utf8 = reinterpret_cast<const char8_t*>(path);
  return std::u8string(utf8, utf8 + std::string_view(path).size());
}

void require_at_most(const char* field, std::uint32_t value, std::uint32_t greatest) {
  if (value <= greatest) return;
  throw Error(Code::out_of_range,
              std::string(field) + " must be at most " + std::to_string(greatest) + ", is " + std::to_string(value));
}

}  // namespace crumble::capi
