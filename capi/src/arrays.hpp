// Output in bulk: views and copies of the arrays that CRUMBLE_ARRAY_ names.
#pragma once

#include <array>
#include <cstring>
#include <span>
#include <string>

#include "call.hpp"
#include "crumble/base/vec_array.hpp"
#include "crumble/fracture/surface.hpp"

namespace crumble::capi {

inline std::uint32_t scalar_bytes(std::uint32_t scalar_type) {
  switch (scalar_type) {
    case CRUMBLE_SCALAR_FLOAT64:
      return 8;
    case CRUMBLE_SCALAR_UINT8:
      return 1;
    default:
      return 4;
  }
}

inline crumble_view view_of(const void* data, std::size_t count, std::uint32_t components, std::uint32_t scalar_type) {
  return {data, count, components * scalar_bytes(scalar_type), components, scalar_type, 0};
}
inline crumble_view view_of(std::span<const double> a) {
  return view_of(a.data(), a.size(), 1, CRUMBLE_SCALAR_FLOAT64);
}
inline crumble_view view_of(std::span<const std::uint8_t> a) {
  return view_of(a.data(), a.size(), 1, CRUMBLE_SCALAR_UINT8);
}
inline crumble_view view_of(std::span<const std::uint32_t> a) {
  return view_of(a.data(), a.size(), 1, CRUMBLE_SCALAR_UINT32);
}
template <std::size_t N>
crumble_view view_of(std::span<const std::array<std::uint32_t, N>> a) {
  return view_of(a.data(), a.size(), N, CRUMBLE_SCALAR_UINT32);
}
static_assert(sizeof(Vec3) == 3 * sizeof(double));
inline crumble_view view_of(std::span<const Vec3> a) {
  return view_of(a.data(), a.size(), 3, CRUMBLE_SCALAR_FLOAT64);
}

/// The contract of every output buffer: `bytes` go to `dst` by `write(dst)` if they fit in `dst_bytes`; with `dst` NULL
/// the call asks for the size only.
template <class Write>
crumble_result deliver(const Call& call, std::uint64_t bytes, void* dst, std::uint64_t dst_bytes, std::uint64_t* needed,
                       Write&& write) {
  if (!dst && !needed) return call.fail(CRUMBLE_E_NULL, {"dst and needed must not both be NULL"});
  if (needed) *needed = bytes;
  if (!dst) return CRUMBLE_OK;
  if (dst_bytes < bytes) {
    return call.fail(CRUMBLE_E_BUFFER_TOO_SMALL, {"dst_bytes is ", dst_bytes, ", needed are ", bytes});
  }
  write(dst);
  return CRUMBLE_OK;
}

/// A text, with a zero behind it.
inline crumble_result deliver(const Call& call, const std::string& text, char* dst, std::uint64_t dst_bytes,
                              std::uint64_t* needed) {
  return deliver(call, text.size() + 1, dst, dst_bytes, needed,
                 [&](void* to) { std::memcpy(to, text.c_str(), text.size() + 1); });
}

/// An array of the group CRUMBLE_ARRAY_SURFACE_. Throws Error(out_of_range).
crumble_view view_of_surface(const SurfaceExtractor& surface, std::uint32_t which);

crumble_result copy(const Call& call, const crumble_view& view, void* dst, std::uint64_t dst_bytes,
                    std::uint64_t* needed);
/// Three component arrays as (n, 3) rows.
crumble_result copy(const Call& call, const VecView& rows, void* dst, std::uint64_t dst_bytes, std::uint64_t* needed);

}  // namespace crumble::capi
