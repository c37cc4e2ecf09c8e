// The local model: the same numbers, once as C and once as C++ keeps them.
#include "crumble/sim/local_model.hpp"

#include <algorithm>
#include <string>

#include "objects.hpp"
#include "rigid.hpp"

namespace crumble::capi {
namespace {

static_assert(CRUMBLE_LOCAL_CONTACTS == LocalModel::kListed);

void copy_matrix(const Mat3& m, double (&out)[9]) {
  for (int i = 0; i < 9; ++i) out[i] = m(i / 3, i % 3);
}
Mat3 to_matrix(const double (&m)[9]) {
  Mat3 out;
  for (int i = 0; i < 9; ++i) out(i / 3, i % 3) = m[i];
  return out;
}

void describe(const LocalModel& model, crumble_local_model& out) {
  out.at = to_c(model.at);
  out.wrench = to_c(model.wrench);
  std::copy(model.jacobian.begin(), model.jacobian.end(), out.jacobian);
  copy_matrix(model.stiffness, out.stiffness);
  out.radius = model.radius;
  out.held_drag = model.held_drag;
  out.fracture = model.fracture;
  out.contact_count = model.contacts;
  out.listed = model.listed;
  out.reserved = 0;
  out.rest = to_c(model.rest);
  std::copy(model.rest_jacobian.begin(), model.rest_jacobian.end(), out.rest_jacobian);
  copy_to(model.rest_normal, out.rest_normal);
  std::fill_n(out.contacts, CRUMBLE_LOCAL_CONTACTS, crumble_local_contact{});
  for (std::uint32_t k = 0; k < model.listed; ++k) {
    const LocalContact& from = model.contact[k];
    crumble_local_contact& to = out.contacts[k];
    copy_to(from.arm, to.arm);
    copy_to(from.normal, to.normal);
    copy_to(from.force, to.force);
    copy_to(from.inner, to.inner);
    copy_matrix(from.stiffness, to.stiffness);
    to.grip = from.grip;
  }
}

// As far as evaluate() reads it.
void from_c(const crumble_local_model& model, LocalModel& out) {
  out.at = to_pose(model.at);
  out.listed = model.listed;
  out.rest = to_wrench(model.rest);
  std::copy_n(model.rest_jacobian, out.rest_jacobian.size(), out.rest_jacobian.begin());
  out.rest_normal = to_vector(model.rest_normal);
  for (std::uint32_t k = 0; k < model.listed; ++k) {
    const crumble_local_contact& from = model.contacts[k];
    out.contact[k] = {to_vector(from.arm),   to_vector(from.normal),    to_vector(from.force),
                      to_vector(from.inner), to_matrix(from.stiffness), from.grip};
  }
}

void require_holder(const Sim& sim, std::uint32_t tool) {
  if (tool < sim.poses.size()) return;
  throw Error(Code::out_of_range,
              "tool is " + std::to_string(tool) + ", the simulation has " + std::to_string(sim.poses.size()));
}

}  // namespace
}  // namespace crumble::capi

using namespace crumble;
using namespace crumble::capi;

crumble_result crumble_sim_get_local_model(crumble_sim sim, uint32_t tool, crumble_local_model* model) {
  return with<Sim>(__func__, sim, [&](const Sim& s, const Call&) {
    require_pointer("model", model);
    require_holder(s, tool);
    describe(s.simulation.local_model(tool), *model);
    return CRUMBLE_OK;
  });
}

crumble_result crumble_sim_get_held_drag(crumble_sim sim, uint32_t tool, double* drag) {
  return with<Sim>(__func__, sim, [&](const Sim& s, const Call&) {
    require_pointer("drag", drag);
    require_holder(s, tool);
    *drag = s.simulation.held_drag(tool);
    return CRUMBLE_OK;
  });
}

crumble_result crumble_local_model_evaluate(const crumble_local_model* model, const crumble_pose* pose,
                                            crumble_wrench* wrench) {
  if (wrench) *wrench = crumble_wrench{};
  return guard(__func__, [&](const Call& call) -> crumble_result {
    if (!model) return call.fail(CRUMBLE_E_NULL, {"model must not be NULL"});
    if (!pose) return call.fail(CRUMBLE_E_NULL, {"pose must not be NULL"});
    if (!wrench) return call.fail(CRUMBLE_E_NULL, {"wrench must not be NULL"});
    if (model->listed > CRUMBLE_LOCAL_CONTACTS) {
      return call.fail(CRUMBLE_E_OUT_OF_RANGE, {"model.listed is ", model->listed, ", at most ",
                                                std::uint32_t{CRUMBLE_LOCAL_CONTACTS}, " contacts have room"});
    }
    if (!is_valid(to_pose(model->at))) return call.fail(CRUMBLE_E_BAD_POSE, {"model.at is no pose"});
    if (!is_valid(to_pose(*pose))) return call.fail(CRUMBLE_E_BAD_POSE, {"pose is no pose"});
    LocalModel copy;
    from_c(*model, copy);
    *wrench = to_c(evaluate(copy, to_pose(*pose)));
    return CRUMBLE_OK;
  });
}
