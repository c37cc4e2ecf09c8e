// What a simulation is, changed while a loop has it.
#include "loop.hpp"
#include "sim_change.hpp"
#include "sim_def.hpp"
#include "tool_def.hpp"

using namespace crumble;
using namespace crumble::capi;

crumble_result crumble_loop_configure(crumble_loop loop, const crumble_sim_def* def) {
  return look<Loop>(__func__, loop, [&](Loop& l, const Call& call) {
    const crumble_sim_def given = read_sim_def(def);
    return l.change("crumble_loop_configure", call,
                    [&](SimulationDef& definition, Sim& sim) { configure(given, sim.has_floor, definition); });
  });
}

crumble_result crumble_loop_set_tool(crumble_loop loop, uint32_t tool, const crumble_tool_def* def) {
  return look<Loop>(__func__, loop, [&](Loop& l, const Call& call) {
    return l.change("crumble_loop_set_tool", call,
                    [&](SimulationDef& definition, Sim&) { set_tool(tool, read_tool(def), definition); });
  });
}

crumble_result crumble_loop_set_friction(crumble_loop loop, uint32_t tool, double static_friction,
                                         double dynamic_friction) {
  return look<Loop>(__func__, loop, [&](Loop& l, const Call& call) {
    return l.change("crumble_loop_set_friction", call, [&](SimulationDef& definition, Sim&) {
      set_friction(tool, {static_friction, dynamic_friction}, definition);
    });
  });
}
