// The balls' state as bytes and as a hash: who takes part, and the pairs that remember something. Which other pairs
// the list holds is left out: it depends on when it was made.
#include <cmath>
#include <numeric>
#include <string>

#include "ball_contacts_impl.hpp"
#include "crumble/base/error.hpp"

namespace crumble {
namespace {

void require(bool good, const char* what) {
  if (!good) throw Error(Code::corrupt, std::string("snapshot holds impossible balls: ") + what);
}

}  // namespace

void BallContacts::Impl::add_to(Hash& hash) const noexcept {
  roster.add_to(hash);
  for (std::size_t k = 0; k < pairs_.count; ++k) {
    if (!pairs_.remembers(k, step_)) continue;
    const BallPair pair(pairs_.keys[k]);
    const Vec3 shear = shear_of(k);
    hash.add(BallPair::key(places_[pair.first], places_[pair.second]));
    for (const double value : {pairs_.reach[k], shear.x(), shear.y(), shear.z()}) hash.add(value);
  }
}

void BallContacts::Impl::save(ByteWriter& out) const {
  roster.save(out);
  std::uint64_t count = 0;
  for (std::size_t k = 0; k < pairs_.count; ++k) count += pairs_.remembers(k, step_);
  out.put(count);
  for (std::size_t k = 0; k < pairs_.count; ++k) {
    if (!pairs_.remembers(k, step_)) continue;
    const BallPair pair(pairs_.keys[k]);
    const Vec3 shear = shear_of(k);
    out.put(places_[pair.first]), out.put(places_[pair.second]), out.put(pairs_.reach[k]);
    out.put(shear.x()), out.put(shear.y()), out.put(shear.z());
  }
}

void BallContacts::Impl::load(ByteReader& in) {
  roster.load(in);
  clear_outcome();
  follow_roster();
  load_pairs(in);
}

// Enough of each pair for the search that the next find() begins with: until then the places are the nodes themselves.
void BallContacts::Impl::load_pairs(ByteReader& in) {
  const auto count = in.get<std::uint64_t>();
  require(count <= pairs_.keys.size(), "the number of pairs");
  pairs_.count = static_cast<std::size_t>(count);
  places_.resize(settings_.size());
  std::iota(places_.begin(), places_.end(), 0u);
  for (std::size_t k = 0; k < pairs_.count; ++k) {
    const auto a = in.get<std::uint32_t>(), b = in.get<std::uint32_t>();
    require(a < b && b < settings_.size(), "a pair");
    pairs_.keys[k] = BallPair::key(a, b);
    require(k == 0 || pairs_.keys[k - 1] < pairs_.keys[k], "the order of pairs");
    pairs_.reach[k] = in.get<double>();
    const double sum = settings_[a].radius + settings_[b].radius;
    pairs_.sum[k] = sum * sum;
    pairs_.touched_at[k] = step_;
    require(pairs_.reach[k] >= 0 && pairs_.reach[k] <= pairs_.sum[k], "a contact distance");
    for (double* axis : {&pairs_.shear.x[k], &pairs_.shear.y[k], &pairs_.shear.z[k]}) {
      *axis = in.get<double>();
      require(std::isfinite(*axis), "a shear");
    }
  }
}

}  // namespace crumble
