// A recording: what a simulation was made from, where it stood, every pose it was given, what the host changed between
// steps, and a hash of every state it reached. A bug report is a file that can be run again.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "crumble/base/memory.hpp"
#include "crumble/sim/simulation.hpp"

namespace crumble {

class Recording {
 public:
  /// Starts at the simulation's present state.
  explicit Recording(const Simulation& start);
  /// After each step: the poses it was given and the state it led to. Allocates; call it outside the servo loop's
  /// budget.
  void add(std::span<const Pose> poses, std::uint64_t state_hash);
  /// After each Simulation::set_fragment_state between steps.
  void add_fragment_state(std::uint32_t fragment, FragmentState state);
  /// After each Simulation::set_node_force between steps; after set_node_forces for every node whose force changed.
  void add_node_force(std::uint32_t node, const Vec3& force);
  /// After each Simulation::suspend_contact between steps.
  void add_suspension(std::uint32_t tool, bool suspended);
  /// After each DefinitionChange::apply_to between steps: what settings_of() gives of the new definition.
  void add_change(Vector<std::uint8_t> settings);
  static Vector<std::uint8_t> settings_of(const SimulationDef& def);

  /// Steps that the simulation had done where the recording begins.
  std::uint64_t first_step() const;
  std::size_t step_count() const { return hashes_.size(); }
  std::size_t tool_count() const { return tool_count_; }
  std::span<const Pose> poses(std::size_t step) const { return {poses_.data() + step * tool_count_, tool_count_}; }
  std::uint64_t state_hash(std::size_t step) const { return hashes_[step]; }
  /// Does to `sim` what the host did to fragments, node forces and tools before the step. Throws Error(corrupt) when
  /// that cannot be done.
  void apply_changes(std::size_t step, Simulation& sim) const;
  /// A simulation at the recording's start. Of `how` only what changes no bit counts: audit, kernel, threads.
  Simulation start(const StepSettings& how = {}) const;

  /// The file is replaced only when all is written. Loading throws Error: io, corrupt, version.
  void save(const std::filesystem::path& path) const;
  static Recording load(const std::filesystem::path& path);

 private:
  struct FragmentChange {
    std::uint64_t step;  // that came after it
    std::uint32_t fragment;
    FragmentState state;
  };
  struct ForceChange {
    std::uint64_t step;  // that came after it
    std::uint32_t node;
    Vec3 force;
  };
  struct Suspension {
    std::uint64_t step;  // that came after it
    std::uint32_t tool;
    bool suspended;
  };
  struct DefinitionAt {
    std::uint64_t step;  // that came after it
    Vector<std::uint8_t> settings;
  };
  Recording() = default;
  void load_fragment_changes(ByteReader& in, const std::string& name);
  void load_force_changes(ByteReader& in, const std::string& name);
  void load_suspensions(ByteReader& in, const std::string& name);
  void load_changes(ByteReader& in, const std::string& name);
  void apply_change(const DefinitionAt& change, Simulation& sim) const;
  Vector<std::uint8_t> definition_, snapshot_;
  std::size_t tool_count_ = 0;  // and attachments
  Vector<Pose> poses_;          // (step_count x tool_count)
  Vector<std::uint64_t> hashes_;
  Vector<FragmentChange> fragment_changes_;  // in the order of time
  Vector<ForceChange> force_changes_;        // in the order of time
  Vector<Suspension> suspensions_;           // in the order of time
  Vector<DefinitionAt> changes_;             // in the order of time
};

/// The first step whose state differs from the recorded one; nothing when all agree.
/// `after_step` is called after each step, with the simulation; it may return false to stop early.
std::optional<std::size_t> replay(const Recording& recording, Simulation& from_start,
                                  const std::function<bool(const Simulation&)>& after_step = {});

}  // namespace crumble
