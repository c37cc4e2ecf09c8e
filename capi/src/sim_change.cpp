// What a simulation is, said before its first step or changed in mid-run.
#include "sim_change.hpp"

#include <algorithm>
#include <string>

#include "crumble/base/text.hpp"
#include "crumble/sim/change.hpp"
#include "defs.hpp"
#include "record.hpp"
#include "sim_def.hpp"
#include "tool_def.hpp"

namespace crumble::capi {

Wall make_floor() {
  return {{Vec3::UnitY(), 0}, {}};
}

void configure(const crumble_sim_def& given, bool& has_floor, SimulationDef& definition) {
  const bool floor = given.floor != 0;
  apply(given, definition);
  if (floor && !has_floor) definition.walls.insert(definition.walls.begin(), make_floor());
  if (!floor && has_floor) definition.walls.erase(definition.walls.begin());
  has_floor = floor;
}

void set_tool(std::uint32_t tool, Tool to, SimulationDef& definition) {
  require_index("tool", tool, definition.tools.size());
  definition.tools[tool] = std::move(to);
}

void set_friction(std::uint32_t tool, const Friction& friction, SimulationDef& definition) {
  require_index("tool", tool, definition.tools.size());
  check(friction);
  definition.tools[tool].friction = friction;
}

void require_index(const char* field, std::uint32_t index, std::size_t count) {
  if (index < count) return;
  throw Error(Code::out_of_range,
              std::string(field) + " is " + std::to_string(index) + ", there are " + std::to_string(count));
}

crumble_result alter(Sim& sim, const Call& call, const EditDefinition& edit) {
  sim.drop_closed_readers();
  const bool is_new = sim.simulation.info().step == 0 && !sim.recording && sim.readers.empty() && sim.loops == 0;
  SimulationDef def = sim.simulation.definition();
  edit(def);
  if (is_new) {
    sim.build(std::move(def));
    return CRUMBLE_OK;
  }
  DefinitionChange change(sim.simulation.definition(), std::move(def));
  Vector<std::uint8_t> settings = Recording::settings_of(change.definition());
  change.apply_to(sim.simulation);
  return record(sim, call, [&](Recording& recording) { recording.add_change(std::move(settings)); });
}

namespace {

// What only a simulation can get that nobody has stepped, or looks at.
void require_new(const Sim& sim) {
  if (sim.recording) throw Error(Code::state, "a recording is running: end it first");
  if (const auto steps = sim.simulation.info().step; steps != 0) {
    throw Error(Code::state, "the simulation has done " + std::to_string(steps) + " steps: reset it first");
  }
  const auto readers =
      std::count_if(sim.readers.begin(), sim.readers.end(), [](const auto& r) { return r->is_open.load(); });
  if (readers > 0) {
    throw Error(Code::in_use, "the simulation has " + std::to_string(readers) + " readers: destroy them first");
  }
  if (const std::uint32_t loops = sim.loops; loops > 0) {
    throw Error(Code::in_use, "the simulation has " + std::to_string(loops) + " loops: destroy them first");
  }
}

Vec3 read_vector(const char* name, const double* v) {
  require_pointer(name, v);
  for (int axis = 0; axis < 3; ++axis) require_finite(name + std::string(".") + "xyz"[axis], v[axis]);
  return {v[0], v[1], v[2]};
}

crumble_result fix_more(Sim& sim, const Call& call, const Vector<std::uint32_t>& nodes) {
  return alter(sim, call, [&](SimulationDef& definition) {
    Vector<std::uint32_t>& fixed = definition.fixed_nodes;
    fixed.insert(fixed.end(), nodes.begin(), nodes.end());
    std::sort(fixed.begin(), fixed.end());
    fixed.erase(std::unique(fixed.begin(), fixed.end()), fixed.end());
  });
}

}  // namespace
}  // namespace crumble::capi

using namespace crumble;
using namespace crumble::capi;

crumble_result crumble_sim_configure(crumble_sim sim, const crumble_sim_def* def) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call& call) {
    const crumble_sim_def given = read_sim_def(def);
    bool has_floor = s.has_floor;
    const crumble_result result =
        alter(s, call, [&](SimulationDef& definition) { configure(given, has_floor, definition); });
    s.has_floor = has_floor;
    return result;
  });
}

crumble_result crumble_sim_add_tool(crumble_sim sim, const crumble_tool_def* def, uint32_t* index) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call& call) {
    require_new(s);
    const crumble_result result =
        alter(s, call, [&](SimulationDef& definition) { definition.tools.push_back(read_tool(def)); });
    if (index) *index = static_cast<uint32_t>(s.simulation.definition().tools.size() - 1);
    return result;
  });
}

crumble_result crumble_sim_set_tool(crumble_sim sim, uint32_t tool, const crumble_tool_def* def) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call& call) {
    return alter(s, call, [&](SimulationDef& definition) { set_tool(tool, read_tool(def), definition); });
  });
}

crumble_result crumble_sim_set_friction(crumble_sim sim, uint32_t tool, double static_friction,
                                        double dynamic_friction) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call& call) {
    return alter(s, call, [&](SimulationDef& definition) {
      set_friction(tool, {static_friction, dynamic_friction}, definition);
    });
  });
}

crumble_result crumble_sim_add_attachment(crumble_sim sim, const uint32_t* nodes, uint32_t count, uint32_t* index) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call& call) {
    require_new(s);
    if (count > 0) require_pointer("nodes", nodes);
    require_at_most("count", count, static_cast<uint32_t>(s.mesh->node_count()));
    const crumble_result result = alter(s, call, [&](SimulationDef& definition) {
      definition.attachments.push_back({{nodes, nodes + count}});
    });
    if (index) *index = static_cast<uint32_t>(s.simulation.definition().attachments.size() - 1);
    return result;
  });
}

crumble_result crumble_sim_add_wall(crumble_sim sim, const crumble_wall_def* def) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call& call) {
    return alter(s, call, [&](SimulationDef& definition) { definition.walls.push_back(read_wall(def)); });
  });
}

crumble_result crumble_sim_set_wall(crumble_sim sim, uint32_t wall, const crumble_wall_def* def) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call& call) {
    return alter(s, call, [&](SimulationDef& definition) {
      require_index("wall", wall, definition.walls.size());
      definition.walls[wall] = read_wall(def);
    });
  });
}

crumble_result crumble_sim_fix_nodes(crumble_sim sim, const uint32_t* nodes, uint32_t count) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call& call) {
    if (count > 0) require_pointer("nodes", nodes);
    require_at_most("count", count, static_cast<uint32_t>(s.mesh->node_count()));
    return alter(s, call, [&](SimulationDef& definition) { definition.fixed_nodes.assign(nodes, nodes + count); });
  });
}

crumble_result crumble_sim_fix_below(crumble_sim sim, double height) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call& call) {
    require_finite("height", height);
    return alter(s, call, [&](SimulationDef& definition) { definition.fixed_nodes = nodes_below(*s.mesh, height); });
  });
}

crumble_result crumble_sim_fix_box(crumble_sim sim, const double* low, const double* high) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call& call) {
    const Vec3 from = read_vector("low", low), to = read_vector("high", high);
    for (int axis = 0; axis < 3; ++axis) {
      if (from[axis] > to[axis]) {
        throw Error(Code::out_of_range, std::string("low.") + "xyz"[axis] + " " + to_text(from[axis]) +
                                            " must not be above high, " + to_text(to[axis]));
      }
    }
    return fix_more(s, call, nodes_in_box(*s.mesh, from, to));
  });
}

crumble_result crumble_sim_fix_plane(crumble_sim sim, const double* normal, double offset) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call& call) {
    const Wall plane{{read_vector("normal", normal), offset}, {}};
    check(plane);
    return fix_more(s, call, nodes_behind(*s.mesh, plane.plane));
  });
}

crumble_result crumble_sim_apply_paper_preset(crumble_sim sim) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call& call) {
    return alter(s, call, [](SimulationDef& definition) { apply_paper_preset(definition); });
  });
}
