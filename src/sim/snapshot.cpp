#include <algorithm>
#include <string>

#include "crumble/base/hash.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/sim/simulation.hpp"

namespace crumble {
namespace {

constexpr std::uint64_t kSnapshotMagic = 0x3430504e534d5243u;  // "CRMSNP" and the version, "04"
constexpr std::uint64_t kNameOfMagic = 0x0000ffffffffffffu;
constexpr std::uint64_t kMostSteps = std::uint64_t{1} << 53;  // a double, which the time is, counts no further

void require(bool good, const char* what) {
  if (!good) throw Error(Code::corrupt, std::string("snapshot holds an impossible ") + what);
}

void put(ByteWriter& out, const Wrench& w) {
  for (const Vec3& v : {w.force, w.torque}) out.put(v.x()), out.put(v.y()), out.put(v.z());
}

void get(ByteReader& in, Wrench& w) {
  for (Vec3* v : {&w.force, &w.torque}) {
    for (int axis = 0; axis < 3; ++axis) (*v)[axis] = in.get<double>();
  }
}

StepInfo get_info(ByteReader& in, const Simulation& sim) {
  StepInfo info;
  info.status = static_cast<Code>(in.get<std::int32_t>());
  info.flags = in.get<std::uint32_t>();
  info.step = in.get<std::uint64_t>();
  info.time = in.get<double>();
  info.contacts = in.get<std::uint32_t>();
  info.new_cuts = in.get<std::uint32_t>();
  info.bad_node = in.get<std::uint32_t>();
  const StepSettings& how = sim.definition().step;
  require(info.status == Code{} || info.status == Code::bad_pose || info.status == Code::diverged, "status");
  require(info.step <= kMostSteps, "number of steps");
  require(info.time == static_cast<double>(info.step) * (how.tau * how.iterations), "time");
  require(info.bad_node < sim.mesh().node_count(), "lost node");
  return info;
}

std::uint64_t checksum(std::span<const std::uint8_t> bytes) {
  Hash hash;
  hash.add(bytes);
  return hash.value();
}

}  // namespace

Vector<std::uint8_t> Simulation::snapshot() const {
  ByteWriter out;
  out.put(kSnapshotMagic);
  out.put(layout_hash_);
  out.put(static_cast<std::int32_t>(info_.status));
  out.put(info_.flags), out.put(info_.step), out.put(info_.time);
  out.put(info_.contacts), out.put(info_.new_cuts), out.put(info_.bad_node);
  for (const std::uint64_t count : {counters_.cuts, counters_.tool_jumps, counters_.suspended_steps,
                                    counters_.bad_poses, counters_.dropped_events, counters_.woken}) {
    out.put(count);
  }
  for (const double row : {ledger_.stored, ledger_.tool_work, ledger_.external_work, ledger_.dissipated, ledger_.cut,
                           ledger_.gain_max_relative}) {
    out.put(row);
  }
  out.put(static_cast<std::uint8_t>(has_node_forces()));
  if (has_node_forces()) out.put(node_forces_.x), out.put(node_forces_.y), out.put(node_forces_.z);
  solver_->save(out);
  out.put(intact_);
  out.put(static_cast<std::uint64_t>(fading_.size()));
  for (const Fading& fading : fading_) out.put(fading.spring), out.put(fading.substeps_left);
  out.put(std::span<const std::uint32_t>(new_cuts()));
  for (std::size_t tool = 0; tool < wrenches_.size(); ++tool) {
    put(out, wrenches_[tool]);
    for (const Wrench& past : history_[tool]) put(out, past);
  }
  contacts_.save(out);
  fragments_.save(out);
  for (std::uint32_t f = 0; f < fragments_.count(); ++f) out.put(static_cast<std::uint8_t>(fragment_states_[f]));
  if (balls_) balls_->save(out);
  out.put(checksum(out.bytes()));
  return std::move(out.bytes());
}

void Simulation::load_node_forces(ByteReader& in) {
  if (in.get<std::uint8_t>() == 0) return clear_node_forces();
  VecArray forces;
  for (Vector<double>* axis : {&forces.x, &forces.y, &forces.z}) {
    *axis = in.get_vector<double>();
    require(axis->size() == network_.node_count(), "number of node forces");
  }
  for (std::size_t node = 0; node < forces.size(); ++node) require(is_finite(forces[node]), "node force");
  set_node_forces(forces);
}

// The stiffnesses in force follow from what is intact and what is fading.
void Simulation::load_fading(ByteReader& in) {
  stiffnesses_ = network_.stiffnesses;
  for (std::uint32_t s = 0; s < intact_.size(); ++s) {
    if (!intact_[s]) set_share(s, 0);
  }
  fading_.clear();
  const auto count = in.get<std::uint64_t>();
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto spring = in.get<std::uint32_t>(), left = in.get<std::uint32_t>();
    if (count > intact_.size() || spring >= intact_.size() || intact_[spring] || left > fade_substeps_) {
      throw Error(Code::corrupt, "snapshot holds an impossible fading spring");
    }
    fading_.push_back({spring, left});
    set_share(spring, static_cast<double>(left) / (fade_substeps_ + 1));
  }
}

void Simulation::restore(std::span<const std::uint8_t> bytes) {
  ByteReader in(bytes, "snapshot");
  const auto magic = in.get<std::uint64_t>();
  if ((magic ^ kSnapshotMagic) & kNameOfMagic) throw Error(Code::corrupt, "snapshot does not begin like one");
  if (magic != kSnapshotMagic) throw Error(Code::version, "snapshot was written by another version of this library");
  if (in.get<std::uint64_t>() != layout_hash_)
    throw Error(Code::version, "snapshot belongs to another simulation definition");
  ByteReader end(bytes.size() < 8 ? bytes : bytes.last(8), "snapshot");
  if (end.get<std::uint64_t>() != checksum(bytes.first(bytes.size() - 8))) {
    throw Error(Code::corrupt, "snapshot is truncated or damaged: its checksum does not fit");
  }

  // read everything into copies first, so that a bad snapshot changes nothing
  Simulation next = *this;
  next.info_ = get_info(in, *this);
  Counters& counters = next.counters_;
  for (std::uint64_t* count : {&counters.cuts, &counters.tool_jumps, &counters.suspended_steps, &counters.bad_poses,
                               &counters.dropped_events, &counters.woken}) {
    *count = in.get<std::uint64_t>();
  }
  EnergyLedger& ledger = next.ledger_;
  for (double* row : {&ledger.stored, &ledger.tool_work, &ledger.external_work, &ledger.dissipated, &ledger.cut,
                      &ledger.gain_max_relative}) {
    *row = in.get<double>();
  }
  next.load_node_forces(in);
  next.solver_->load(in);
  next.forget_copies();
  next.intact_ = in.get_vector<std::uint8_t>();
  if (next.intact_.size() != network_.spring_count()) throw Error(Code::corrupt, "snapshot has another spring count");
  require(std::all_of(next.intact_.begin(), next.intact_.end(), [](std::uint8_t flag) { return flag <= 1; }), "spring");
  next.load_fading(in);
  const auto cuts = in.get_vector<std::uint32_t>();
  if (cuts.size() != next.info_.new_cuts || cuts.size() > network_.spring_count()) {
    throw Error(Code::corrupt, "snapshot has an impossible number of cuts");
  }
  const auto is_cut = [&](std::uint32_t spring) { return spring < next.intact_.size() && !next.intact_[spring]; };
  require(std::all_of(cuts.begin(), cuts.end(), is_cut), "cut");
  std::copy(cuts.begin(), cuts.end(), next.new_cuts_.begin());
  for (std::size_t tool = 0; tool < wrenches_.size(); ++tool) {
    get(in, next.wrenches_[tool]);
    for (Wrench& past : next.history_[tool]) get(in, past);
  }
  next.contacts_.load(in);
  next.load_fragments(in);
  if (next.balls_) next.balls_->load(in);
  next.regroup(next.last_step(), {});
  next.event_log_.restart(next.info_.step, next.contacts_.constraints());
  if (def_.step.energy_audit) next.ledger_.stored = next.stored_energy();
  take_state(next);
}

// Definition and network stay untouched: a drawing thread may be reading the mesh.
void Simulation::take_state(Simulation& from) noexcept {
  solver_ = std::move(from.solver_);
  contacts_ = std::move(from.contacts_);
  balls_ = std::move(from.balls_);
  ball_fragments_ = std::move(from.ball_fragments_);
  regroup_at_ = from.regroup_at_;
  stiffnesses_ = std::move(from.stiffnesses_);
  node_forces_ = std::move(from.node_forces_);
  external_ = std::move(from.external_);
  intact_ = std::move(from.intact_);
  new_cuts_ = std::move(from.new_cuts_);
  fading_ = std::move(from.fading_);
  fragments_ = std::move(from.fragments_);
  fragment_states_ = std::move(from.fragment_states_);
  event_log_ = std::move(from.event_log_);
  wrenches_ = std::move(from.wrenches_);
  history_ = std::move(from.history_);
  info_ = from.info_;
  profile_ = from.profile_;
  counters_ = from.counters_;
  ledger_ = from.ledger_;
  forget_copies();
}

// Sleeping nodes stand still and touch nothing, removed ones belong to no fragment: all that follows from the states.
void Simulation::load_fragments(ByteReader& in) {
  fragments_.load(in);
  counters_.asleep = counters_.removed = counters_.removed_nodes = 0;
  std::fill(fragment_states_.begin(), fragment_states_.end(), FragmentState::active);
  for (std::uint32_t f = 0; f < fragments_.count(); ++f) {
    const auto state = in.get<std::uint8_t>();
    const bool removed = fragments_.record(f).node_count == 0;
    if (state > static_cast<std::uint8_t>(FragmentState::removed) || (state == 2) != removed) {
      throw Error(Code::corrupt, "snapshot holds an impossible fragment state");
    }
    fragment_states_[f] = static_cast<FragmentState>(state);
    counters_.removed += removed;
    counters_.asleep += fragment_states_[f] == FragmentState::asleep;
  }
  for (std::uint32_t node = 0; node < network_.node_count(); ++node) {
    const std::uint32_t fragment = fragments_.labels()[node];
    if (fragment == kNoFragment) {
      take_away(node);
    } else if (fragment_states_[fragment] == FragmentState::asleep) {
      let_sleep(node);
    }
  }
}

std::uint64_t Simulation::state_hash() const noexcept {
  Hash hash;
  solver_->add_to(hash);
  hash.add(std::span<const std::uint8_t>(intact_));
  for (const Fading& fading : fading_) hash.add(std::uint64_t{fading.spring} << 32 | fading.substeps_left);
  if (has_node_forces()) {
    for (const auto* axis : {&node_forces_.x, &node_forces_.y, &node_forces_.z})
      hash.add(std::span<const double>(*axis));
  }
  for (const NodeConstraint& c : contacts_.constraints()) {
    hash.add(std::uint64_t{c.node} << 32 | c.holder);
    hash.add(static_cast<std::uint64_t>(c.state));
    for (int axis = 0; axis < 3; ++axis) hash.add(c.point[axis]);
  }
  for (const Wrench& w : wrenches_) {
    for (int axis = 0; axis < 3; ++axis) hash.add(w.force[axis]), hash.add(w.torque[axis]);
  }
  fragments_.add_to(hash);
  if (balls_) balls_->add_to(hash);
  for (std::uint32_t f = 0; f < fragments_.count(); ++f) hash.add(static_cast<std::uint64_t>(fragment_states_[f]));
  return hash.value();
}

}  // namespace crumble
