// Who touches whom, and the forces. How stiff a pair may be is decided anew in every step, by what touches in it: n
// pairs of a fragment get 1 / n of what its mass can bear each (ball_forces.cpp), and n pairs of a node 1 / n of what
// its mass can and of an eighth of the springs that it once had, so that the time step which suits the network suits it
// with contacts too.
#include <algorithm>
#include <utility>

#include "ball_contacts_impl.hpp"

namespace crumble {

void BallContacts::Impl::find(const VecView& positions, const VecView& velocities) noexcept {
  pushed.clear();
  forces.clear();
  roused.clear();
  ++step_;
  update_list(positions, velocities);
  find_touching(positions);
  if (touched_.empty() || !std::ranges::equal(touching_pairs_, touching_before_)) {
    forget_contacts();
    count_contacts();
    share_stiffness();
  }
  push_pairs(positions, velocities);
  collect_forces();
  if (roster.changed()) roster.settle();
}

// A contact distance grows with the distance. No branch: which pairs touch no processor could foresee.
void BallContacts::Impl::find_touching(const VecView& positions) noexcept {
  const std::size_t count = pairs_.count;
  const std::uint64_t* const keys = pairs_.keys.data();
  const double *const x = positions.x.data(), *const y = positions.y.data(), *const z = positions.z.data();
  const double* const sums = pairs_.sum.data();
  double* const reaches = pairs_.reach.data();
  std::swap(touching_pairs_, touching_before_);
  touching_pairs_.resize(count);
  std::uint32_t* const touching = touching_pairs_.data();
  std::size_t found = 0;
  for (std::uint32_t k = 0; k < count; ++k) {
    const auto [i, j] = BallPair(keys[k]);
    const double dx = x[i] - x[j], dy = y[i] - y[j], dz = z[i] - z[j];
    const double distance = (dx * dx + dy * dy) + dz * dz;
    const double wide = distance < sums[k] ? distance : sums[k];
    const double reach = wide > reaches[k] ? wide : reaches[k];
    reaches[k] = reach;
    touching[found] = k;
    found += distance < reach;
  }
  touching_pairs_.resize(found);
}

void BallContacts::Impl::forget_contacts() noexcept {
  for (const std::uint32_t place : touched_) contacts_[place] = fragment_contacts_[fragments_[place]] = 0;
  touched_.clear();
}

void BallContacts::Impl::count_contacts() noexcept {
  touched_.resize(roster.nodes().size() + 1);  // one more than there can be
  std::uint32_t* const touched = touched_.data();
  std::uint32_t* const contacts = contacts_.data();
  std::size_t count = 0;
  for (const std::uint32_t k : touching_pairs_) {
    const auto [i, j] = BallPair(pairs_.keys[k]);
    touched[count] = i;
    count += contacts[i]++ == 0;
    touched[count] = j;
    count += contacts[j]++ == 0;
  }
  touched_.resize(count);
  for (const std::uint32_t place : touched_) fragment_contacts_[fragments_[place]] += contacts_[place];
}

void BallContacts::Impl::share_stiffness() noexcept {
  for (const std::uint32_t place : touched_) {
    const std::uint32_t fragment = fragments_[place];
    stiffness_[place] = std::min(most_stiffness_[place] / contacts_[place],
                                 fragment_stiffness_[fragment] / fragment_contacts_[fragment]);
  }
  for (std::size_t t = 0; t < touching_pairs_.size(); ++t) {
    const auto [i, j] = BallPair(pairs_.keys[touching_pairs_[t]]);
    pair_stiffness_[t] = std::min({(own_stiffness_[i] + own_stiffness_[j]) / 2, stiffness_[i], stiffness_[j]});
  }
}

void BallContacts::Impl::push_pairs(const VecView& positions, const VecView& velocities) noexcept {
  for (std::size_t begin = 0; begin < touching_pairs_.size(); begin += BallBlock::kSize) {
    const std::size_t count = std::min(BallBlock::kSize, touching_pairs_.size() - begin);
    const auto pairs = std::span<const std::uint32_t>(touching_pairs_).subspan(begin, count);
    fill_block(pairs, positions, velocities);
    std::copy_n(pair_stiffness_.begin() + begin, count, block_.stiffness);
    law_(block_, count, friction_, tau_);
    read_block(begin, pairs);
  }
}

void BallContacts::Impl::fill_block(std::span<const std::uint32_t> pairs, const VecView& positions,
                                    const VecView& velocities) noexcept {
  for (std::size_t t = 0; t < pairs.size(); ++t) {
    const std::uint32_t k = pairs[t];
    const auto [i, j] = BallPair(pairs_.keys[k]);
    const bool touched = pairs_.touched_at[k] + 1 == step_;
    pairs_.touched_at[k] = step_;
    block_.reach[t] = pairs_.reach[k];
    block_.x[t] = positions.x[i] - positions.x[j];
    block_.y[t] = positions.y[i] - positions.y[j];
    block_.z[t] = positions.z[i] - positions.z[j];
    block_.vx[t] = velocities.x[i] - velocities.x[j];
    block_.vy[t] = velocities.y[i] - velocities.y[j];
    block_.vz[t] = velocities.z[i] - velocities.z[j];
    block_.shear_x[t] = touched ? pairs_.shear.x[k] : 0;
    block_.shear_y[t] = touched ? pairs_.shear.y[k] : 0;
    block_.shear_z[t] = touched ? pairs_.shear.z[k] : 0;
  }
}

void BallContacts::Impl::read_block(std::size_t begin, std::span<const std::uint32_t> pairs) noexcept {
  const std::size_t count = pairs.size();
  std::copy_n(block_.x, count, contact_normals_.x.begin() + begin);
  std::copy_n(block_.y, count, contact_normals_.y.begin() + begin);
  std::copy_n(block_.z, count, contact_normals_.z.begin() + begin);
  std::copy_n(block_.fx, count, contact_forces_.x.begin() + begin);
  std::copy_n(block_.fy, count, contact_forces_.y.begin() + begin);
  std::copy_n(block_.fz, count, contact_forces_.z.begin() + begin);
  for (std::size_t t = 0; t < count; ++t) {
    const std::uint32_t k = pairs[t];
    const auto [i, j] = BallPair(pairs_.keys[k]);
    pairs_.shear.x[k] = block_.shear_x[t], pairs_.shear.y[k] = block_.shear_y[t], pairs_.shear.z[k] = block_.shear_z[t];
    ForceSum &first = force_sums_[i], &second = force_sums_[j];
    first.x += block_.fx[t], first.y += block_.fy[t], first.z += block_.fz[t];
    second.x -= block_.fx[t], second.y -= block_.fy[t], second.z -= block_.fz[t];
    if (block_.approach[t] > kRouseSpeed) rouse(fragments_[i], fragments_[j]);
  }
}

BallContact BallContacts::Impl::contact(std::size_t index) const noexcept {
  const BallPair pair(pairs_.keys[touching_pairs_[index]]);
  return {places_[pair.first], places_[pair.second], contact_normals_[index], contact_forces_[index]};
}

void BallContacts::Impl::rouse(std::uint32_t first, std::uint32_t second) noexcept {
  for (const std::uint32_t fragment : {first, second}) {
    if (!roster.fragments()[fragment].asleep || is_roused_[fragment]) continue;
    is_roused_[fragment] = 1;
    roused.push_back(fragment);
  }
}

void BallContacts::Impl::collect_forces() noexcept {
  pushed.resize(touched_.size());
  forces.resize(touched_.size());
  std::size_t count = 0;
  for (const std::uint32_t place : touched_) {
    const ForceSum sum = std::exchange(force_sums_[place], {});
    pushed[count] = roster.nodes()[place];
    forces[count] = {sum.x, sum.y, sum.z};
    count += most_stiffness_[place] < kCannotMove;
  }
  pushed.resize(count);
  forces.resize(count);
  for (const std::uint32_t fragment : roused) is_roused_[fragment] = 0;
}

}  // namespace crumble
