// What the kernels compute, one lane after the other.
#include <algorithm>
#include <cmath>

#include "network/kernels.hpp"

namespace crumble {
namespace {

template <class Real>
struct Pull {
  Real x, y, z;  // on the lower end
  bool overlong;
};

template <class Real>
Pull<Real> pull(const ForcePass<Real>& pass, std::uint32_t lane, Real dx, Real dy, Real dz) {
  const Real square = (dx * dx + dy * dy) + dz * dz, stiffness = pass.stiffness[lane];
  Real factor = square >= kLeastSquare<Real> ? stiffness - pass.rest_force[lane] / std::sqrt(square) : 0;
  const bool overlong = factor > pass.give * stiffness && pass.whole[lane];
  if (overlong) factor *= pass.cut_share;
  return {factor * dx, factor * dy, factor * dz, overlong};
}

template <class Real>
std::size_t sum_segments(const ForcePass<Real>& pass) {
  std::size_t count = 0;
  const Real *x = pass.at.axis(0), *y = pass.at.axis(1), *z = pass.at.axis(2);
  Real *force_x = pass.force.axis(0), *force_y = pass.force.axis(1), *force_z = pass.force.axis(2);
  for (const Segment& segment : pass.segments) {
    const std::uint32_t slots = segment.blocks * kLanes;
    Real fx[kMostBlocks * kLanes] = {}, fy[kMostBlocks * kLanes] = {}, fz[kMostBlocks * kLanes] = {};
    std::uint32_t lane = segment.lane;
    for (std::uint32_t way = 0; way < segment.ways; ++way) {
      for (std::uint32_t s = 0; s < slots; ++s, ++lane) {
        const std::uint32_t i = segment.first + s, j = i + pass.offsets[segment.first_way + way];
        const Pull<Real> p = pull(pass, lane, x[j] - x[i], y[j] - y[i], z[j] - z[i]);
        force_x[j] -= p.x, force_y[j] -= p.y, force_z[j] -= p.z;
        fx[s] += p.x, fy[s] += p.y, fz[s] += p.z;
        if (p.overlong) pass.overlong[count++] = lane;
      }
    }
    for (std::uint32_t s = 0; s < slots; ++s) {
      const std::uint32_t i = segment.first + s;
      force_x[i] += fx[s], force_y[i] += fy[s], force_z[i] += fz[s];
    }
  }
  return count;
}

template <class Real>
std::size_t sum_batches(const ForcePass<Real>& pass) {
  std::size_t count = 0;
  std::uint32_t lane = pass.batch_lane;
  for (const Batch& batch : pass.batches) {
    for (std::uint32_t l = 0; l < kLanes; ++l, ++lane) {
      const Real* a = pass.at_packed + 4 * std::size_t{batch.lower[l]};
      const Real* b = pass.at_packed + 4 * std::size_t{batch.upper[l]};
      Real* fa = pass.force_packed + 4 * std::size_t{batch.lower[l]};
      Real* fb = pass.force_packed + 4 * std::size_t{batch.upper[l]};
      const Pull<Real> p = pull(pass, lane, b[0] - a[0], b[1] - a[1], b[2] - a[2]);
      fa[0] += p.x, fa[1] += p.y, fa[2] += p.z;
      fb[0] -= p.x, fb[1] -= p.y, fb[2] -= p.z;
      if (p.overlong) pass.overlong[count++] = lane;
    }
  }
  return count;
}

template <class Real>
void unpack(std::span<const std::uint32_t> groups, Real* packed, const Triple<Real>& force) {
  for (const std::uint32_t group : groups) {
    for (std::uint32_t slot = group * kLanes; slot < (group + 1) * kLanes; ++slot) {
      Real* p = packed + 4 * std::size_t{slot};
      for (std::size_t a = 0; a < 3; ++a) force.at(slot, a) += p[a];
      p[0] = p[1] = p[2] = p[3] = 0;
    }
  }
}

template <class Real>
void pack(std::span<const std::uint32_t> groups, const Triple<const Real>& at, Real* packed) {
  for (const std::uint32_t group : groups) {
    for (std::uint32_t slot = group * kLanes; slot < (group + 1) * kLanes; ++slot) {
      Real* p = packed + 4 * std::size_t{slot};
      for (std::size_t a = 0; a < 3; ++a) p[a] = at.at(slot, a);
      p[3] = 0;
    }
  }
}

template <class Real>
bool in_world(Real v) {
  return std::abs(v) <= Real(kWorld);
}

template <class Real>
struct Moved {
  Real at, rest, velocity;
};

template <class Real>
Moved<Real> moved(const MovePass<Real>& pass, std::uint32_t i, Real at, Real rest, Real velocity, Real force) {
  const Real way = pass.drift[i] * velocity + pass.force_gain[i] * force;
  const Real speed = pass.decay[i] * velocity + pass.velocity_gain[i] * force;
  Moved<Real> next{at + way, 0, std::abs(speed) < kLeastVelocity<Real> ? 0 : speed};
  if constexpr (sizeof(Real) == 4) {
    // T. Dekker's sum. Where the coordinate is smaller than the way its error is not all of it, but less than 1e-7 of
    // the way.
    const Real add = rest + way;
    next.at = at + add;
    next.rest = add - (next.at - at);
  }
  return next;
}

template <class Real>
std::uint32_t move(const MovePass<Real>& pass) {
  constexpr bool kHasRest = sizeof(Real) == 4;
  std::uint32_t lost = kNone;
  for (std::uint32_t block = pass.first; block < pass.end; block += kBlockSlots) {
    constexpr Real kFar = std::numeric_limits<Real>::max();
    Bounds<Real> b{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
    for (std::uint32_t i = block; i < std::min(block + kBlockSlots, pass.end); ++i) {
      Moved<Real> next[3];
      bool good = true;
      for (std::size_t a = 0; a < 3; ++a) {
        const Real rest = kHasRest ? pass.rest_of_at.at(i, a) : Real(0);
        next[a] = moved(pass, i, pass.at.at(i, a), rest, pass.velocity.at(i, a), pass.force.at(i, a));
        good = good && in_world(next[a].at) && in_world(next[a].velocity);
      }
      if (!good && lost == kNone) lost = i;
      for (std::size_t a = 0; a < 3; ++a) {
        if (good) pass.at.at(i, a) = next[a].at;
        if (good && kHasRest) pass.rest_of_at.at(i, a) = next[a].rest;
        pass.velocity.at(i, a) = good ? next[a].velocity : 0;
        pass.force.at(i, a) = pass.external.at(i, a);
        b.low[a] = std::min(b.low[a], pass.at.at(i, a)), b.high[a] = std::max(b.high[a], pass.at.at(i, a));
      }
    }
    pass.bounds[block / kBlockSlots] = b;
  }
  return lost;
}

template <class Real>
std::size_t search(const SearchPass<Real>& pass) {
  std::size_t count = 0;
  const auto& [low, high] = pass.box;
  for (std::uint32_t block = 0; block < pass.end; block += kBlockSlots) {
    const Bounds<Real>& b = pass.bounds[block / kBlockSlots];
    const bool apart = b.high[0] < low[0] || b.low[0] > high[0] || b.high[1] < low[1] || b.low[1] > high[1] ||
                       b.high[2] < low[2] || b.low[2] > high[2];
    if (apart) continue;
    for (std::uint32_t i = block; i < std::min(block + kBlockSlots, pass.end); ++i) {
      const Real x = pass.at.at(i, 0), y = pass.at.at(i, 1), z = pass.at.at(i, 2);
      const bool inside = x >= low[0] && x <= high[0] && y >= low[1] && y <= high[1] && z >= low[2] && z <= high[2];
      pass.found[count] = i;
      count += inside;
    }
  }
  return count;
}

template <class Real>
constexpr Kernel<Real> kKernel{sum_segments<Real>, sum_batches<Real>, unpack<Real>,
                               pack<Real>,         move<Real>,        search<Real>};

}  // namespace

const KernelSet& scalar_kernels() {
  static constexpr KernelSet kSet{"scalar", kKernel<float>, kKernel<double>};
  return kSet;
}

}  // namespace crumble
