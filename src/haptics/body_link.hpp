// Where a tick gets the body's answer from: a step within it, or a model of a step that somebody else did.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "crumble/base/memory.hpp"
#include "crumble/haptics/loop.hpp"
#include "haptics/changes.hpp"

namespace crumble::haptics {

/// The body to one hand's tool.
struct Answer {
  Wrench wrench;                  // on the tool
  Mat3 stiffness = Mat3::Zero();  // - d force / d translation, neighbours held, N/m
  Mat3 holding = Mat3::Zero();    // the same if no contact slid
  std::uint32_t contacts = 0;
  bool engaged = false;     // the tool has been outside the body since it was last suspended, as of `order`
  std::uint64_t order = 0;  // the tick whose poses this is the answer to
};

/// One bit for each hand.
using HandMask = std::uint32_t;

/// Does the steps, whoever calls: tells publishers and recording.
class Stepper {
 public:
  Stepper(Simulation& sim, Vector<std::uint32_t> holders) : sim_(sim), holders_(std::move(holders)) {}

  /// Hands in `suspended` do not touch.
  void step(std::span<const Pose> poses, HandMask suspended) noexcept;
  /// All touch again, once they have been outside.
  void resume() noexcept { suspend(0); }
  /// Makes the oldest change that waits, if there is one; step() does so too.
  bool make_change() noexcept;
  const Simulation& sim() const noexcept { return sim_; }
  std::size_t hand_count() const noexcept { return holders_.size(); }
  std::uint32_t holder(std::size_t hand) const noexcept { return holders_[hand]; }

  Changes changes;  // of the simulation's definition

  // While nobody steps
  Vector<StatePublisher*> publishers;
  Recording* recording = nullptr;

 private:
  void suspend(HandMask hands) noexcept;
  template <class Add>
  void record(Add&& add) noexcept;

  Simulation& sim_;
  Vector<std::uint32_t> holders_;
  HandMask suspended_ = 0;  // in the last step
};

class BodyLink : public Allocated {
 public:
  virtual ~BodyLink() = default;

  /// To the tool of `hand` if it stands at `tool`.
  virtual Answer at(std::size_t hand, const Pose& tool) noexcept = 0;
  /// The tools are at `poses` (by holder) in tick `order` (from 1).
  virtual void advance(std::span<const Pose> poses, HandMask suspended, std::uint64_t order) noexcept = 0;
  /// Time since the newest answer came, s; 0 where every tick has its own.
  virtual double age() const noexcept = 0;
  /// Of the newest step.
  virtual Code status() const noexcept = 0;
  virtual std::uint64_t steps() const noexcept = 0;
  /// Simulated s.
  virtual double time() const noexcept = 0;
  /// The body's own thread, where it has one.
  virtual void start() {}
  virtual void stop() noexcept {}
};

std::unique_ptr<BodyLink> make_direct_link(Stepper& stepper);
std::unique_ptr<BodyLink> make_model_link(Stepper& stepper, const LoopDef& def);

}  // namespace crumble::haptics
