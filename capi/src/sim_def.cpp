#include "sim_def.hpp"

#include "defs.hpp"
#include "field_names.hpp"
#include "kernels.hpp"

namespace crumble::capi {

namespace {

void check_ball_friction(const Friction& friction) {
  try {
    check(friction);
  } catch (const Error& error) {
    throw Error(error.code(), "ball_" + in_names_of_c(error.what()));
  }
}

}  // namespace

crumble_sim_def default_sim_def() {
  static const crumble_sim_def kDefaults = describe(SimulationDef{}, true);  // which takes memory
  return kDefaults;
}

crumble_sim_def read_sim_def(const crumble_sim_def* def) {
  const crumble_sim_def given = read_def("def", def, default_sim_def());
  require_at_most("floor", given.floor, 1);
  require_at_most("mass_rule", given.mass_rule, CRUMBLE_MASS_EQUAL);
  require_at_most("time_step_policy", given.time_step_policy, CRUMBLE_POLICY_UNCHECKED);
  require_at_most("contact_rule", given.contact_rule, CRUMBLE_CONTACT_ALONG_MOTION);
  require_at_most("mean_force", given.mean_force, 1);
  require_at_most("reserved", given.reserved, 0);
  require_at_most("precision", given.precision, CRUMBLE_PRECISION_FLOAT32);
  require_at_most("cut_test", given.cut_test, CRUMBLE_CUT_TEST_AFTER_MOVE);
  require_at_most("drag_frame", given.drag_frame, CRUMBLE_DRAG_ROOM);
  require_at_most("surface_samples", given.surface_samples, 1);
  require_at_most("ball_contact", given.ball_contact, 1);
  require_at_most("energy_audit", given.energy_audit, 1);
  require_at_most("reserved_2", given.reserved_2, 0);
  check_ball_friction({given.ball_static_friction, given.ball_dynamic_friction});
  return given;
}

void apply(const crumble_sim_def& from, SimulationDef& to) {
  to.gravity = {from.gravity[0], from.gravity[1], from.gravity[2]};
  to.material.stiffness = from.stiffness;
  to.material.damping_ratio = from.damping_ratio;
  to.material.length_limit = from.length_limit;
  to.material.mass = from.mass;
  to.mass_rule = static_cast<MassRule>(from.mass_rule);
  to.step.policy = static_cast<TimeStepPolicy>(from.time_step_policy);
  to.step.tau = from.tau;
  to.step.iterations = from.iterations;
  to.step.contact_rule = static_cast<ContactRule>(from.contact_rule);
  to.step.cut_fade = from.cut_fade;
  to.step.mean_force = from.mean_force != 0;
  to.step.precision = static_cast<Precision>(from.precision);
  to.step.kernel = from.kernel ? from.kernel : "";
  to.step.threads = from.threads;
  to.step.host_threads = {from.host_threads, from.host_context};
  to.step.cut_test = static_cast<CutTest>(from.cut_test);
  to.step.drag_frame = static_cast<DragFrame>(from.drag_frame);
  to.step.surface_samples = from.surface_samples != 0;
  to.step.ball_contact = from.ball_contact != 0;
  to.ball_friction = {from.ball_static_friction, from.ball_dynamic_friction};
  to.material.spring_damping = from.spring_damping;
  to.step.energy_audit = from.energy_audit != 0;
}

crumble_sim_def describe(const SimulationDef& def, bool has_floor) {
  crumble_sim_def out{};
  out.struct_size = sizeof out;
  out.floor = has_floor;
  for (int axis = 0; axis < 3; ++axis) out.gravity[axis] = def.gravity[axis];
  out.stiffness = def.material.stiffness;
  out.damping_ratio = def.material.damping_ratio;
  out.length_limit = def.material.length_limit;
  out.mass = def.material.mass;
  out.mass_rule = static_cast<std::uint32_t>(def.mass_rule);
  out.time_step_policy = static_cast<std::uint32_t>(def.step.policy);
  out.tau = def.step.tau;
  out.iterations = def.step.iterations;
  out.contact_rule = static_cast<std::uint32_t>(def.step.contact_rule);
  out.cut_fade = def.step.cut_fade;
  out.mean_force = def.step.mean_force;
  out.precision = static_cast<std::uint32_t>(def.step.precision);
  out.threads = def.step.threads;
  if (!def.step.kernel.empty()) out.kernel = crumble_kernel_name(kernel_number(def.step.kernel));
  out.host_threads = def.step.host_threads.run;
  out.host_context = def.step.host_threads.context;
  out.cut_test = static_cast<std::uint32_t>(def.step.cut_test);
  out.drag_frame = static_cast<std::uint32_t>(def.step.drag_frame);
  out.surface_samples = def.step.surface_samples;
  out.ball_contact = def.step.ball_contact;
  out.ball_static_friction = def.ball_friction.static_coefficient;
  out.ball_dynamic_friction = def.ball_friction.dynamic_coefficient;
  out.spring_damping = def.material.spring_damping;
  out.energy_audit = def.step.energy_audit;
  return out;
}

}  // namespace crumble::capi

using namespace crumble::capi;

crumble_result crumble_sim_def_init(crumble_sim_def* def, uint32_t struct_size) {
  return guard(__func__, [&](const Call&) {
    write_struct("def", def, struct_size, default_sim_def());
    return CRUMBLE_OK;
  });
}
