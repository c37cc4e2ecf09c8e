#include "crumble/base/hash.hpp"
#include "crumble/sim/simulation.hpp"

namespace crumble {
namespace {

constexpr std::uint64_t kSnapshotMagic = 0x3230504e534d5243u;  // "CRMSNP" and the version, "02"
constexpr std::uint64_t kNameOfMagic = 0x0000ffffffffffffu;

void put(ByteWriter& out, const Wrench& w) {
  for (const Vec3& v : {w.force, w.torque}) out.put(v.x()), out.put(v.y()), out.put(v.z());
}

void get(ByteReader& in, Wrench& w) {
  for (Vec3* v : {&w.force, &w.torque}) {
    for (int axis = 0; axis < 3; ++axis) (*v)[axis] = in.get<double>();
  }
}

std::uint64_t checksum(std::span<const std::uint8_t> bytes) {
  Hash hash;
  hash.add(bytes);
  return hash.value();
}

}  // namespace

std::vector<std::uint8_t> Simulation::snapshot() const {
  ByteWriter out;
  out.put(kSnapshotMagic);
  out.put(layout_hash_);
  out.put(static_cast<std::int32_t>(info_.status));
  out.put(info_.flags), out.put(info_.step), out.put(info_.time);
  out.put(info_.contacts), out.put(info_.new_cuts), out.put(info_.bad_node);
  out.put(counters_.cuts), out.put(counters_.tool_jumps), out.put(counters_.suspended_steps),
      out.put(counters_.bad_poses);
  for (const double row : {ledger_.stored, ledger_.tool_work, ledger_.external_work, ledger_.dissipated, ledger_.cut,
                           ledger_.gain_max_relative}) {
    out.put(row);
  }
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
  out.put(checksum(out.bytes()));
  return std::move(out.bytes());
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
  next.info_.status = static_cast<Code>(in.get<std::int32_t>());
  next.info_.flags = in.get<std::uint32_t>();
  next.info_.step = in.get<std::uint64_t>();
  next.info_.time = in.get<double>();
  next.info_.contacts = in.get<std::uint32_t>();
  next.info_.new_cuts = in.get<std::uint32_t>();
  next.info_.bad_node = in.get<std::uint32_t>();
  Counters& counters = next.counters_;
  for (std::uint64_t* count : {&counters.cuts, &counters.tool_jumps, &counters.suspended_steps, &counters.bad_poses}) {
    *count = in.get<std::uint64_t>();
  }
  EnergyLedger& ledger = next.ledger_;
  for (double* row : {&ledger.stored, &ledger.tool_work, &ledger.external_work, &ledger.dissipated, &ledger.cut,
                      &ledger.gain_max_relative}) {
    *row = in.get<double>();
  }
  next.solver_->load(in);
  next.forget_copies();
  next.intact_ = in.get_vector<std::uint8_t>();
  if (next.intact_.size() != network_.spring_count()) throw Error(Code::corrupt, "snapshot has another spring count");
  next.load_fading(in);
  const auto cuts = in.get_vector<std::uint32_t>();
  if (cuts.size() != next.info_.new_cuts || cuts.size() > network_.spring_count()) {
    throw Error(Code::corrupt, "snapshot has an impossible number of cuts");
  }
  std::copy(cuts.begin(), cuts.end(), next.new_cuts_.begin());
  for (std::size_t tool = 0; tool < wrenches_.size(); ++tool) {
    get(in, next.wrenches_[tool]);
    for (Wrench& past : next.history_[tool]) get(in, past);
  }
  next.contacts_.load(in);
  if (def_.step.energy_audit) next.ledger_.stored = next.stored_energy();
  *this = std::move(next);
}

std::uint64_t Simulation::state_hash() const noexcept {
  Hash hash;
  solver_->add_to(hash);
  hash.add(std::span<const std::uint8_t>(intact_));
  for (const Fading& fading : fading_) hash.add(std::uint64_t{fading.spring} << 32 | fading.substeps_left);
  for (const NodeConstraint& c : contacts_.constraints()) {
    hash.add(std::uint64_t{c.node} << 32 | c.holder);
    hash.add(static_cast<std::uint64_t>(c.state));
    for (int axis = 0; axis < 3; ++axis) hash.add(c.point[axis]);
  }
  for (const Wrench& w : wrenches_) {
    for (int axis = 0; axis < 3; ++axis) hash.add(w.force[axis]), hash.add(w.torque[axis]);
  }
  return hash.value();
}

}  // namespace crumble
