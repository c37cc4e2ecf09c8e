// Recordings that are looked at step by step.
#include "crumble/sim/recording.hpp"

#include <string>

#include "defs.hpp"
#include "objects.hpp"

namespace crumble::capi {
namespace {

struct OpenRecording : Allocated {
  using Handle = crumble_recording;
  static constexpr const char* kName = "recording";
  static HandleTable table;

  explicit OpenRecording(Recording loaded) : recording(std::move(loaded)) {}
  Recording recording;
};
constinit HandleTable OpenRecording::table{6};

bool is_floor(const Wall& wall) {
  return wall.plane.normal == Vec3::UnitY() && wall.plane.offset == 0 && wall.friction.static_coefficient == 0;
}

std::unique_ptr<Sim> make_sim(Simulation start) {
  const SimulationDef& def = start.definition();
  auto made = std::make_unique<Sim>(share_new<const TetMesh>(def.mesh), std::move(start));
  const Vector<Wall>& walls = made->simulation.definition().walls;
  made->has_floor = !walls.empty() && is_floor(walls.front());
  return made;
}

crumble_result do_step(const Call& call, const Recording& recording, Sim& sim, std::uint64_t step,
                       std::uint32_t* equal) {
  if (step >= recording.step_count()) {
    return call.fail(CRUMBLE_E_OUT_OF_RANGE,
                     {"step is ", step, ", the recording has ", std::uint64_t{recording.step_count()}});
  }
  if (sim.simulation.holder_count() != recording.tool_count()) {
    return call.fail(CRUMBLE_E_OUT_OF_RANGE, {"the simulation has ", std::uint64_t{sim.simulation.holder_count()},
                                              " tools, the recording ", std::uint64_t{recording.tool_count()}});
  }
  if (sim.recording) throw Error(Code::state, "the simulation is being recorded: end it first");
  const auto index = static_cast<std::size_t>(step);
  recording.apply_changes(index, sim.simulation);
  sim.simulation.step(recording.poses(index));
  for (const auto& link : sim.readers) link->publisher.publish(sim.simulation);
  if (sim.simulation.info().status == Code::diverged) {
    return call.fail(CRUMBLE_E_DIVERGED, {"the body left the world in step ", step});
  }
  if (equal) *equal = sim.simulation.state_hash() == recording.state_hash(index);
  return CRUMBLE_OK;
}

}  // namespace
}  // namespace crumble::capi

using namespace crumble;
using namespace crumble::capi;

crumble_result crumble_recording_load(const char* path, crumble_recording* recording) {
  return guard(__func__, [&](const Call&) {
    require_pointer("recording", recording);
    publish(std::make_unique<OpenRecording>(Recording::load(path_of(path))), recording);
    return CRUMBLE_OK;
  });
}

crumble_result crumble_recording_destroy(crumble_recording recording) {
  return destroy<OpenRecording>(__func__, recording);
}

crumble_result crumble_recording_get_info(crumble_recording recording, crumble_recording_info* info) {
  return with<OpenRecording>(__func__, recording, [&](const OpenRecording& r, const Call&) {
    crumble_recording_info out{};
    out.tool_count = static_cast<std::uint32_t>(r.recording.tool_count());
    out.step_count = r.recording.step_count();
    out.first_step = r.recording.first_step();
    write_struct("info", info, out);
    return CRUMBLE_OK;
  });
}

crumble_result crumble_recording_create_sim(crumble_recording recording, crumble_sim* sim) {
  return with<OpenRecording>(__func__, recording, [&](const OpenRecording& r, const Call&) {
    require_pointer("sim", sim);
    publish(make_sim(r.recording.start()), sim);
    return CRUMBLE_OK;
  });
}

crumble_result crumble_recording_step(crumble_recording recording, crumble_sim sim, uint64_t step, uint32_t* equal) {
  return with<OpenRecording>(__func__, recording, [&](const OpenRecording& r, const Call& call) {
    return with<Sim>("crumble_recording_step", sim,
                     [&](Sim& s, const Call&) { return do_step(call, r.recording, s, step, equal); });
  });
}
