#include "crumble/contact/ball_contacts.hpp"

#include <algorithm>
#include <string>

#include "ball_contacts_impl.hpp"
#include "crumble/base/error.hpp"

namespace crumble {
namespace {

constexpr double kFragmentShare = 0.25;  // of M / tau^2
constexpr double kNodeShare = 0.5;       // of m_i / tau^2
constexpr double kSpringsShare = 0.125;  // of D_i

void require_size(const char* field, std::size_t size, std::size_t node_count) {
  if (size == node_count) return;
  throw Error(Code::out_of_range, std::string(field) + " has " + std::to_string(size) + " values, must have " +
                                      std::to_string(node_count) + ", one per node");
}

std::string at(const char* field, std::size_t index) {
  return std::string(field) + "[" + std::to_string(index) + "]";
}

const BallSetup& checked(const BallSetup& setup) {
  const std::size_t count = setup.radii.size();
  require_size("balls.masses", setup.masses.size(), count);
  require_size("balls.stiffnesses", setup.stiffnesses.size(), count);
  require_size("balls.stiffness_sums", setup.stiffness_sums.size(), count);
  require_size("balls.on_surface", setup.on_surface.size(), count);
  require_size("balls.fixed", setup.fixed.size(), count);
  for (std::size_t i = 0; i < count; ++i) {
    require_positive(at("balls.radii", i), setup.radii[i]);
    require_positive(at("balls.masses", i), setup.masses[i]);
    require_in_range(at("balls.stiffnesses", i), setup.stiffnesses[i], 0, 1e12);
    require_in_range(at("balls.stiffness_sums", i), setup.stiffness_sums[i], 0, 1e12);
  }
  check(setup.friction);
  require_positive("balls.tau", setup.tau);
  return setup;
}

std::size_t pair_room(std::size_t node_count) {
  return std::min(BallContacts::kPairsPerNode * node_count, BallContacts::kMostPairs);
}

double largest(std::span<const double> radii) {
  return radii.empty() ? 0 : *std::max_element(radii.begin(), radii.end());
}

}  // namespace

BallContacts::Impl::Impl(const BallSetup& setup)
    : roster(checked(setup)),
      search(setup.radii.size(), pair_room(setup.radii.size())),
      law_(ball_law()),
      friction_(setup.friction),
      tau_(setup.tau),
      largest_radius_(largest(setup.radii)),
      next_margin_(least_margin()),
      pairs_(pair_room(setup.radii.size())),
      old_pairs_(pairs_),
      pair_stiffness_(pair_room(setup.radii.size())),
      contact_normals_(pair_room(setup.radii.size())),
      contact_forces_(pair_room(setup.radii.size())),
      fragments_(setup.radii.size()),
      is_paired_(setup.radii.size()),
      own_stiffness_(setup.radii.size()),
      most_stiffness_(setup.radii.size()),
      contacts_(setup.radii.size()),
      stiffness_(setup.radii.size()),
      force_sums_(setup.radii.size()),
      fragment_stiffness_(setup.radii.size()),
      fragment_contacts_(setup.radii.size()),
      is_roused_(setup.radii.size()),
      block_{} {
  const std::size_t node_count = setup.radii.size(), room = pair_room(node_count);
  for (std::size_t i = 0; i < node_count; ++i) {
    settings_.push_back({setup.radii[i], setup.stiffnesses[i], kSpringsShare * setup.stiffness_sums[i],
                         kNodeShare * setup.masses[i] / (setup.tau * setup.tau)});
  }
  touching_pairs_.reserve(room);
  touching_before_.reserve(room);
  pushed.reserve(node_count);
  forces.reserve(node_count);
  roused.reserve(node_count);
  places_.reserve(node_count);
  radii_.reserve(node_count);
  idle_.reserve(node_count);
  touched_.reserve(node_count + 1);
}

void BallContacts::Impl::reset() noexcept {
  roster.reset();
  pairs_.count = 0;
  clear_outcome();
  follow_roster();
}

void BallContacts::Impl::redefine(Impl& next) noexcept {
  settings_.swap(next.settings_);
  friction_ = next.friction_;
  tau_ = next.tau_;
  roster.redefine(next.roster);
}

void BallContacts::Impl::clear_outcome() noexcept {
  touching_pairs_.clear();
  pushed.clear();
  forces.clear();
  roused.clear();
}

void BallContacts::Impl::update(std::span<const std::uint32_t> cuts, std::span<const std::uint32_t> labels,
                                std::span<const BallFragment> fragments) noexcept {
  roster.update(cuts, labels, fragments);
  follow_roster();
}

// What cannot move sets no limit, and where a node is fixed only the springs do: the room brakes the others.
void BallContacts::Impl::follow_roster() noexcept {
  forget_contacts();
  for (std::size_t id = 0; id < roster.fragments().size(); ++id) {
    const BallFragment& fragment = roster.fragments()[id];
    fragment_stiffness_[id] = fragment.asleep ? kCannotMove : kFragmentShare * fragment.mass / (tau_ * tau_);
  }
  const auto lighter = [](const BallFragment& a, const BallFragment& b) { return a.mass < b.mass; };
  const auto heaviest = std::max_element(roster.fragments().begin(), roster.fragments().end(), lighter);
  const auto idle_fragment = static_cast<std::uint32_t>(heaviest - roster.fragments().begin());
  radii_.clear();
  idle_.clear();
  for (std::size_t place = 0; place < roster.nodes().size(); ++place) {
    const std::uint32_t node = roster.nodes()[place], fragment = roster.fragment_of(node);
    const Setting& setting = settings_[node];
    const double by_mass = fragment_stiffness_[fragment] < kCannotMove ? setting.stiffness_by_mass : kCannotMove;
    radii_.push_back(setting.radius);
    idle_.push_back(fragment == idle_fragment && roster.is_covered(node));
    fragments_[place] = fragment;
    own_stiffness_[place] = setting.stiffness;
    most_stiffness_[place] = roster.moves(node) ? std::min(setting.stiffness_by_springs, by_mass) : kCannotMove;
  }
}

BallContacts::BallContacts(const BallSetup& setup) : impl_(std::make_unique<Impl>(setup)) {}
BallContacts::~BallContacts() = default;
BallContacts::BallContacts(const BallContacts& other) : impl_(std::make_unique<Impl>(*other.impl_)) {}
BallContacts::BallContacts(BallContacts&&) noexcept = default;
BallContacts& BallContacts::operator=(const BallContacts& other) {
  return *this = BallContacts(other);
}
BallContacts& BallContacts::operator=(BallContacts&&) noexcept = default;

void BallContacts::update(std::span<const std::uint32_t> cuts, std::span<const std::uint32_t> labels,
                          std::span<const BallFragment> fragments) noexcept {
  impl_->update(cuts, labels, fragments);
}
void BallContacts::find(const VecView& positions, const VecView& velocities) noexcept {
  impl_->find(positions, velocities);
}
void BallContacts::reset() noexcept {
  impl_->reset();
}
void BallContacts::redefine(BallContacts& next) noexcept {
  impl_->redefine(*next.impl_);
}
void BallContacts::save(ByteWriter& out) const {
  impl_->save(out);
}
void BallContacts::load(ByteReader& in) {
  Impl next(*impl_);
  next.load(in);
  *impl_ = std::move(next);
}
void BallContacts::add_to(Hash& hash) const noexcept {
  impl_->add_to(hash);
}
std::span<const std::uint32_t> BallContacts::nodes() const noexcept {
  return impl_->roster.nodes();
}
std::size_t BallContacts::contact_count() const noexcept {
  return impl_->contact_count();
}
BallContact BallContacts::contact(std::size_t index) const noexcept {
  return impl_->contact(index);
}
std::span<const std::uint32_t> BallContacts::pushed() const noexcept {
  return impl_->pushed;
}
std::span<const Vec3> BallContacts::forces() const noexcept {
  return impl_->forces;
}
std::span<const std::uint32_t> BallContacts::roused() const noexcept {
  return impl_->roused;
}
std::size_t BallContacts::dropped_pairs() const noexcept {
  return impl_->search.dropped();
}
std::uint64_t BallContacts::searches() const noexcept {
  return impl_->searches;
}

}  // namespace crumble
