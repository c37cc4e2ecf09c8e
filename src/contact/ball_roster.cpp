#include "ball_roster.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "crumble/base/error.hpp"

namespace crumble {

BallRoster::BallRoster(const BallSetup& setup)
    : graph_(share_new<SpringGraph>(setup.radii.size(), setup.springs)),
      on_surface_(setup.on_surface.begin(), setup.on_surface.end()),
      fixed_(setup.fixed.begin(), setup.fixed.end()),
      joints_(setup.springs.size()),
      labels_(setup.radii.size()),
      labels_before_(setup.radii.size()),
      exposures_(setup.radii.size()) {
  const std::size_t node_count = setup.radii.size();
  fragments_.reserve(node_count);
  members_.reserve(node_count);
  newcomers_.reserve(node_count);
  fresh_cuts_.reserve(setup.springs.size());
  nodes_.reserve(node_count);
  reset();
}

void BallRoster::reset() noexcept {
  std::fill(joints_.begin(), joints_.end(), kIntact);
  std::fill(labels_.begin(), labels_.end(), 0u);
  std::fill(labels_before_.begin(), labels_before_.end(), 0u);
  std::fill(exposures_.begin(), exposures_.end(), kCovered);
  fragments_.assign(1, {});
  members_.clear();
  for (std::uint32_t node = 0; node < on_surface_.size(); ++node) {
    if (on_surface_[node]) members_.push_back(node);
  }
  newcomers_.clear();
  fresh_cuts_.clear();
  nodes_.clear();
  changed_ = false;
}

void BallRoster::update(std::span<const std::uint32_t> cuts, std::span<const std::uint32_t> labels,
                        std::span<const BallFragment> fragments) noexcept {
  for (const std::uint32_t spring : cuts) cut(spring);
  changed_ = true;
  admit_newcomers();
  for (const std::uint32_t node : members_) labels_[node] = labels[node];
  fragments_.assign(fragments.begin(), fragments.end());
  gather_nodes();
}

void BallRoster::cut(std::uint32_t spring) noexcept {
  if (joints_[spring] != kIntact) return;
  joints_[spring] = kFreshCut;
  fresh_cuts_.push_back(spring);
  for (const std::uint32_t node : graph_->springs[spring]) expose(node);
}

void BallRoster::expose(std::uint32_t node) noexcept {
  if (exposures_[node] != kCovered) return;
  exposures_[node] = kFresh;
  if (!on_surface_[node]) newcomers_.push_back(node);
}

// Merges from the back, in place.
void BallRoster::admit_newcomers() noexcept {
  std::sort(newcomers_.begin(), newcomers_.end());
  std::size_t old = members_.size(), fresh = newcomers_.size(), to = old + fresh;
  members_.resize(to);
  while (fresh > 0) {
    const bool take_old = old > 0 && members_[old - 1] > newcomers_[fresh - 1];
    members_[--to] = take_old ? members_[--old] : newcomers_[--fresh];
  }
  newcomers_.clear();
}

void BallRoster::gather_nodes() noexcept {
  const auto there = std::count_if(fragments_.begin(), fragments_.end(), [](const auto& f) { return f.mass > 0; });
  nodes_.clear();
  for (const std::uint32_t node : members_) {
    if (labels_[node] != kRemoved && (there > 1 || exposures_[node] != kCovered)) nodes_.push_back(node);
  }
}

BallRoster::Joint BallRoster::joint(std::uint32_t a, std::uint32_t b) const noexcept {
  const auto neighbors = graph_->neighbors_of(a);
  const auto place = std::find(neighbors.begin(), neighbors.end(), b);
  return place == neighbors.end() ? kCut : joints_[graph_->springs_of(a)[place - neighbors.begin()]];
}

bool BallRoster::could_touch(std::uint32_t a, std::uint32_t b) const noexcept {
  const bool bare = exposures_[a] == kExposed && exposures_[b] == kExposed;
  if (labels_before_[a] == labels_before_[b]) return bare && joint(a, b) == kCut;
  return (bare || ((on_surface_[a] || exposures_[a] == kExposed) && (on_surface_[b] || exposures_[b] == kExposed)));
}

void BallRoster::settle() noexcept {
  for (const std::uint32_t spring : fresh_cuts_) {
    joints_[spring] = kCut;
    for (const std::uint32_t node : graph_->springs[spring]) exposures_[node] = kExposed;
  }
  fresh_cuts_.clear();
  for (const std::uint32_t node : members_) labels_before_[node] = labels_[node];
  changed_ = false;
}

void BallRoster::add_to(Hash& hash) const noexcept {
  hash.add({reinterpret_cast<const std::uint8_t*>(joints_.data()), joints_.size()});
  for (const std::uint32_t node : members_) hash.add(std::uint64_t{labels_[node]} << 32 | labels_before_[node]);
  for (const BallFragment& fragment : fragments_) hash.add(fragment.asleep ? -fragment.mass : fragment.mass);
}

void BallRoster::save(ByteWriter& out) const {
  for (const Joint joint : joints_) out.put(static_cast<std::uint8_t>(joint));
  for (const std::uint32_t node : members_) out.put(labels_[node]), out.put(labels_before_[node]);
  out.put(std::uint64_t{fragments_.size()});
  for (const BallFragment& f : fragments_) out.put(f.mass), out.put(static_cast<std::uint8_t>(f.asleep));
}

namespace {

void require(bool good, const char* what) {
  if (!good) throw Error(Code::corrupt, std::string("snapshot holds impossible balls: ") + what);
}

}  // namespace

void BallRoster::load(ByteReader& in) {
  reset();
  load_joints(in);
  admit_newcomers();
  for (const std::uint32_t node : members_) {
    labels_[node] = in.get<std::uint32_t>();
    labels_before_[node] = in.get<std::uint32_t>();
  }
  const auto count = in.get<std::uint64_t>();
  require(count >= 1 && count <= labels_.size(), "the number of fragments");
  fragments_.clear();
  for (std::uint64_t id = 0; id < count; ++id) {
    BallFragment f;
    f.mass = in.get<double>();
    const auto asleep = in.get<std::uint8_t>();
    require(f.mass >= 0 && asleep < 2, "a fragment");
    f.asleep = asleep == 1;
    fragments_.push_back(f);
  }
  for (const std::uint32_t node : members_) {
    require(labels_[node] < count || labels_[node] == kRemoved, "a label");
  }
  gather_nodes();
  changed_ = true;
}

void BallRoster::load_joints(ByteReader& in) {
  for (std::uint32_t spring = 0; spring < joints_.size(); ++spring) {
    const auto joint = in.get<std::uint8_t>();
    require(joint <= kCut, "a spring");
    joints_[spring] = static_cast<Joint>(joint);
    if (joint == kFreshCut) fresh_cuts_.push_back(spring);
    if (joint == kIntact) continue;
    for (const std::uint32_t node : graph_->springs[spring]) {
      expose(node);
      if (joint == kCut) exposures_[node] = kExposed;
    }
  }
}

}  // namespace crumble
