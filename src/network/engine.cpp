#include "network/engine.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/text.hpp"
#include "crumble/base/transcendental.hpp"

namespace crumble {
namespace {

std::size_t padded(std::size_t count) {
  return count + kPadding;
}

}  // namespace

template <class Real>
Engine<Real>::Engine(const SpringNetwork& network, const StepCoefficients& coefficients,
                     std::span<const Vec3> rest_positions, const SolverSettings& settings)
    : layout_(share_new<Layout>(make_layout(network, rest_positions))),
      fixed_(make_fixed(network, coefficients, rest_positions, settings, *layout_)),
      kernels_(&find_kernels(settings.kernel)) {
  const std::size_t slots = padded(node_count());
  const std::size_t shifted = slots + layout_->partitions.size() * layout_->halo;
  const std::size_t lanes = padded(layout_->lane_count());
  at_ = velocity_ = external_ = SlotArray<Real>(slots);
  if (kHasRest) rest_of_at_ = SlotArray<Real>(slots);
  force_ = SlotArray<Real>(shifted);
  packed_.resize(4 * slots);
  packed_force_.resize(4 * shifted);
  stiffness_.resize(lanes);
  rest_force_.resize(lanes);
  whole_.resize(lanes);
  plain_ = fixed_->plain;
  bounds_.resize(slots / kBlockSlots + 1);
  found_.resize(slots);
  overlong_.resize(lanes);
  overlong_of_.resize(layout_->partitions.size());
  lost_of_.assign(layout_->partitions.size(), kNone);
  held_.resize(node_count());
  frames_ = RigidFrames(network.masses);
  is_held_.resize(node_count());
  loose_slots_.resize(2 * node_count());
  loose_forces_.resize(2 * node_count());
  gains_ = fixed_->gains;  // room for mend(), which takes none
  if (layout_->partitions.size() > 1) {
    if (settings.host_threads.run != nullptr) team_ = share_new<Team>(settings.host_threads);
    if (!team_ && settings.threads > 1) team_ = share_new<Team>(settings.threads);
  }
  reset();
}

template <class Real>
std::shared_ptr<const typename Engine<Real>::Fixed> Engine<Real>::make_fixed(const SpringNetwork& network,
                                                                             const StepCoefficients& coefficients,
                                                                             std::span<const Vec3> rest_positions,
                                                                             const SolverSettings& settings,
                                                                             const Layout& layout) {
  auto fixed = share_new<Fixed>();
  fixed->springs = network.springs;
  fixed->stiffnesses = network.stiffnesses;
  fixed->rest_lengths = network.rest_lengths;
  fixed->coefficients = coefficients;
  fixed->masses = network.masses;
  fixed->spring_damping = network.spring_damping;
  for (std::size_t i = 0; i < network.node_count(); ++i) {
    const double loss = network.fixed[i] ? 0 : network.spring_damping * coefficients.substep / network.masses[i];
    fixed->damped.push_back(exp_exact(-loss));
  }
  fixed->give = settings.length_limit > 0 ? static_cast<Real>(1 - 1 / settings.length_limit)
                                          : std::numeric_limits<Real>::infinity();
  fixed->cut_share = static_cast<Real>(settings.cut_share);
  for (const std::uint32_t node : layout.node_of) fixed->rest_positions.push_back(rest_positions[node]);
  const auto by_slot = [&](const Vector<double>& by_node, AlignedVector<Real>& out) {
    out.assign(padded(by_node.size()), 0);
    for (std::size_t slot = 0; slot < by_node.size(); ++slot)
      out[slot] = static_cast<Real>(by_node[layout.node_of[slot]]);
  };
  by_slot(coefficients.drift, fixed->gains.drift);
  by_slot(coefficients.force_gain, fixed->gains.force);
  by_slot(coefficients.decay, fixed->gains.decay);
  for (Real& decay : fixed->gains.decay) decay = decay < kLeastDecay<Real> ? 0 : decay;
  by_slot(coefficients.velocity_gain, fixed->gains.velocity);
  set_ways(network, layout, *fixed);
  return fixed;
}

// A way has the values of its first spring; it is plain when all have them, in this precision.
template <class Real>
void Engine<Real>::set_ways(const SpringNetwork& network, const Layout& layout, Fixed& fixed) {
  const auto values = [&](std::uint32_t spring) {
    const double k = network.stiffnesses[spring];
    return Way<Real>{static_cast<Real>(k), static_cast<Real>(k * network.rest_lengths[spring])};
  };
  fixed.present.assign(layout.lane_count() / kLanes + kPadding, 0);
  for (const Segment& segment : layout.segments) {
    for (std::uint32_t w = 0; w < segment.ways; ++w) {
      const std::uint32_t first = segment.lane + w * segment.blocks * kLanes, end = first + segment.blocks * kLanes;
      const auto spring = std::find_if(layout.spring_of_lane.begin() + first, layout.spring_of_lane.begin() + end,
                                       [](std::uint32_t s) { return s != kNone; });
      const Way<Real> way = values(*spring);
      bool plain = true;
      for (std::uint32_t lane = first; lane < end; ++lane) {
        if (layout.spring_of_lane[lane] == kNone) continue;
        fixed.present[lane / kLanes] = static_cast<std::uint8_t>(fixed.present[lane / kLanes] | 1u << lane % kLanes);
        const Way<Real> here = values(layout.spring_of_lane[lane]);
        plain = plain && here.stiffness == way.stiffness && here.rest_force == way.rest_force;
      }
      fixed.way_of_block.insert(fixed.way_of_block.end(), segment.blocks,
                                static_cast<std::uint32_t>(fixed.ways.size()));
      fixed.ways.push_back(way);
      fixed.plain.push_back(plain);
    }
  }
}

template <class Real>
void Engine<Real>::reset() noexcept {
  for (std::uint32_t slot = 0; slot < node_count(); ++slot) store(slot, fixed_->rest_positions[slot], Vec3::Zero());
  for (std::size_t pad = node_count(); pad < at_.size(); ++pad) at_.set(pad, fixed_->rest_positions.back());
  mend();
  refresh();
}

template <class Real>
void Engine<Real>::redefine(NetworkSolver& next) noexcept {
  auto& other = static_cast<Engine&>(next);
  fixed_.swap(other.fixed_);
  std::swap(kernels_, other.kernels_);
  team_.swap(other.team_);
  frames_.swap_masses(other.frames_);
  mend();
  refresh();
}

// All springs unbroken, no node frozen, no loose body.
template <class Real>
void Engine<Real>::mend() noexcept {
  set_loose({});
  gains_ = fixed_->gains;
  for (std::uint32_t s = 0; s < fixed_->stiffnesses.size(); ++s) set_share(s, 1);
  plain_ = fixed_->plain;
}

// What follows from the positions, and no finding of the last step.
template <class Real>
void Engine<Real>::refresh() noexcept {
  start_forces();
  overlong_count_ = 0;
  std::fill(lost_of_.begin(), lost_of_.end(), kNone);
  lost_from_frame_ = kNone;
  for (const Partition& p : layout_->partitions) {
    kernel_of<Real>(*kernels_).pack(p.own_groups, std::as_const(at_).from(), packed_.data());
  }
  for (std::size_t block = 0; block * kBlockSlots < node_count(); ++block) {
    Bounds<Real>& b = bounds_[block];
    for (int axis = 0; axis < 3; ++axis) {
      b.low[axis] = std::numeric_limits<Real>::max(), b.high[axis] = std::numeric_limits<Real>::lowest();
    }
    const std::size_t end = std::min((block + 1) * kBlockSlots, node_count());
    for (std::size_t slot = block * kBlockSlots; slot < end; ++slot) widen(slot);
  }
}

template <class Real>
void Engine<Real>::widen(std::size_t slot) noexcept {
  Bounds<Real>& b = bounds_[slot / kBlockSlots];
  for (std::size_t a = 0; a < 3; ++a) {
    const Real p = at_.axis(a)[slot];
    b.low[a] = std::min(b.low[a], p), b.high[a] = std::max(b.high[a], p);
  }
}

template <class Real>
Vec3 Engine<Real>::load(std::size_t slot) const noexcept {
  if constexpr (kHasRest) {
    return at_.get(slot) + rest_of_at_.get(slot);
  } else {
    return at_.get(slot);
  }
}

template <class Real>
void Engine<Real>::store(std::size_t slot, const Vec3& position, const Vec3& velocity) noexcept {
  at_.set(slot, position);
  if constexpr (kHasRest) rest_of_at_.set(slot, position - at_.get(slot));
  velocity_.set(slot, velocity);
}

template <class Real>
Vec3 Engine<Real>::position(std::uint32_t node) const noexcept {
  return load(layout_->slot_of[node]);
}

template <class Real>
Vec3 Engine<Real>::velocity(std::uint32_t node) const noexcept {
  return velocity_.get(layout_->slot_of[node]);
}

template <class Real>
void Engine<Real>::place(std::uint32_t node, const Vec3& position, const Vec3& velocity) noexcept {
  place_slot(layout_->slot_of[node], position, velocity);
}

template <class Real>
void Engine<Real>::place_slot(std::uint32_t slot, const Vec3& position, const Vec3& velocity) noexcept {
  store(slot, position, velocity);
  widen(slot);
  Real* packed = packed_.data() + 4 * std::size_t{slot};
  for (std::size_t a = 0; a < 3; ++a) packed[a] = at_.axis(a)[slot];
}

template <class Real>
void Engine<Real>::set_external(VecView forces) noexcept {
  for (std::size_t slot = 0; slot < node_count(); ++slot) external_.set(slot, forces[layout_->node_of[slot]]);
  start_forces();
}

// Where the next step's sums begin: move() leaves them so too.
template <class Real>
void Engine<Real>::start_forces() noexcept {
  std::fill(packed_force_.begin(), packed_force_.end(), Real(0));
  for (std::size_t a = 0; a < 3; ++a) {
    const std::span<Real> force = force_.axis(a);
    std::fill(force.begin(), force.end(), Real(0));
    for (std::uint32_t p = 0; p < layout_->partitions.size(); ++p) {
      const Partition& part = layout_->partitions[p];
      const auto external = external_.axis(a).subspan(part.first, part.end - part.first);
      std::copy(external.begin(), external.end(), force.begin() + part.first + layout_->shift(p));
    }
  }
}

template <class Real>
void Engine<Real>::set_share(std::uint32_t spring, double share) noexcept {
  const std::uint32_t lane = layout_->lane_of_spring[spring];
  whole_[lane] = share == 1;
  const double stiffness = fixed_->stiffnesses[spring] * share;
  stiffness_[lane] = static_cast<Real>(stiffness);
  rest_force_[lane] = static_cast<Real>(stiffness * fixed_->rest_lengths[spring]);
  if (lane < layout_->batch_lanes) plain_[fixed_->way_of_block[lane / kLanes]] = 0;
}

template <class Real>
void Engine<Real>::set_frozen(std::uint32_t node, bool frozen) noexcept {
  const std::uint32_t slot = layout_->slot_of[node];
  for (const auto part : {&Gains::drift, &Gains::force, &Gains::decay, &Gains::velocity}) {
    (gains_.*part)[slot] = frozen ? Real(0) : (fixed_->gains.*part)[slot];
  }
}

template <class Real>
std::optional<std::uint32_t> Engine<Real>::lost_node() const noexcept {
  for (const std::uint32_t slot : lost_of_) {
    if (slot != kNone) return layout_->node_of[slot];
  }
  if (lost_from_frame_ != kNone) return layout_->node_of[lost_from_frame_];
  return {};
}

template <class Real>
void Engine<Real>::push(std::uint32_t node, const Vec3& force) noexcept {
  const std::uint32_t slot = layout_->slot_of[node], shift = layout_->shift(partition_of(slot));
  for (std::size_t a = 0; a < 3; ++a) force_.axis(a)[slot + shift] += static_cast<Real>(force[static_cast<int>(a)]);
}

template <class Real>
void Engine<Real>::read_positions(std::uint32_t first, VecSpan positions) const noexcept {
  for (std::size_t i = 0; i < positions.size(); ++i) positions.set(i, load(layout_->slot_of[first + i]));
}

template <class Real>
void Engine<Real>::read_velocities(VecSpan velocities) const noexcept {
  for (std::size_t slot = 0; slot < node_count(); ++slot) velocities.set(layout_->node_of[slot], velocity_.get(slot));
}

template <class Real>
void Engine<Real>::read_nodes(std::span<const std::uint32_t> nodes, VecSpan positions,
                              VecSpan velocities) const noexcept {
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const std::uint32_t slot = layout_->slot_of[nodes[k]];
    positions.set(k, load(slot));
    velocities.set(k, velocity_.get(slot));
  }
}

template <class Real>
void Engine<Real>::read_forces(VecSpan forces) const {
  Engine copy(*this);
  for (std::uint32_t p = 0; p < layout_->partitions.size(); ++p) copy.sum_forces(p);
  for (std::uint32_t slot = 0; slot < node_count(); ++slot) forces.set(layout_->node_of[slot], copy.force_at(slot));
}

namespace {

template <class Real>
std::span<const std::uint8_t> as_bytes_of(std::span<const Real> values) {
  return {reinterpret_cast<const std::uint8_t*>(values.data()), values.size_bytes()};
}

}  // namespace

template <class Real>
void Engine<Real>::add_to(Hash& hash) const noexcept {
  for (const SlotArray<Real>* each : {&at_, &velocity_, &rest_of_at_}) {
    if (each->empty()) continue;
    for (std::size_t a = 0; a < 3; ++a) {
      hash.add(as_bytes_of(each->axis(a).first(node_count())));
    }
  }
}

template <class Real>
void Engine<Real>::save(ByteWriter& out) const {
  for (const SlotArray<Real>* each : {&at_, &velocity_, &rest_of_at_}) {
    if (each->empty()) continue;
    for (std::size_t a = 0; a < 3; ++a) out.put(each->axis(a).first(node_count()));
  }
}

template <class Real>
void Engine<Real>::load(ByteReader& in) {
  for (SlotArray<Real>* each : {&at_, &velocity_, &rest_of_at_}) {
    if (each->empty()) continue;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto values = in.get_vector<Real>();
      if (values.size() != node_count()) throw Error(Code::corrupt, "snapshot has another node count");
      std::copy(values.begin(), values.end(), each->axis(a).begin());
    }
  }
  mend();
  refresh();
}

template <class Real>
LayoutReport Engine<Real>::layout() const noexcept {
  LayoutReport report;
  report.springs_in_segments =
      static_cast<std::size_t>(std::count_if(layout_->lane_of_spring.begin(), layout_->lane_of_spring.end(),
                                             [&](std::uint32_t lane) { return lane < layout_->batch_lanes; }));
  report.lanes = layout_->lane_count();
  report.segments = layout_->segments.size();
  report.batches = layout_->batches.size();
  report.partitions = static_cast<std::uint32_t>(layout_->partitions.size());
  report.sorted = layout_->sorted;
  return report;
}

template class Engine<float>;
template class Engine<double>;

namespace {

void check(const SolverSettings& settings) {
  if (settings.threads < 1 || settings.threads > 64) {
    throw Error(Code::out_of_range, "threads must lie in [1, 64], is " + std::to_string(settings.threads));
  }
  require_in_range("cut_share", settings.cut_share, 0, 1);
  require_finite("length_limit", settings.length_limit);
  if (settings.length_limit != 0 && settings.length_limit <= 1) {
    throw Error(Code::out_of_range, "length_limit must be 0 (none) or above 1, is " + to_text(settings.length_limit));
  }
}

}  // namespace

std::unique_ptr<NetworkSolver> NetworkSolver::make(const SpringNetwork& network, const StepCoefficients& coefficients,
                                                   std::span<const Vec3> rest_positions,
                                                   const SolverSettings& settings) {
  check(settings);
  if (settings.precision == Precision::float32) {
    return std::make_unique<Engine<float>>(network, coefficients, rest_positions, settings);
  }
  return std::make_unique<Engine<double>>(network, coefficients, rest_positions, settings);
}

}  // namespace crumble
