// A simulation's life and set-up.
#include <algorithm>
#include <string>

#include "crumble/base/text.hpp"
#include "defs.hpp"
#include "objects.hpp"
#include "sim_def.hpp"
#include "tool_def.hpp"

namespace crumble::capi {
namespace {

Wall make_floor() {
  return {{Vec3::UnitY(), 0}, {}};
}

void require_no_recording(const Sim& sim) {
  if (sim.recording) throw Error(Code::state, "a recording is running: end it first");
}

// Rebuilds the simulation with what `change(definition)` makes of its definition.
template <class Change>
void set_up(Sim& sim, Change&& change) {
  require_no_recording(sim);
  if (const auto steps = sim.simulation.info().step; steps != 0) {
    throw Error(Code::state, "the simulation has done " + std::to_string(steps) + " steps: reset it first");
  }
  sim.drop_closed_readers();
  if (!sim.readers.empty()) {
    throw Error(Code::in_use,
                "the simulation has " + std::to_string(sim.readers.size()) + " readers: destroy them first");
  }
  if (const std::uint32_t loops = sim.loops; loops > 0) {
    throw Error(Code::in_use, "the simulation has " + std::to_string(loops) + " loops: destroy them first");
  }
  SimulationDef def = sim.simulation.definition();
  change(def);
  sim.poses.reserve(def.tools.size() + def.attachments.size());
  Simulation next(std::move(def));
  sim.simulation = std::move(next);
  const SimulationDef& made = sim.simulation.definition();
  sim.poses.resize(made.tools.size() + made.attachments.size());
}

Vec3 read_vector(const char* name, const double* v) {
  require_pointer(name, v);
  for (int axis = 0; axis < 3; ++axis) require_finite(name + std::string(".") + "xyz"[axis], v[axis]);
  return {v[0], v[1], v[2]};
}

void fix_more(Sim& sim, const std::vector<std::uint32_t>& nodes) {
  set_up(sim, [&](SimulationDef& definition) {
    std::vector<std::uint32_t>& fixed = definition.fixed_nodes;
    fixed.insert(fixed.end(), nodes.begin(), nodes.end());
    std::sort(fixed.begin(), fixed.end());
    fixed.erase(std::unique(fixed.begin(), fixed.end()), fixed.end());
  });
}

}  // namespace
}  // namespace crumble::capi

using namespace crumble;
using namespace crumble::capi;

crumble_result crumble_sim_create(crumble_mesh mesh, const crumble_sim_def* def, crumble_sim* sim) {
  return guard(__func__, [&](const Call&) -> crumble_result {
    require_pointer("sim", sim);
    const crumble_sim_def given = def ? read_sim_def(def) : default_sim_def();
    std::shared_ptr<const TetMesh> body;
    const crumble_result result = with<Mesh>(__func__, mesh, [&](const Mesh& m, const Call&) {
      body = m.mesh;
      return CRUMBLE_OK;
    });
    if (result != CRUMBLE_OK) return result;
    SimulationDef definition;
    definition.mesh = *body;
    definition.walls.clear();
    if (given.floor) definition.walls.push_back(make_floor());
    apply(given, definition);
    auto object = std::make_unique<Sim>(std::move(body), std::move(definition));
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

crumble_result crumble_sim_configure(crumble_sim sim, const crumble_sim_def* def) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call&) {
    const crumble_sim_def given = read_sim_def(def);
    const bool floor = given.floor != 0;
    set_up(s, [&](SimulationDef& definition) {
      apply(given, definition);
      if (floor && !s.has_floor) definition.walls.insert(definition.walls.begin(), make_floor());
      if (!floor && s.has_floor) definition.walls.erase(definition.walls.begin());
    });
    s.has_floor = floor;
    return CRUMBLE_OK;
  });
}

crumble_result crumble_sim_add_tool(crumble_sim sim, const crumble_tool_def* def, uint32_t* index) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call&) {
    set_up(s, [&](SimulationDef& definition) { definition.tools.push_back(read_tool(def)); });
    if (index) *index = static_cast<uint32_t>(s.simulation.definition().tools.size() - 1);
    return CRUMBLE_OK;
  });
}

crumble_result crumble_sim_add_attachment(crumble_sim sim, const uint32_t* nodes, uint32_t count, uint32_t* index) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call&) {
    if (count > 0) require_pointer("nodes", nodes);
    require_at_most("count", count, static_cast<uint32_t>(s.mesh->node_count()));
    set_up(s, [&](SimulationDef& definition) { definition.attachments.push_back({{nodes, nodes + count}}); });
    if (index) *index = static_cast<uint32_t>(s.simulation.definition().attachments.size() - 1);
    return CRUMBLE_OK;
  });
}

crumble_result crumble_sim_add_wall(crumble_sim sim, const crumble_wall_def* def) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call&) {
    set_up(s, [&](SimulationDef& definition) { definition.walls.push_back(read_wall(def)); });
    return CRUMBLE_OK;
  });
}

crumble_result crumble_sim_fix_nodes(crumble_sim sim, const uint32_t* nodes, uint32_t count) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call&) {
    if (count > 0) require_pointer("nodes", nodes);
    require_at_most("count", count, static_cast<uint32_t>(s.mesh->node_count()));
    set_up(s, [&](SimulationDef& definition) { definition.fixed_nodes.assign(nodes, nodes + count); });
    return CRUMBLE_OK;
  });
}

crumble_result crumble_sim_fix_below(crumble_sim sim, double height) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call&) {
    require_finite("height", height);
    set_up(s, [&](SimulationDef& definition) { definition.fixed_nodes = nodes_below(*s.mesh, height); });
    return CRUMBLE_OK;
  });
}

crumble_result crumble_sim_fix_box(crumble_sim sim, const double* low, const double* high) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call&) {
    const Vec3 from = read_vector("low", low), to = read_vector("high", high);
    for (int axis = 0; axis < 3; ++axis) {
      if (from[axis] > to[axis]) {
        throw Error(Code::out_of_range, std::string("low.") + "xyz"[axis] + " " + to_text(from[axis]) +
                                            " must not be above high, " + to_text(to[axis]));
      }
    }
    fix_more(s, nodes_in_box(*s.mesh, from, to));
    return CRUMBLE_OK;
  });
}

crumble_result crumble_sim_fix_plane(crumble_sim sim, const double* normal, double offset) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call&) {
    const Wall plane{{read_vector("normal", normal), offset}, {}};
    check(plane);
    fix_more(s, nodes_behind(*s.mesh, plane.plane));
    return CRUMBLE_OK;
  });
}

crumble_result crumble_sim_apply_paper_preset(crumble_sim sim) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call&) {
    set_up(s, [](SimulationDef& definition) { apply_paper_preset(definition); });
    return CRUMBLE_OK;
  });
}

crumble_result crumble_sim_reset(crumble_sim sim) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call&) {
    require_no_recording(s);
    s.simulation.reset();
    s.publish_now();
    return CRUMBLE_OK;
  });
}
