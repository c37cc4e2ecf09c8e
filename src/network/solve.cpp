// Stage 3 of the step, read from solve() down.
#include <algorithm>
#include <cmath>
#include <utility>

#include "network/engine.hpp"

namespace crumble {

void filter_contact(NodeConstraint& c, const Vec3& force) noexcept {
  if (c.state == ContactState::attached) {
    c.reaction = -force;
    return;
  }
  const double pressing = -dot(force, c.normal);
  if (!(pressing > 0)) {
    c.state = ContactState::released;
    c.reaction = Vec3::Zero();
    return;
  }
  const Vec3 along = force + pressing * c.normal;
  const double tangential = norm(along);
  const double holding = c.state == ContactState::slip ? c.dynamic_friction : c.static_friction;
  if (tangential <= holding * pressing) {
    c.state = ContactState::stick;
    c.reaction = -force;
  } else {
    c.state = ContactState::slip;
    c.reaction = pressing * c.normal - (c.dynamic_friction * pressing / tangential) * along;
  }
}

namespace {

// Eqs (3) and (4) along the surface: where a node that slides under `reaction` gets to.
void slide(const StepCoefficients& c, const NodeConstraint& held, const Vec3& force, Vec3& position, Vec3& velocity) {
  const Vec3 net = force + held.reaction;  // tangential
  const double across = dot(velocity, held.normal);
  const Vec3 sliding = velocity - across * held.normal;
  position += c.drift[held.node] * sliding + c.force_gain[held.node] * net;
  velocity = (c.decay[held.node] * sliding + c.velocity_gain[held.node] * net) + across * held.normal;
}

// Friction opposes sliding past the surface, which is not always the way the springs pull: a surface that moves that
// way too, faster than the node could slide, carries the node (it sticks, at the edge of the cone), and one that is
// faster still drags it on.
void oppose_sliding(const StepCoefficients& c, NodeConstraint& held, const Vec3& force, const Vec3& velocity) {
  const double pressing = -dot(force, held.normal);
  const Vec3 along = normalized(force + pressing * held.normal);
  const double friction = held.dynamic_friction * pressing;
  const double surface = c.substep * dot(held.velocity, along);
  const double loose = c.drift[held.node] * dot(velocity, along) + c.force_gain[held.node] * dot(force, along);
  const double reach = c.force_gain[held.node] * friction;
  if (loose - reach >= surface) return;
  if (loose + reach <= surface) {
    held.reaction = pressing * held.normal + friction * along;
  } else {
    held.state = ContactState::stick;
  }
}

}  // namespace

template <class Real>
void Engine<Real>::solve(std::span<NodeConstraint> constraints) noexcept {
  if (fixed_->spring_damping > 0) damp_springs(constraints);
  in_partitions(&Engine::sum_forces);  // Eq (5)
  collect_overlong();

  const bool loose = !frames_.empty();
  holder_work_ = 0;
  if (loose) in_partitions(&Engine::join_forces), find_frames();

  // where the held nodes go is worked out before the others move, and written after
  for (std::size_t k = 0; k < constraints.size(); ++k) hold(constraints[k], held_[k]);

  if (loose) enter_frames();
  in_partitions(loose ? &Engine::move : &Engine::join_and_move);  // Eqs (3) and (4)
  if (loose) leave_frames();
  for (std::size_t k = 0; k < constraints.size(); ++k) {
    const NodeConstraint& c = constraints[k];
    if (c.state == ContactState::released) continue;
    if (c.state == ContactState::slip && is_loose(c.node)) slide_along(c, held_[k]);
    place(c.node, held_[k].position, held_[k].velocity);
  }
}

template <class Real>
void Engine<Real>::hold(NodeConstraint& c, Held& next) noexcept {
  const StepCoefficients& coefficients = fixed_->coefficients;
  const Vec3 force = force_at(layout_->slot_of[c.node]);
  next = {position(c.node), velocity(c.node)};
  if (is_loose(c.node)) return hold_loose(c, force, next);
  filter_contact(c, force);
  if (c.state == ContactState::slip) oppose_sliding(coefficients, c, force, next.velocity);
  if (c.state == ContactState::slip) slide(coefficients, c, force, next.position, next.velocity);
}

template <class Real>
void Engine<Real>::in_partitions(void (Engine::*task)(std::uint32_t) noexcept) noexcept {
  const auto count = static_cast<std::uint32_t>(layout_->partitions.size());
  if (!team_) {
    for (std::uint32_t p = 0; p < count; ++p) (this->*task)(p);
    return;
  }
  struct Call {
    Engine* engine;
    void (Engine::*task)(std::uint32_t) noexcept;
  } call{this, task};
  team_->run(
      count,
      [](void* data, std::uint32_t p) {
        const Call& c = *static_cast<Call*>(data);
        (c.engine->*c.task)(p);
      },
      &call);
}

// Springs of one partition onto its own slots and its halo.
template <class Real>
void Engine<Real>::sum_forces(std::uint32_t p) noexcept {
  const Partition& part = layout_->partitions[p];
  const std::uint32_t shift = layout_->shift(p);
  const auto& kernel = kernel_of<Real>(*kernels_);
  std::uint32_t* const found = overlong_.data() + first_overlong(p);
  ForcePass<Real> pass{std::span(layout_->segments).subspan(part.first_segment, part.end_segment - part.first_segment),
                       layout_->offsets.data(),
                       fixed_->ways.data(),
                       plain_.data(),
                       fixed_->present.data(),
                       std::span(layout_->batches).subspan(part.first_batch, part.end_batch - part.first_batch),
                       stiffness_.data(),
                       rest_force_.data(),
                       layout_->batch_lanes + part.first_batch * kLanes,
                       std::as_const(at_).from(),
                       packed_.data(),
                       force_.from(shift),
                       packed_force_.data() + 4 * std::size_t{shift},
                       fixed_->give,
                       fixed_->cut_share,
                       whole_.data(),
                       found};
  overlong_of_[p] = kernel.sum_segments(pass);
  pass.overlong += overlong_of_[p];
  overlong_of_[p] += kernel.sum_batches(pass);
}

// Where a partition's lanes may be listed: behind those of the partitions before it.
template <class Real>
std::size_t Engine<Real>::first_overlong(std::uint32_t p) const noexcept {
  const Partition& part = layout_->partitions[p];
  const bool any = part.first_segment < layout_->segments.size();
  return (any ? layout_->segments[part.first_segment].lane : layout_->batch_lanes) + part.first_batch * kLanes;
}

template <class Real>
void Engine<Real>::collect_overlong() noexcept {
  overlong_count_ = 0;
  for (std::uint32_t p = 0; p < layout_->partitions.size(); ++p) {
    const std::size_t first = first_overlong(p);
    for (std::size_t k = 0; k < overlong_of_[p]; ++k) {
      overlong_[overlong_count_++] = layout_->spring_of_lane[overlong_[first + k]];
    }
  }
  std::sort(overlong_.begin(), overlong_.begin() + static_cast<std::ptrdiff_t>(overlong_count_));
}

template <class Real>
void Engine<Real>::find_overlong(double length_limit) noexcept {
  overlong_count_ = 0;
  for (std::uint32_t s = 0; s < fixed_->springs.size(); ++s) {
    const auto [a, b] = fixed_->springs[s];
    const double limit = length_limit * fixed_->rest_lengths[s];
    if (squared_norm(position(b) - position(a)) > limit * limit && whole_[layout_->lane_of_spring[s]]) {
      overlong_[overlong_count_++] = s;
    }
  }
}

// (segments + batches) of the partition, then what the one before left in its halo.
template <class Real>
void Engine<Real>::join_forces(std::uint32_t p) noexcept {
  const auto& kernel = kernel_of<Real>(*kernels_);
  const auto unpack = [&](std::span<const std::uint32_t> groups, std::uint32_t of) {
    const std::uint32_t shift = layout_->shift(of);
    kernel.unpack(groups, packed_force_.data() + 4 * std::size_t{shift}, force_.from(shift));
  };
  unpack(layout_->partitions[p].own_groups, p);
  if (p == 0) return;
  unpack(layout_->partitions[p - 1].halo_groups, p - 1);
  const std::uint32_t first = layout_->partitions[p].first, own = layout_->shift(p), halo = layout_->shift(p - 1);
  for (std::size_t a = 0; a < 3; ++a) {
    Real* force = force_.axis(a).data();
    for (std::uint32_t slot = first; slot < first + layout_->halo; ++slot) {
      force[slot + own] += force[slot + halo];
      force[slot + halo] = 0;
    }
  }
}

template <class Real>
std::uint32_t Engine<Real>::partition_of(std::uint32_t slot) const noexcept {
  std::uint32_t p = 0;
  while (layout_->partitions[p].end <= slot) ++p;
  return p;
}

// The sum that join_forces will come to, or has come to.
template <class Real>
Vec3 Engine<Real>::force_at(std::uint32_t slot) const noexcept {
  const std::uint32_t p = partition_of(slot);
  const auto sum = [&](std::size_t axis) {
    const auto of = [&](std::uint32_t partition) {
      const std::size_t at = slot + layout_->shift(partition);
      return force_.axis(axis)[at] + packed_force_[4 * at + axis];
    };
    const bool in_halo = p > 0 && slot < layout_->partitions[p].first + layout_->halo;
    return double{in_halo ? of(p) + of(p - 1) : of(p)};
  };
  return {sum(0), sum(1), sum(2)};
}

template <class Real>
void Engine<Real>::join_and_move(std::uint32_t p) noexcept {
  join_forces(p);
  move(p);
}

template <class Real>
void Engine<Real>::move(std::uint32_t p) noexcept {
  const Partition& part = layout_->partitions[p];
  const auto& kernel = kernel_of<Real>(*kernels_);
  lost_of_[p] = kernel.move({part.first, part.end, at_.from(), rest_of_at_.from(), velocity_.from(),
                             force_.from(layout_->shift(p)), std::as_const(external_).from(), gains_.drift.data(),
                             gains_.force.data(), gains_.decay.data(), gains_.velocity.data(), bounds_.data()});
  kernel.pack(part.own_groups, std::as_const(at_).from(), packed_.data());
}

template <class Real>
std::span<const std::uint32_t> Engine<Real>::inside(const Vec3& low, const Vec3& high) noexcept {
  SearchPass<Real> pass{
      static_cast<std::uint32_t>(node_count()), std::as_const(at_).from(), bounds_.data(), {}, found_.data()};
  // the searched coordinate is the high part, and the box is rounded too
  constexpr double kRounding = kHasRest ? 2 * std::numeric_limits<Real>::epsilon() : 0;
  for (int axis = 0; axis < 3; ++axis) {
    pass.box.low[axis] = static_cast<Real>(low[axis] - kRounding * std::abs(low[axis]));
    pass.box.high[axis] = static_cast<Real>(high[axis] + kRounding * std::abs(high[axis]));
  }
  return nodes_of_found(kernel_of<Real>(*kernels_).search(pass));
}

template <class Real>
std::span<const std::uint32_t> Engine<Real>::nodes_of_found(std::size_t count) noexcept {
  for (std::size_t k = 0; k < count; ++k) found_[k] = layout_->node_of[found_[k]];
  return {found_.data(), count};
}

template <class Real>
std::span<const std::uint32_t> Engine<Real>::behind(const Plane& plane) noexcept {
  constexpr double kFar = 2 * kWorld;
  Vec3 low = Vec3::Constant(-kFar), high = Vec3::Constant(kFar);
  for (int axis = 0; axis < 3; ++axis) {  // a wall along the axes is a box without end
    if (plane.normal[axis] == 1) return high[axis] = plane.offset, inside(low, high);
    if (plane.normal[axis] == -1) return low[axis] = -plane.offset, inside(low, high);
  }
  constexpr double kMargin = 2e-4;  // more than a float coordinate is rounded by anywhere in the world
  std::size_t count = 0;
  for (std::size_t block = 0; block * kBlockSlots < node_count(); ++block) {
    const Bounds<Real>& b = bounds_[block];
    Vec3 deepest;
    for (int axis = 0; axis < 3; ++axis) deepest[axis] = plane.normal[axis] > 0 ? b.low[axis] : b.high[axis];
    if (dot(plane.normal, deepest) >= plane.offset + kMargin) continue;
    const std::size_t end = std::min((block + 1) * kBlockSlots, node_count());
    for (std::size_t slot = block * kBlockSlots; slot < end; ++slot) {
      if (dot(plane.normal, load(slot)) < plane.offset) found_[count++] = static_cast<std::uint32_t>(slot);
    }
  }
  return nodes_of_found(count);
}

template class Engine<float>;
template class Engine<double>;

}  // namespace crumble
