#include "crumble/sim/recording.hpp"

#include <algorithm>

#include "crumble/base/file.hpp"
#include "crumble/base/hash.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/sim/change.hpp"

namespace crumble {
namespace {

constexpr std::uint64_t kRecordingMagic = 0x31304345524d5243u;  // "CRMREC01"
constexpr std::uint32_t kRecordingVersion = 5;                  // 5: changes of the definition

std::uint64_t checksum(std::span<const std::uint8_t> bytes) {
  Hash hash;
  hash.add(bytes);
  return hash.value();
}

void put(ByteWriter& out, const Pose& pose) {
  const Quat& q = pose.orientation;
  for (const double v : {pose.position.x(), pose.position.y(), pose.position.z(), q.w(), q.x(), q.y(), q.z()})
    out.put(v);
}

Pose get_pose(ByteReader& in) {
  double v[7];
  for (double& each : v) each = in.get<double>();
  return {{v[0], v[1], v[2]}, Quat(v[3], v[4], v[5], v[6])};
}

// Those of the changes that came before the step and after the one before it.
template <class Change>
std::span<const Change> before_step(const Vector<Change>& changes, std::size_t step) {
  const auto first = std::lower_bound(changes.begin(), changes.end(), step,
                                      [](const Change& change, std::size_t at) { return change.step < at; });
  const auto last = std::find_if(first, changes.end(), [&](const Change& change) { return change.step != step; });
  return {first, last};
}

}  // namespace

Recording::Recording(const Simulation& start)
    : snapshot_(start.snapshot()),
      tool_count_(start.definition().tools.size() + start.definition().attachments.size()) {
  ByteWriter out;
  write_definition(start.definition(), out);
  definition_ = std::move(out.bytes());
}

void Recording::add(std::span<const Pose> poses, std::uint64_t state_hash) {
  if (poses.size() != tool_count_) {
    throw Error(Code::out_of_range, "a recording of " + std::to_string(tool_count_) + " tools was given " +
                                        std::to_string(poses.size()) + " poses");
  }
  poses_.insert(poses_.end(), poses.begin(), poses.end());
  hashes_.push_back(state_hash);
}

void Recording::add_fragment_state(std::uint32_t fragment, FragmentState state) {
  fragment_changes_.push_back({hashes_.size(), fragment, state});
}

void Recording::add_node_force(std::uint32_t node, const Vec3& force) {
  force_changes_.push_back({hashes_.size(), node, force});
}

void Recording::add_suspension(std::uint32_t tool, bool suspended) {
  suspensions_.push_back({hashes_.size(), tool, suspended});
}

void Recording::add_change(Vector<std::uint8_t> settings) {
  changes_.push_back({hashes_.size(), std::move(settings)});
}

Vector<std::uint8_t> Recording::settings_of(const SimulationDef& def) {
  ByteWriter out;
  write_settings(def, out);
  return std::move(out.bytes());
}

void Recording::apply_change(const DefinitionAt& change, Simulation& sim) const {
  ByteReader in(change.settings, "recording");
  SimulationDef next = sim.definition();
  read_settings(in, next);
  DefinitionChange(sim.definition(), std::move(next)).apply_to(sim);
}

void Recording::apply_changes(std::size_t step, Simulation& sim) const {
  try {
    for (const DefinitionAt& change : before_step(changes_, step)) apply_change(change, sim);
    for (const FragmentChange& change : before_step(fragment_changes_, step)) {
      sim.set_fragment_state(change.fragment, change.state);
    }
    if (const auto changes = before_step(force_changes_, step); !changes.empty()) {
      VecArray forces(sim.mesh().node_count());
      for (std::size_t node = 0; node < forces.size(); ++node) forces.set(node, sim.node_forces()[node]);
      for (const ForceChange& change : changes) {
        if (change.node >= forces.size()) throw Error(Code::corrupt, "there is no node " + std::to_string(change.node));
        forces.set(change.node, change.force);
      }
      sim.set_node_forces(forces);
    }
    for (const Suspension& s : before_step(suspensions_, step)) sim.suspend_contact(s.tool, s.suspended);
  } catch (const Error& error) {
    throw Error(Code::corrupt, "recording, before step " + std::to_string(step) + ": " + error.what());
  }
}

Simulation Recording::start(const StepSettings& how) const {
  ByteReader in(definition_, "recording");
  SimulationDef def = read_definition(in);
  def.step.energy_audit = how.energy_audit;
  def.step.kernel = how.kernel;
  def.step.threads = how.threads;
  def.step.host_threads = how.host_threads;
  Simulation sim(std::move(def));
  sim.restore(snapshot_);
  return sim;
}

std::uint64_t Recording::first_step() const {
  return start().info().step;
}

void Recording::save(const std::filesystem::path& path) const {
  ByteWriter out;
  out.put(kRecordingMagic), out.put(kRecordingVersion);
  out.put(definition_), out.put(snapshot_);
  out.put(static_cast<std::uint64_t>(tool_count_));
  out.put(static_cast<std::uint64_t>(hashes_.size()));
  for (const Pose& pose : poses_) put(out, pose);
  for (const std::uint64_t hash : hashes_) out.put(hash);
  out.put(static_cast<std::uint64_t>(fragment_changes_.size()));
  for (const FragmentChange& change : fragment_changes_) {
    out.put(change.step), out.put(change.fragment), out.put(static_cast<std::uint8_t>(change.state));
  }
  out.put(static_cast<std::uint64_t>(force_changes_.size()));
  for (const ForceChange& change : force_changes_) {
    out.put(change.step), out.put(change.node);
    for (int axis = 0; axis < 3; ++axis) out.put(change.force[axis]);
  }
  out.put(static_cast<std::uint64_t>(suspensions_.size()));
  for (const Suspension& suspension : suspensions_) {
    out.put(suspension.step), out.put(suspension.tool), out.put(std::uint8_t{suspension.suspended});
  }
  out.put(static_cast<std::uint64_t>(changes_.size()));
  for (const DefinitionAt& change : changes_) out.put(change.step), out.put(change.settings);
  out.put(checksum(out.bytes()));
  write_bytes(path, out.bytes());
}

Recording Recording::load(const std::filesystem::path& path) {
  const Vector<std::uint8_t> bytes = read_bytes(path);
  const std::string name = "recording '" + path.string() + "'";
  ByteReader in(bytes, name);
  if (in.get<std::uint64_t>() != kRecordingMagic) throw Error(Code::format, name + " is not a recording");
  if (const auto version = in.get<std::uint32_t>(); version != kRecordingVersion) {
    throw Error(Code::version, name + " has version " + std::to_string(version) + ", this library reads " +
                                   std::to_string(kRecordingVersion));
  }
  const std::span<const std::uint8_t> all(bytes);
  ByteReader end(all.last(8), name);
  if (end.get<std::uint64_t>() != checksum(all.first(all.size() - 8))) {
    throw Error(Code::corrupt, name + " is truncated or damaged: its checksum does not fit");
  }
  Recording recording;
  recording.definition_ = in.get_vector<std::uint8_t>();
  recording.snapshot_ = in.get_vector<std::uint8_t>();
  const auto tools = in.get<std::uint64_t>(), steps = in.get<std::uint64_t>();
  if (tools > 1000 || steps > in.left() / (7 * sizeof(double) * tools + 8))
    throw Error(Code::corrupt, name + " is truncated");
  recording.tool_count_ = static_cast<std::size_t>(tools);
  for (std::uint64_t i = 0; i < tools * steps; ++i) recording.poses_.push_back(get_pose(in));
  for (std::uint64_t i = 0; i < steps; ++i) recording.hashes_.push_back(in.get<std::uint64_t>());
  recording.load_fragment_changes(in, name);
  recording.load_force_changes(in, name);
  recording.load_suspensions(in, name);
  recording.load_changes(in, name);
  return recording;
}

void Recording::load_fragment_changes(ByteReader& in, const std::string& name) {
  for (auto left = in.get<std::uint64_t>(); left > 0; --left) {
    const auto step = in.get<std::uint64_t>();
    const auto fragment = in.get<std::uint32_t>();
    const auto state = in.get<std::uint8_t>();
    const std::uint64_t before = fragment_changes_.empty() ? 0 : fragment_changes_.back().step;
    if (step < before || step > hashes_.size() || state > static_cast<std::uint8_t>(FragmentState::removed)) {
      throw Error(Code::corrupt, name + " holds an impossible change of a fragment");
    }
    fragment_changes_.push_back({step, fragment, static_cast<FragmentState>(state)});
  }
}

void Recording::load_force_changes(ByteReader& in, const std::string& name) {
  for (auto left = in.get<std::uint64_t>(); left > 0; --left) {
    const auto step = in.get<std::uint64_t>();
    const auto node = in.get<std::uint32_t>();
    const auto x = in.get<double>(), y = in.get<double>(), z = in.get<double>();
    const std::uint64_t before = force_changes_.empty() ? 0 : force_changes_.back().step;
    if (step < before || step > hashes_.size()) {
      throw Error(Code::corrupt, name + " holds an impossible change of a node's force");
    }
    force_changes_.push_back({step, node, {x, y, z}});
  }
}

void Recording::load_suspensions(ByteReader& in, const std::string& name) {
  for (auto left = in.get<std::uint64_t>(); left > 0; --left) {
    const auto step = in.get<std::uint64_t>();
    const auto tool = in.get<std::uint32_t>();
    const auto suspended = in.get<std::uint8_t>();
    const std::uint64_t before = suspensions_.empty() ? 0 : suspensions_.back().step;
    if (step < before || step > hashes_.size() || tool >= tool_count_ || suspended > 1) {
      throw Error(Code::corrupt, name + " holds an impossible suspension of a tool");
    }
    suspensions_.push_back({step, tool, suspended == 1});
  }
}

void Recording::load_changes(ByteReader& in, const std::string& name) {
  for (auto left = in.get<std::uint64_t>(); left > 0; --left) {
    const auto step = in.get<std::uint64_t>();
    const std::uint64_t before = changes_.empty() ? 0 : changes_.back().step;
    if (step < before || step > hashes_.size()) {
      throw Error(Code::corrupt, name + " holds an impossible change of the definition");
    }
    changes_.push_back({step, in.get_vector<std::uint8_t>()});
  }
}

std::optional<std::size_t> replay(const Recording& recording, Simulation& sim,
                                  const std::function<bool(const Simulation&)>& after_step) {
  for (std::size_t step = 0; step < recording.step_count(); ++step) {
    recording.apply_changes(step, sim);
    sim.step(recording.poses(step));
    if (sim.state_hash() != recording.state_hash(step)) return step;
    if (after_step && !after_step(sim)) break;
  }
  return std::nullopt;
}

}  // namespace crumble
