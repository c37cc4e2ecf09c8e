// Who holds which node, one by one.
#include "arrays.hpp"
#include "objects.hpp"
#include "rigid.hpp"

namespace crumble::capi {
namespace {

static_assert(std::uint32_t{CRUMBLE_HELD_FRESH} == static_cast<std::uint32_t>(ContactState::fresh));
static_assert(std::uint32_t{CRUMBLE_HELD_STICKING} == static_cast<std::uint32_t>(ContactState::stick));
static_assert(std::uint32_t{CRUMBLE_HELD_SLIDING} == static_cast<std::uint32_t>(ContactState::slip));
static_assert(std::uint32_t{CRUMBLE_HELD_ATTACHED} == static_cast<std::uint32_t>(ContactState::attached));
static_assert(CRUMBLE_NONE == kWorldHolder);

crumble_contact describe(const NodeConstraint& held) {
  crumble_contact out{};
  out.node = held.node;
  out.holder = held.holder;
  out.state = static_cast<std::uint32_t>(held.state);
  copy_to(held.point, out.point);
  copy_to(held.normal, out.normal);
  copy_to(held.reaction, out.reaction);
  return out;
}

}  // namespace
}  // namespace crumble::capi

using namespace crumble;
using namespace crumble::capi;

crumble_result crumble_sim_get_contacts(crumble_sim sim, crumble_contact* contacts, uint32_t capacity,
                                        uint32_t* count) {
  return with<Sim>(__func__, sim, [&](const Sim& s, const Call& call) -> crumble_result {
    require_pointer("count", count);
    const std::span<const NodeConstraint> held = s.simulation.contacts();
    const auto there = static_cast<uint32_t>(held.size());
    *count = there;
    if (!contacts) return CRUMBLE_OK;
    if (capacity < there) {
      return call.fail(CRUMBLE_E_BUFFER_TOO_SMALL, {"capacity is ", capacity, ", needed are ", there});
    }
    for (uint32_t k = 0; k < there; ++k) contacts[k] = describe(held[k]);
    return CRUMBLE_OK;
  });
}
