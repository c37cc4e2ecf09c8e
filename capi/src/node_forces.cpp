// Forces that the host puts on nodes.
#include "defs.hpp"
#include "objects.hpp"
#include "record.hpp"
#include "rigid.hpp"

using namespace crumble;
using namespace crumble::capi;

crumble_result crumble_sim_set_node_force(crumble_sim sim, uint32_t node, const double* force) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call& call) -> crumble_result {
    require_pointer("force", force);
    const Vec3 given(force[0], force[1], force[2]);
    s.simulation.set_node_force(node, given);
    return record(s, call, [&](Recording& recording) { recording.add_node_force(node, given); });
  });
}

crumble_result crumble_sim_set_node_forces(crumble_sim sim, const double* forces, uint32_t count) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call& call) -> crumble_result {
    const auto nodes = static_cast<uint32_t>(s.mesh->node_count());
    if (count > 0) require_pointer("forces", forces);
    if (count != nodes && count != 0) {
      return call.fail(CRUMBLE_E_OUT_OF_RANGE, {"count is ", count, ", the body has ", nodes, " nodes"});
    }
    VecArray given(nodes);
    for (std::size_t node = 0; node < count; ++node) {
      given.set(node, {forces[3 * node], forces[3 * node + 1], forces[3 * node + 2]});
    }
    VecArray before(nodes);
    for (std::size_t node = 0; node < nodes; ++node) before.set(node, s.simulation.node_forces()[node]);
    s.simulation.set_node_forces(given);
    return record(s, call, [&](Recording& recording) {
      for (uint32_t node = 0; node < nodes; ++node) {
        if (given[node] != before[node]) recording.add_node_force(node, given[node]);
      }
    });
  });
}
