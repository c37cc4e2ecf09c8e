// The result codes' names. The codes themselves stand twice, in crumble.h for C and in base/error.hpp for what throws
// them; the macro below compares the two for each code.
#include "crumble/base/error.hpp"
#include "crumble/crumble.h"

namespace {

using crumble::Code;

#define CRUMBLE_RESULT(name, code)                                                     \
  case CRUMBLE_E_##name:                                                               \
    static_assert(CRUMBLE_E_##name == static_cast<crumble_result>(Code::code), #name); \
    return "CRUMBLE_E_" #name;

constexpr const char* name_of(crumble_result result) noexcept {
  switch (result) {
    case CRUMBLE_OK:
      return "CRUMBLE_OK";
      CRUMBLE_RESULT(NULL, null)
      CRUMBLE_RESULT(INVALID_VALUE, invalid_value)
      CRUMBLE_RESULT(OUT_OF_RANGE, out_of_range)
      CRUMBLE_RESULT(UNINITIALIZED, uninitialized)
      CRUMBLE_RESULT(VERSION, version)
      CRUMBLE_RESULT(BAD_HANDLE, bad_handle)
      CRUMBLE_RESULT(STALE_HANDLE, stale_handle)
      CRUMBLE_RESULT(BUSY, busy)
      CRUMBLE_RESULT(IN_USE, in_use)
      CRUMBLE_RESULT(BUFFER_TOO_SMALL, buffer_too_small)
      CRUMBLE_RESULT(NO_MEMORY, no_memory)
      CRUMBLE_RESULT(TOO_LARGE, too_large)
      CRUMBLE_RESULT(TOO_COARSE, too_coarse)
      CRUMBLE_RESULT(EMPTY, empty)
      CRUMBLE_RESULT(MESH, mesh)
      CRUMBLE_RESULT(MESH_OPEN, mesh_open)
      CRUMBLE_RESULT(MESH_ORIENTATION, mesh_orientation)
      CRUMBLE_RESULT(MESH_NONCONVEX, mesh_nonconvex)
      CRUMBLE_RESULT(DUPLICATE_NODE, duplicate_node)
      CRUMBLE_RESULT(ISOLATED_NODE, isolated_node)
      CRUMBLE_RESULT(DT_TOO_LARGE, dt_too_large)
      CRUMBLE_RESULT(BAD_POSE, bad_pose)
      CRUMBLE_RESULT(IO, io)
      CRUMBLE_RESULT(FORMAT, format)
      CRUMBLE_RESULT(CORRUPT, corrupt)
      CRUMBLE_RESULT(DEVICE_LOST, device_lost)
      CRUMBLE_RESULT(DIVERGED, diverged)
      CRUMBLE_RESULT(STATE, state)
      CRUMBLE_RESULT(UNSUPPORTED, unsupported)
      CRUMBLE_RESULT(INTERNAL, internal)
    default:
      return "unknown";
  }
}

}  // namespace

const char* crumble_result_name(crumble_result result) {
  return name_of(result);
}
