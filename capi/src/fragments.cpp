// What a host makes of fragments.
#include <cmath>
#include <string>

#include "arrays.hpp"
#include "defs.hpp"
#include "objects.hpp"
#include "record.hpp"

namespace crumble::capi {
namespace {

static_assert(std::uint32_t{CRUMBLE_FRAGMENT_ACTIVE} == static_cast<std::uint32_t>(FragmentState::active));
static_assert(std::uint32_t{CRUMBLE_FRAGMENT_ASLEEP} == static_cast<std::uint32_t>(FragmentState::asleep));
static_assert(std::uint32_t{CRUMBLE_FRAGMENT_REMOVED} == static_cast<std::uint32_t>(FragmentState::removed));

}  // namespace
}  // namespace crumble::capi

using namespace crumble;
using namespace crumble::capi;

crumble_result crumble_sim_set_fragment_state(crumble_sim sim, uint32_t fragment, uint32_t state) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call& call) -> crumble_result {
    require_at_most("state", state, CRUMBLE_FRAGMENT_REMOVED);
    s.simulation.set_fragment_state(fragment, static_cast<FragmentState>(state));
    return record(s, call, [&](Recording& recording) {
      recording.add_fragment_state(fragment, static_cast<FragmentState>(state));
    });
  });
}

crumble_result crumble_sim_get_fragment_state(crumble_sim sim, uint32_t fragment, uint32_t* state) {
  return with<Sim>(__func__, sim, [&](const Sim& s, const Call&) {
    require_pointer("state", state);
    *state = static_cast<uint32_t>(s.simulation.fragment_state(fragment));
    return CRUMBLE_OK;
  });
}

crumble_result crumble_sim_find_debris(crumble_sim sim, uint32_t max_nodes, double max_speed, crumble_view* fragments) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call&) {
    require_pointer("fragments", fragments);
    if (std::isnan(max_speed)) throw Error(Code::invalid_value, "max_speed is not a number");
    *fragments = view_of(s.simulation.find_debris({max_nodes, max_speed}));
    return CRUMBLE_OK;
  });
}

crumble_result crumble_sim_count_fragments(crumble_sim sim, uint32_t* count) {
  return with<Sim>(__func__, sim, [&](const Sim& s, const Call&) {
    require_pointer("count", count);
    *count = static_cast<uint32_t>(s.simulation.fragments().count());
    return CRUMBLE_OK;
  });
}

crumble_result crumble_sim_publish(crumble_sim sim) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call&) {
    s.publish_now();
    return CRUMBLE_OK;
  });
}
