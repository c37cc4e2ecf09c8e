// What solve() does for loose bodies and for dampers along springs.
#include <algorithm>
#include <cmath>

#include "crumble/base/memory.hpp"
#include "network/engine.hpp"

namespace crumble {

// The dampers of the paper's Fig 2f, one spring after the other, each exactly: what two free masses lose of their speed
// along the spring in a substep, m v' = -/+ b (v_j - v_i).e. That takes momentum from neither and energy from both. A
// held node's speed is its holder's and stays.
template <class Real>
void Engine<Real>::damp_springs(std::span<const NodeConstraint> constraints) noexcept {
  for (const NodeConstraint& c : constraints) is_held_[c.node] = 1;
  const auto moves = [&](std::uint32_t node) { return !is_held_[node] && gains_.force[layout_->slot_of[node]] > 0; };
  for (std::uint32_t s = 0; s < fixed_->springs.size(); ++s) {
    if (!whole_[layout_->lane_of_spring[s]]) continue;
    const auto [i, j] = fixed_->springs[s];
    const double light_i = moves(i) ? 1 / fixed_->masses[i] : 0, light_j = moves(j) ? 1 / fixed_->masses[j] : 0;
    if (light_i + light_j == 0) continue;
    const Vec3 way = position(j) - position(i);
    const double length = norm(way);
    if (!(length > 0)) continue;
    const Vec3 along = way / length;
    const double keep = (light_i > 0 ? fixed_->damped[i] : 1) * (light_j > 0 ? fixed_->damped[j] : 1);
    const double lost = (1 - keep) * dot(velocity(j) - velocity(i), along) / (light_i + light_j);
    velocity_.set(layout_->slot_of[i], velocity(i) + (light_i * lost) * along);
    velocity_.set(layout_->slot_of[j], velocity(j) - (light_j * lost) * along);
  }
  for (const NodeConstraint& c : constraints) is_held_[c.node] = 0;
}

template <class Real>
void Engine<Real>::set_loose(const NodeGroups& groups) noexcept {
  frames_.set(groups);
  const std::span<const std::uint32_t> nodes = frames_.nodes();
  const auto spare_slot = static_cast<std::uint32_t>(node_count() + kPadding - 1);  // behind the last node
  for (std::size_t place = 0; place < nodes.size(); ++place) {
    const bool pads = nodes[place] == RigidFrames::kNoNode;
    loose_slots_[place] = pads ? spare_slot : layout_->slot_of[nodes[place]];
    loose_forces_[place] = pads ? static_cast<std::uint32_t>(force_.size() - 1)
                                : loose_slots_[place] + layout_->shift(partition_of(loose_slots_[place]));
  }
}

namespace {

Vector<double>& axis_of(VecArray& array, std::size_t axis) {
  return axis == 0 ? array.x : axis == 1 ? array.y : array.z;
}

}  // namespace

// One axis at a time, without a branch: these copies cost as much as the sums.
template <class Real>
void Engine<Real>::read_frames() noexcept {
  const std::size_t count = frames_.nodes().size();
  for (std::size_t a = 0; a < 3; ++a) {
    const Real *at = at_.axis(a).data(), *velocity = velocity_.axis(a).data();
    double *to = axis_of(frames_.positions, a).data(), *speed = axis_of(frames_.velocities, a).data();
    for (std::size_t place = 0; place < count; ++place) {
      to[place] = double{at[loose_slots_[place]]};
      speed[place] = double{velocity[loose_slots_[place]]};
    }
    if constexpr (kHasRest) {
      const Real* rest = rest_of_at_.axis(a).data();
      for (std::size_t place = 0; place < count; ++place) to[place] += double{rest[loose_slots_[place]]};
    }
  }
}

template <class Real>
void Engine<Real>::find_frames() noexcept {
  read_frames();
  const std::size_t count = frames_.nodes().size();
  for (std::size_t a = 0; a < 3; ++a) {
    const Real* force = force_.axis(a).data();
    double* to = axis_of(frames_.forces, a).data();
    for (std::size_t place = 0; place < count; ++place) to[place] = double{force[loose_forces_[place]]};
  }
  frames_.find_motions();
}

// Friction and release see the drag of a node that has to leave its fragment's motion for its holder's, and the
// fragment is braked by it; the force that is reported is that of the springs, as everywhere.
template <class Real>
void Engine<Real>::hold_loose(NodeConstraint& c, const Vec3& force, Held& next) noexcept {
  const std::uint32_t place = frames_.place_of(c.node);
  const double drag = fixed_->coefficients.drags[c.node];
  const Vec3 rigid = frames_.rigid_velocity(place);
  const Vec3 all = force + drag * (rigid - c.velocity);
  filter_contact(c, all);
  if (c.state == ContactState::released) return;
  if (c.state != ContactState::slip) {
    frames_.brake(place, drag, c.velocity, Vec3::Zero());
    frames_.add_force(place, -force);
    c.reaction = -force;
    return;
  }
  const double pressing = -dot(all, c.normal), held = std::max(-dot(force, c.normal), 0.0);
  const Vec3 friction = c.reaction - pressing * c.normal;
  // A share of the drag is what friction holds: it is taken at the end of the step, lest it turn the body back.
  const double share = norm(friction) / norm(all + pressing * c.normal);
  frames_.brake(place, share * drag, rigid + dot(c.velocity - rigid, c.normal) * c.normal, Vec3::Zero());
  frames_.brake(place, (1 - share) * drag, c.velocity, c.normal);
  frames_.add_force(place, friction - dot(force, c.normal) * c.normal);
  c.reaction = held * c.normal + (held / pressing) * friction;
  next.unreported = (1 - held / pressing) * friction;
}

template <class Real>
void Engine<Real>::enter_frames() noexcept {
  frames_.split(fixed_->coefficients.substep);
  holder_work_ = frames_.brake_work();
  const std::size_t count = frames_.nodes().size();
  for (std::size_t a = 0; a < 3; ++a) {
    Real *velocity = velocity_.axis(a).data(), *force = force_.axis(a).data();
    const double *speed = axis_of(frames_.velocities, a).data(), *rest = axis_of(frames_.forces, a).data();
    for (std::size_t place = 0; place < count; ++place) {
      velocity[loose_slots_[place]] = static_cast<Real>(speed[place]);
      force[loose_forces_[place]] = static_cast<Real>(rest[place]);
    }
  }
}

template <class Real>
void Engine<Real>::leave_frames() noexcept {
  read_frames();
  frames_.join(fixed_->coefficients.substep);
  keep_in_world();
  const std::size_t count = frames_.nodes().size();
  for (std::size_t a = 0; a < 3; ++a) {
    Real *at = at_.axis(a).data(), *velocity = velocity_.axis(a).data();
    const double *to = axis_of(frames_.positions, a).data(), *speed = axis_of(frames_.velocities, a).data();
    for (std::size_t place = 0; place < count; ++place) {
      const std::uint32_t slot = loose_slots_[place];
      const Real high = static_cast<Real>(to[place]);
      at[slot] = high;
      velocity[slot] = static_cast<Real>(speed[place]);
      packed_[4 * std::size_t{slot} + a] = high;
      Bounds<Real>& b = bounds_[slot / kBlockSlots];
      b.low[a] = std::min(b.low[a], high), b.high[a] = std::max(b.high[a], high);
    }
    if constexpr (kHasRest) {
      Real* rest = rest_of_at_.axis(a).data();
      for (std::size_t place = 0; place < count; ++place) {
        const std::uint32_t slot = loose_slots_[place];
        rest[slot] = static_cast<Real>(to[place] - double{at[slot]});
      }
    }
  }
}

// A node that would leave the world stays where it is.
template <class Real>
void Engine<Real>::keep_in_world() noexcept {
  lost_from_frame_ = kNone;
  const auto in_world = [](double v) { return std::abs(v) <= kWorld; };
  const std::size_t count = frames_.nodes().size();
  bool all = true;
  for (std::size_t a = 0; a < 3; ++a) {
    const double *to = axis_of(frames_.positions, a).data(), *speed = axis_of(frames_.velocities, a).data();
    for (std::size_t place = 0; place < count; ++place) all &= in_world(to[place]), all &= in_world(speed[place]);
  }
  if (all) return;
  for (std::size_t place = 0; place < count; ++place) {
    const Vec3 to = frames_.positions[place], speed = frames_.velocities[place];
    const bool good = in_world(to.x()) && in_world(to.y()) && in_world(to.z()) && in_world(speed.x()) &&
                      in_world(speed.y()) && in_world(speed.z());
    if (good) continue;
    if (frames_.nodes()[place] != RigidFrames::kNoNode) {
      lost_from_frame_ = std::min(lost_from_frame_, loose_slots_[place]);
    }
    frames_.positions.set(place, load(loose_slots_[place]));
    frames_.velocities.set(place, Vec3::Zero());
  }
}

// A node that slides goes with its body along the surface, and with the surface across it.
template <class Real>
void Engine<Real>::slide_along(const NodeConstraint& held, Held& next) noexcept {
  const Vec3 way = position(held.node) - next.position, speed = velocity(held.node);
  const Vec3 along = way - dot(way, held.normal) * held.normal;
  holder_work_ += dot(next.unreported, along);
  next.position += along;
  next.velocity = speed + dot(next.velocity - speed, held.normal) * held.normal;
}

template class Engine<float>;
template class Engine<double>;

}  // namespace crumble
