#include "crumble/sim/publisher.hpp"

#include <algorithm>

#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

// The frame of simulated time that the simulation is in: one copy is begun in each at most.
std::uint64_t frame_of(const Simulation& sim) {
  return static_cast<std::uint64_t>(sim.info().time * StatePublisher::kStatesPerSecond);
}

PublishedState make_state(const Simulation& sim) {
  PublishedState state;
  state.positions = VecArray(sim.mesh().node_count());
  state.intact.resize(sim.network().spring_count());
  state.fragments.resize(sim.mesh().node_count());
  state.records.resize(sim.mesh().node_count());
  state.fragment_states.resize(sim.mesh().node_count());
  return state;
}

std::size_t slices_of(std::size_t nodes) {
  constexpr std::size_t kSteps = 16;  // of a millisecond, in 1 / kStatesPerSecond
  const auto shares = [&](std::size_t each) { return (nodes + each - 1) / each; };
  return std::max(shares(StatePublisher::kNodesPerTick), std::min(shares(StatePublisher::kWholeNodes), kSteps));
}

// Copies one of `slices` equal parts.
template <class T>
void copy_part(std::span<const T> from, Vector<T>& to, std::size_t slice, std::size_t slices) {
  const std::size_t begin = from.size() * slice / slices, end = from.size() * (slice + 1) / slices;
  std::copy(from.begin() + begin, from.begin() + end, to.begin() + begin);
}

}  // namespace

StatePublisher::StatePublisher(const Simulation& sim)
    : states_(make_state(sim)), events_(kEvents), slices_(slices_of(sim.mesh().node_count())) {
  publish_now(sim);
  states_.fetch();
}

void StatePublisher::publish(const Simulation& sim) noexcept {
  for (const Event& event : sim.events()) events_.push(event);
  // reset or restored: what has been copied is of another run, and may name fragments that are not there
  if (sim.info().step < last_step_ || sim.fragments().count() < last_fragment_count_) slice_ = 0;
  last_step_ = sim.info().step;
  last_fragment_count_ = sim.fragments().count();
  if (slice_ > 0 || is_due(sim)) copy_slice(sim);
}

void StatePublisher::publish_now(const Simulation& sim) noexcept {
  slice_ = 0;
  last_step_ = sim.info().step;
  last_fragment_count_ = sim.fragments().count();
  do {
    copy_slice(sim);
  } while (slice_ > 0);
}

const PublishedState& StatePublisher::latest() noexcept {
  states_.fetch();
  states_.request();
  return states_.front();
}

bool StatePublisher::is_due(const Simulation& sim) const noexcept {
  return states_.wanted() && frame_of(sim) != frame_;
}

void StatePublisher::copy_slice(const Simulation& sim) noexcept {
  PublishedState& state = states_.back();
  if (slice_ == 0) {
    state.first_step = sim.info().step;
    state.fragment_count = sim.fragments().count();
    frame_ = frame_of(sim);
  }
  const std::size_t nodes = state.fragments.size();
  const std::size_t begin = nodes * slice_ / slices_, count = nodes * (slice_ + 1) / slices_ - begin;
  VecArray& p = state.positions;
  sim.read_positions(static_cast<std::uint32_t>(begin),
                     {{&p.x[begin], count}, {&p.y[begin], count}, {&p.z[begin], count}});
  copy_part(sim.intact(), state.intact, slice_, slices_);
  copy_part(sim.node_fragments(), state.fragments, slice_, slices_);
  copy_records(sim);
  if (++slice_ < slices_) return;
  slice_ = 0;
  state.step = sim.info().step;
  state.time = sim.info().time;
  state.counters = sim.counters();
  states_.publish();
}

// There may be as many fragments as nodes, so their records go in slices too; the last one also takes those that were
// born since the first.
void StatePublisher::copy_records(const Simulation& sim) noexcept {
  PublishedState& state = states_.back();
  const auto copy = [&](std::size_t begin, std::size_t end) {
    for (std::size_t id = begin; id < end; ++id) {
      state.records[id] = sim.fragments().record(static_cast<std::uint32_t>(id));
      state.fragment_states[id] = sim.fragment_states()[id];
    }
  };
  const std::size_t known = state.fragment_count;
  copy(known * slice_ / slices_, known * (slice_ + 1) / slices_);
  if (slice_ + 1 < slices_) return;
  state.fragment_count = sim.fragments().count();
  copy(known, state.fragment_count);
}

}  // namespace crumble
