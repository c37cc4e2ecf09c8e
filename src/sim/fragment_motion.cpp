// How fragments move and meet: which are loose, what they weigh, and how they push each other.
#include <algorithm>
#include <limits>

#include "crumble/base/memory.hpp"
#include "crumble/sim/simulation.hpp"

namespace crumble {
namespace {

constexpr std::uint32_t kNotLoose = 0xffffffffu;

}  // namespace

std::optional<BallContacts> Simulation::make_balls() const {
  if (!def_.step.ball_contact) return {};
  const std::size_t nodes = network_.node_count();
  Vector<double> lengths(nodes), stiffnesses(nodes), counts(nodes);
  for (std::size_t s = 0; s < network_.spring_count(); ++s) {
    for (const std::uint32_t node : network_.springs[s]) {
      lengths[node] += network_.rest_lengths[s], stiffnesses[node] += network_.stiffnesses[s], counts[node] += 1;
    }
  }
  Vector<std::uint8_t> on_surface;
  for (std::size_t i = 0; i < nodes; ++i) {
    lengths[i] *= 0.5 / counts[i], stiffnesses[i] /= counts[i];  // half the mean length: the ball's radius
    on_surface.push_back(def_.mesh.kinds[i] != NodeKind::inside);
  }
  return BallContacts({network_.springs, lengths, network_.masses, stiffnesses, network_.stiffness_sums, on_surface,
                       network_.fixed, def_.ball_friction, coefficients_.substep});
}

// After fragments came off, fell asleep, woke or were removed, as of the end of step `now`; `cuts`: springs that the
// balls do not know of yet.
void Simulation::regroup(std::uint64_t now, std::span<const std::uint32_t> cuts) noexcept {
  find_loose_fragments(now);
  if (balls_) balls_->update(cuts, fragments_.labels(), ball_fragments());
}

// Loose are fragments that are active and have no fixed node. One that has just come off goes with its parent until the
// springs between them have faded: they would throw a crumb that nothing brakes any more.
void Simulation::find_loose_fragments(std::uint64_t now) noexcept {
  Vector<std::uint32_t>& group_of = loose_group_of_;
  find_leaders(now);
  std::uint32_t groups = 0;
  std::fill(loose_first_.begin(), loose_first_.begin() + fragments_.count() + 1, 0u);
  for (std::uint32_t f = 0; f < fragments_.count(); ++f) {
    if (group_of[f] == kNotLoose) continue;
    group_of[f] = group_of[f] == f ? groups++ : group_of[group_of[f]];
    loose_first_[group_of[f] + 1] += fragments_.record(f).node_count;
  }
  for (std::uint32_t g = 0; g < groups; ++g) loose_first_[g + 1] += loose_first_[g];
  const std::span<const std::uint32_t> labels = fragments_.labels();
  for (std::uint32_t node = 0; node < labels.size(); ++node) {
    if (labels[node] == kNoFragment) continue;
    ball_fragments_[labels[node]].mass += network_.masses[node];
    const std::uint32_t group = group_of[labels[node]];
    if (group != kNotLoose) loose_nodes_[loose_first_[group]++] = node;  // loose_first_ runs ahead ...
  }
  for (std::uint32_t g = groups; g > 0; --g) loose_first_[g] = loose_first_[g - 1];  // ... and is put back
  loose_first_[0] = 0;
  solver_->set_loose({std::span(loose_first_).first(groups > 0 ? groups + 1 : 0),
                      std::span(loose_nodes_).first(loose_first_[groups])});
}

// In place of a group each fragment gets the one that it moves with: itself, or one of a lower id.
void Simulation::find_leaders(std::uint64_t now) noexcept {
  const std::span<const std::uint32_t> labels = fragments_.labels();
  for (std::uint32_t f = 0; f < fragments_.count(); ++f) {
    ball_fragments_[f] = {0, fragment_states_[f] == FragmentState::asleep};
  }
  for (const std::uint32_t node : def_.fixed_nodes) {
    if (labels[node] != kNoFragment) ball_fragments_[labels[node]].mass = std::numeric_limits<double>::infinity();
  }
  regroup_at_ = std::numeric_limits<std::uint64_t>::max();
  const std::uint64_t fading = fade_substeps_ / coefficients_.substeps + 2;
  for (std::uint32_t f = 0; f < fragments_.count(); ++f) {
    const FragmentRecord& record = fragments_.record(f);
    const bool active = fragment_states_[f] == FragmentState::active && def_.step.drag_frame == DragFrame::fragment;
    loose_group_of_[f] = active && ball_fragments_[f].mass == 0 ? f : kNotLoose;
    const bool follows = record.parent != kNoFragment && record.born + fading > now &&
                         fragment_states_[record.parent] == FragmentState::active;
    if (loose_group_of_[f] == kNotLoose || !follows) continue;
    loose_group_of_[f] = loose_group_of_[record.parent];
    regroup_at_ = std::min(regroup_at_, record.born + fading);
  }
}

// Balls push each other in the solve that follows.
void Simulation::touch_fragments() noexcept {
  if (!balls_) return;
  const std::span<const std::uint32_t> nodes = balls_->nodes();
  if (nodes.empty()) return;
  const auto first = [&](VecArray& all) {
    return VecSpan{std::span(all.x).first(nodes.size()), std::span(all.y).first(nodes.size()),
                   std::span(all.z).first(nodes.size())};
  };
  const VecSpan positions = first(ball_positions_), velocities = first(ball_velocities_);
  solver_->read_nodes(nodes, positions, velocities);
  balls_->find(positions, velocities);
  for (std::size_t k = 0; k < balls_->pushed().size(); ++k) solver_->push(balls_->pushed()[k], balls_->forces()[k]);
  if (balls_->roused().empty()) return;
  for (const std::uint32_t fragment : balls_->roused()) {
    if (fragment_states_[fragment] != FragmentState::asleep) continue;
    wake(fragment);
    ++counters_.woken;
  }
  regroup(last_step(), {});
}

std::span<const BallFragment> Simulation::ball_fragments() const noexcept {
  return {ball_fragments_.data(), fragments_.count()};
}

}  // namespace crumble
