#include "objects.hpp"

namespace crumble::capi {

// The handles' kinds. Constant-initialised and never destroyed, so that handles work before and after main.
constinit HandleTable Mesh::table{1};
constinit HandleTable Sim::table{2};

Sim::Sim(std::shared_ptr<const TetMesh> body, Simulation made)
    : mesh(std::move(body)),
      simulation(std::move(made)),
      poses(simulation.holder_count()),
      wrenches(simulation.holder_count()) {}

void Sim::build(SimulationDef def) {
  const std::size_t holders = def.tools.size() + def.attachments.size();
  poses.reserve(holders), wrenches.reserve(holders);
  Simulation next(std::move(def));
  simulation = std::move(next);
  poses.resize(holders), wrenches.resize(holders);
}

void Sim::publish_now() noexcept {
  for (const auto& link : readers) link->publisher.publish_now(simulation);
}

void Sim::drop_closed_readers() noexcept {
  std::erase_if(readers, [](const auto& link) { return !link->is_open; });
}

crumble_result fail_handle(const Call& call, const char* name, const void* handle, crumble_result result) noexcept {
  const TextPart value{std::uint64_t{reinterpret_cast<std::uintptr_t>(handle)}};
  switch (result) {
    case CRUMBLE_E_NULL:
      return call.fail(result, {name, " must not be NULL"});
    case CRUMBLE_E_STALE_HANDLE:
      return call.fail(result, {name, " has been destroyed"});
    case CRUMBLE_E_BUSY:
      return call.fail(result, {name, " is in use by another thread or by a loop that runs"});
    default:
      return call.fail(result, {name, " is no handle of this kind: ", value});
  }
}

}  // namespace crumble::capi
