// What the handles stand for.
#pragma once

#include <atomic>
#include <memory>
#include <optional>

#include "call.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/fracture/surface.hpp"
#include "crumble/sim/recording.hpp"
#include "crumble/sim/simulation.hpp"
#include "handles.hpp"
#include "reader.hpp"

namespace crumble::capi {

struct Mesh : Allocated {
  using Handle = crumble_mesh;
  static constexpr const char* kName = "mesh";
  static HandleTable table;

  std::shared_ptr<const TetMesh> mesh;
};

struct Sim : Allocated {
  using Handle = crumble_sim;
  static constexpr const char* kName = "sim";
  static HandleTable table;

  Sim(std::shared_ptr<const TetMesh> body, Simulation made);

  /// Another simulation of the same mesh in place of this one. Throws Error, and then changes nothing.
  void build(SimulationDef def);
  /// Brings all readers up to the present state at once.
  void publish_now() noexcept;
  void drop_closed_readers() noexcept;

  // At rest. The surface borrows it: the simulation's own copy moves whenever it is restored or rebuilt.
  std::shared_ptr<const TetMesh> mesh;
  Simulation simulation;
  bool has_floor = false;   // the first wall
  Vector<Pose> poses;       // per tool; room for the step
  Vector<Wrench> wrenches;  // likewise
  std::optional<Recording> recording;
  std::unique_ptr<SurfaceExtractor> surface;  // from the first extraction on
  Vector<std::shared_ptr<ReaderLink>> readers;
  std::atomic<std::uint32_t> loops{0};  // that need it
};

/// Gives an object to the caller: the handle in `out`.
template <class Object>
void publish(std::unique_ptr<Object> object, typename Object::Handle* out) {
  *out = static_cast<typename Object::Handle>(Object::table.insert(object.get()));
  object.release();
}

crumble_result fail_handle(const Call& call, const char* name, const void* handle, crumble_result result) noexcept;

/// Runs `body(object, call)` with the object taken for this thread.
template <class Object, class Body>
crumble_result with(const char* function, typename Object::Handle handle, Body&& body) noexcept {
  return guard(function, [&](const Call& call) -> crumble_result {
    struct Taken {
      const void* handle;
      ~Taken() { Object::table.release(handle); }
    };
    void* object = nullptr;
    const crumble_result result = handle ? Object::table.acquire(handle, object) : CRUMBLE_E_NULL;
    if (result != CRUMBLE_OK) return fail_handle(call, Object::kName, handle, result);
    const Taken taken{handle};
    return body(*static_cast<Object*>(object), call);
  });
}

/// Runs `body(object, call)` whoever is at work in the object: for what any thread may do, quickly.
template <class Object, class Body>
crumble_result look(const char* function, typename Object::Handle handle, Body&& body) noexcept {
  return guard(function, [&](const Call& call) -> crumble_result {
    struct Seen {
      const void* handle;
      ~Seen() { Object::table.leave(handle); }
    };
    void* object = nullptr;
    const crumble_result result = handle ? Object::table.look(handle, object) : CRUMBLE_E_NULL;
    if (result != CRUMBLE_OK) return fail_handle(call, Object::kName, handle, result);
    const Seen seen{handle};
    return body(*static_cast<Object*>(object), call);
  });
}

template <class Object>
crumble_result destroy(const char* function, typename Object::Handle handle) noexcept {
  return guard(function, [&](const Call& call) -> crumble_result {
    if (!handle) return CRUMBLE_OK;
    void* found = nullptr;
    const crumble_result result = Object::table.acquire(handle, found);
    if (result != CRUMBLE_OK) return fail_handle(call, Object::kName, handle, result);
    auto* const object = static_cast<Object*>(found);
    if constexpr (requires { object->loops; }) {
      if (const std::uint32_t loops = object->loops; loops > 0) {
        Object::table.release(handle);
        return call.fail(CRUMBLE_E_IN_USE, {"the ", Object::kName, " has ", loops, " loops: destroy them first"});
      }
    }
    Object::table.remove(handle);
    delete object;
    return CRUMBLE_OK;
  });
}

}  // namespace crumble::capi
