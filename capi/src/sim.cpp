// A simulation's life.
#include "defs.hpp"
#include "objects.hpp"
#include "sim_change.hpp"
#include "sim_def.hpp"

using namespace crumble;
using namespace crumble::capi;

crumble_result crumble_sim_create(crumble_mesh mesh, const crumble_sim_def* def, crumble_sim* sim) {
  return guard(__func__, [&](const Call&) -> crumble_result {
    require_pointer("sim", sim);
    const crumble_sim_def given = def ? read_sim_def(def) : default_sim_def();
    std::shared_ptr<const TetMesh> body;
    const crumble_result result = with<Mesh>("crumble_sim_create", mesh, [&](const Mesh& m, const Call&) {
      body = m.mesh;
      return CRUMBLE_OK;
    });
    if (result != CRUMBLE_OK) return result;
    SimulationDef definition;
    definition.mesh = *body;
    definition.walls.clear();
    if (given.floor) definition.walls.push_back(make_floor());
    apply(given, definition);
    auto object = std::make_unique<Sim>(std::move(body), Simulation(std::move(definition)));
    object->has_floor = given.floor != 0;
    publish(std::move(object), sim);
    return CRUMBLE_OK;
  });
}

crumble_result crumble_sim_destroy(crumble_sim sim) {
  return destroy<Sim>(__func__, sim);
}

crumble_result crumble_sim_get_def(crumble_sim sim, crumble_sim_def* def) {
  return with<Sim>(__func__, sim, [&](const Sim& s, const Call&) {
    write_struct("def", def, describe(s.simulation.definition(), s.has_floor));
    return CRUMBLE_OK;
  });
}

crumble_result crumble_sim_reset(crumble_sim sim) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call&) {
    if (s.recording) throw Error(Code::state, "a recording is running: end it first");
    s.simulation.reset();
    s.publish_now();
    return CRUMBLE_OK;
  });
}
