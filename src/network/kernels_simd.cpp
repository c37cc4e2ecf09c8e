// The kernels for vectors of any width, compiled once per instruction set by Google Highway. kernels_scalar.cpp says
// what is computed. Only operations whose result IEEE 754 fixes are used: no fused multiply-add, no approximate root.
#include <cstring>
#include <type_traits>
#include <vector>

#include "network/kernels.hpp"

// Every AArch64 has NEON, so there is nothing to choose at run time. For a choice among NEON and SVE Highway would have
// GCC compile for processors with AES, which not all are, and which GCC 12 fails to do.
#define TOOLCHAIN_MISS_SYS_AUXV_H
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "network/kernels_simd.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128

HWY_BEFORE_NAMESPACE();
namespace crumble::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Numbers of the lanes that are set, each plus `base`, appended.
template <class D, class M>
HWY_INLINE std::size_t append_lanes(D d, M mask, std::uint32_t base, std::uint32_t* out) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, mask, bytes);
  std::uint64_t bits;
  std::memcpy(&bits, bytes, sizeof bits);
  std::size_t count = 0;
  for (; bits != 0; bits &= bits - 1) out[count++] = base + static_cast<std::uint32_t>(__builtin_ctzll(bits));
  return count;
}

template <class V>
struct Vec3V {
  V x, y, z;
};
template <class D, class Real>
HWY_INLINE Vec3V<hn::Vec<D>> load(D d, const Triple<Real>& t, std::size_t i) {
  return {hn::LoadU(d, t.x + i), hn::LoadU(d, t.x + t.stride + i), hn::LoadU(d, t.x + 2 * t.stride + i)};
}
template <class D, class V, class Real>
HWY_INLINE void store(D d, const Vec3V<V>& v, const Triple<Real>& t, std::size_t i) {
  hn::StoreU(v.x, d, t.x + i), hn::StoreU(v.y, d, t.x + t.stride + i), hn::StoreU(v.z, d, t.x + 2 * t.stride + i);
}
template <class V>
HWY_INLINE Vec3V<V> operator-(const Vec3V<V>& a, const Vec3V<V>& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
template <class V>
HWY_INLINE Vec3V<V> operator+(const Vec3V<V>& a, const Vec3V<V>& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
template <class V>
HWY_INLINE Vec3V<V> times(V s, const Vec3V<V>& a) {
  return {hn::Mul(s, a.x), hn::Mul(s, a.y), hn::Mul(s, a.z)};
}

// Seldom needed: of the lanes that are too long, the whole ones are appended and pull less.
template <class D, class V, class M, class Real>
HWY_NOINLINE V weaken(D d, V factor, M over, const ForcePass<Real>& pass, std::size_t lane, std::size_t& found) {
  HWY_ALIGN Real factors[64 / sizeof(Real)];
  std::uint32_t lanes[64 / sizeof(Real)];
  hn::Store(factor, d, factors);
  const std::size_t count = append_lanes(d, over, static_cast<std::uint32_t>(lane), lanes);
  for (std::size_t k = 0; k < count; ++k) {
    if (!pass.whole[lanes[k]]) continue;
    factors[lanes[k] - lane] *= pass.cut_share;
    pass.overlong[found++] = lanes[k];
  }
  return hn::Load(d, factors);
}

// k - k l0 / length, 0 where the length is.
template <class D, class V, class Real>
HWY_INLINE V pull(D d, const Vec3V<V>& way, V stiffness, V rest_force, const ForcePass<Real>& pass, std::size_t lane,
                  std::size_t& found) {
  const V square = hn::Add(hn::Add(hn::Mul(way.x, way.x), hn::Mul(way.y, way.y)), hn::Mul(way.z, way.z));
  const V inverse = hn::Div(rest_force, hn::Sqrt(square));
  const auto has_length = hn::Ge(square, hn::Set(d, kLeastSquare<Real>));
  V factor = hn::IfThenElseZero(has_length, hn::Sub(stiffness, inverse));
  const auto over = hn::Gt(factor, hn::Mul(hn::Set(d, pass.give), stiffness));
  if (HWY_UNLIKELY(!hn::AllFalse(d, over))) {
    factor = weaken(d, factor, over, pass, lane, found);
  }
  return factor;
}

// Which of the lanes from `lane` on have a spring; at most 16.
template <class D, class Real>
HWY_INLINE hn::Mask<D> load_present(D d, const ForcePass<Real>& pass, std::size_t lane) {
  std::uint8_t bytes[8] = {};
  if (hn::Lanes(d) > kLanes) {
    std::memcpy(bytes, pass.present + lane / kLanes, 2);
  } else {
    bytes[0] = static_cast<std::uint8_t>(pass.present[lane / kLanes] >> (lane % kLanes));
  }
  return hn::LoadMaskBits(d, bytes);
}

// One way of a segment for one vector of its slots: taken from the upper ends, handed back for the lower ones.
template <bool plain, class D, class Real>
HWY_INLINE Vec3V<hn::Vec<D>> sum_way(D d, const ForcePass<Real>& pass, const Way<Real>& way, std::size_t i,
                                     std::size_t j, std::size_t lane, std::size_t& found) {
  const auto distance = load(d, pass.at, j) - load(d, pass.at, i);
  hn::Vec<D> stiffness, rest_force;
  if constexpr (plain) {
    const auto present = load_present(d, pass, lane);
    stiffness = hn::IfThenElseZero(present, hn::Set(d, way.stiffness));
    rest_force = hn::IfThenElseZero(present, hn::Set(d, way.rest_force));
  } else {
    stiffness = hn::LoadU(d, pass.stiffness + lane);
    rest_force = hn::LoadU(d, pass.rest_force + lane);
  }
  const auto p = times(pull(d, distance, stiffness, rest_force, pass, lane, found), distance);
  store(d, load(d, pass.force, j) - p, pass.force, j);
  return p;
}

// A segment of `count` full vectors and, where vectors are wider than a block, perhaps one block more.
template <class Real, std::size_t count, bool block_more>
struct SegmentSum {
  using D = hn::ScalableTag<Real>;
  using D8 = hn::CappedTag<Real, kLanes>;
  Vec3V<hn::Vec<D>> sum[count > 0 ? count : 1];
  Vec3V<hn::Vec<D8>> last;

  template <bool plain>
  HWY_INLINE void add_way(const ForcePass<Real>& pass, const Way<Real>& way, std::size_t i, std::size_t j,
                          std::size_t lane, std::size_t& found) {
    const D d;
    const std::size_t n = hn::Lanes(d);
#pragma GCC unroll 4
    for (std::size_t v = 0; v < count; ++v) {
      sum[v] = sum[v] + sum_way<plain>(d, pass, way, i + v * n, j + v * n, lane + v * n, found);
    }
    if constexpr (block_more) {
      const std::size_t past = count * n;
      last = last + sum_way<plain>(D8(), pass, way, i + past, j + past, lane + past, found);
    }
  }

  HWY_INLINE void run(const ForcePass<Real>& pass, const Segment& segment, std::size_t& found) {
    const D d;
    const D8 d8;
    const std::size_t n = hn::Lanes(d), i = segment.first;
    last = {hn::Zero(d8), hn::Zero(d8), hn::Zero(d8)};
#pragma GCC unroll 4
    for (Vec3V<hn::Vec<D>>& each : sum) each = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    std::size_t lane = segment.lane;
    for (std::uint32_t w = segment.first_way; w < segment.first_way + segment.ways; ++w) {
      if (pass.plain[w]) {
        add_way<true>(pass, pass.ways[w], i, i + pass.offsets[w], lane, found);
      } else {
        add_way<false>(pass, pass.ways[w], i, i + pass.offsets[w], lane, found);
      }
      lane += segment.blocks * kLanes;
    }
#pragma GCC unroll 4
    for (std::size_t v = 0; v < count; ++v) store(d, load(d, pass.force, i + v * n) + sum[v], pass.force, i + v * n);
    if constexpr (block_more) store(d8, load(d8, pass.force, i + count * n) + last, pass.force, i + count * n);
  }
};

template <std::size_t blocks, class Real>
HWY_INLINE void sum_blocks(const ForcePass<Real>& pass, const Segment& segment, std::size_t& found) {
  constexpr std::size_t kVector = HWY_MAX_BYTES / sizeof(Real), kSlots = blocks * kLanes;
  SegmentSum<Real, kSlots / kVector, (kSlots % kVector > 0)>().run(pass, segment, found);
}

template <class Real>
std::size_t sum_segments(const ForcePass<Real>& shared) {
  static_assert(kMostBlocks == 8);
  const ForcePass<Real> pass = shared;  // in registers: stores of forces could change the shared one
  std::size_t found = 0;
  for (const Segment& segment : pass.segments) {
    // clang-format off
    switch (segment.blocks) {
      case 1: sum_blocks<1>(pass, segment, found); break;
      case 2: sum_blocks<2>(pass, segment, found); break;
      case 3: sum_blocks<3>(pass, segment, found); break;
      case 4: sum_blocks<4>(pass, segment, found); break;
      case 5: sum_blocks<5>(pass, segment, found); break;
      case 6: sum_blocks<6>(pass, segment, found); break;
      case 7: sum_blocks<7>(pass, segment, found); break;
      case 8: sum_blocks<8>(pass, segment, found); break;
    }
    // clang-format on
  }
  return found;
}

// Batches work on node records x y z 0. Within 128-bit blocks a record is one vector of floats or two of doubles; `N`
// springs are turned from records to x, y, z by interleaving within blocks and back by broadcasting.
template <class Real>
struct Group;

template <>
struct Group<float> {
  using D = hn::CappedTag<float, 8>;
  using V = hn::Vec<D>;
  using D4 = hn::CappedTag<float, 4>;
  static constexpr std::size_t kSprings = HWY_MAX_BYTES >= 32 ? 8 : 4;
  V record[4];  // of springs l (and l + 4 in the upper block)

  static HWY_INLINE V load(const float* packed, const std::uint32_t* slot) {
    const D4 d4;
#if HWY_MAX_BYTES >= 32
    return hn::Combine(D(), hn::LoadU(d4, packed + 4 * std::size_t{slot[4]}),
                       hn::LoadU(d4, packed + 4 * std::size_t{slot[0]}));
#else
    return hn::LoadU(d4, packed + 4 * std::size_t{slot[0]});
#endif
  }
  template <class V4>
  static HWY_INLINE void add(float* packed, std::uint32_t slot, V4 v) {
    float* at = packed + 4 * std::size_t{slot};
    hn::StoreU(hn::Add(hn::LoadU(D4(), at), v), D4(), at);
  }
  template <class V4>
  static HWY_INLINE void subtract(float* packed, std::uint32_t slot, V4 v) {
    float* at = packed + 4 * std::size_t{slot};
    hn::StoreU(hn::Sub(hn::LoadU(D4(), at), v), D4(), at);
  }
  HWY_INLINE void load_way(const float* packed, const std::uint32_t* lower, const std::uint32_t* upper) {
    for (std::size_t l = 0; l < 4; ++l) record[l] = hn::Sub(load(packed, upper + l), load(packed, lower + l));
  }
  HWY_INLINE Vec3V<V> turned() const {
    const D d;
    const hn::Repartition<std::conditional_t<HWY_HAVE_FLOAT64, double, std::uint64_t>, D> d64;
    const auto as64 = [&](V v) HWY_ATTR { return hn::BitCast(d64, v); };
    const V xy01 = hn::InterleaveLower(d, record[0], record[1]), xy23 = hn::InterleaveLower(d, record[2], record[3]);
    const V z01 = hn::InterleaveUpper(d, record[0], record[1]), z23 = hn::InterleaveUpper(d, record[2], record[3]);
    return {hn::BitCast(d, hn::InterleaveLower(d64, as64(xy01), as64(xy23))),
            hn::BitCast(d, hn::InterleaveUpper(d64, as64(xy01), as64(xy23))),
            hn::BitCast(d, hn::InterleaveLower(d64, as64(z01), as64(z23)))};
  }
  template <int l>
  HWY_INLINE void scatter(V factor, float* packed, const std::uint32_t* lower, const std::uint32_t* upper) const {
    const V force = hn::Mul(hn::Broadcast<l>(factor), record[l]);
#if HWY_MAX_BYTES >= 32
    const auto low = hn::LowerHalf(D4(), force), high = hn::UpperHalf(D4(), force);
    add(packed, lower[l], low), add(packed, lower[l + 4], high);
    subtract(packed, upper[l], low), subtract(packed, upper[l + 4], high);
#else
    add(packed, lower[l], force), subtract(packed, upper[l], force);
#endif
  }
  HWY_INLINE void scatter(V factor, float* packed, const std::uint32_t* lower, const std::uint32_t* upper) const {
    scatter<0>(factor, packed, lower, upper), scatter<1>(factor, packed, lower, upper);
    scatter<2>(factor, packed, lower, upper), scatter<3>(factor, packed, lower, upper);
  }
};

#if HWY_HAVE_FLOAT64
template <>
struct Group<double> {
  using D = hn::CappedTag<double, 4>;
  using V = hn::Vec<D>;
  using D2 = hn::CappedTag<double, 2>;
  static constexpr std::size_t kSprings = HWY_MAX_BYTES >= 32 ? 4 : 2;
  V xy[2], z0[2];  // of springs l (and l + 2 in the upper block)

  static HWY_INLINE V load(const double* packed, const std::uint32_t* slot) {
    const D2 d2;
#if HWY_MAX_BYTES >= 32
    return hn::Combine(D(), hn::LoadU(d2, packed + 4 * std::size_t{slot[2]}),
                       hn::LoadU(d2, packed + 4 * std::size_t{slot[0]}));
#else
    return hn::LoadU(d2, packed + 4 * std::size_t{slot[0]});
#endif
  }
  template <class V2>
  static HWY_INLINE void add(double* packed, std::uint32_t slot, V2 a, V2 b) {
    const D2 d2;
    double* at = packed + 4 * std::size_t{slot};
    hn::StoreU(hn::Add(hn::LoadU(d2, at), a), d2, at);
    hn::StoreU(hn::Add(hn::LoadU(d2, at + 2), b), d2, at + 2);
  }
  template <class V2>
  static HWY_INLINE void subtract(double* packed, std::uint32_t slot, V2 a, V2 b) {
    const D2 d2;
    double* at = packed + 4 * std::size_t{slot};
    hn::StoreU(hn::Sub(hn::LoadU(d2, at), a), d2, at);
    hn::StoreU(hn::Sub(hn::LoadU(d2, at + 2), b), d2, at + 2);
  }
  HWY_INLINE void load_way(const double* packed, const std::uint32_t* lower, const std::uint32_t* upper) {
    for (std::size_t l = 0; l < 2; ++l) {
      xy[l] = hn::Sub(load(packed, upper + l), load(packed, lower + l));
      z0[l] = hn::Sub(load(packed + 2, upper + l), load(packed + 2, lower + l));
    }
  }
  HWY_INLINE Vec3V<V> turned() const {
    const D d;
    return {hn::InterleaveLower(d, xy[0], xy[1]), hn::InterleaveUpper(d, xy[0], xy[1]),
            hn::InterleaveLower(d, z0[0], z0[1])};
  }
  template <int l>
  HWY_INLINE void scatter(V factor, double* packed, const std::uint32_t* lower, const std::uint32_t* upper) const {
    const D d;
    const V each = l == 0 ? hn::InterleaveLower(d, factor, factor) : hn::InterleaveUpper(d, factor, factor);
    const V a = hn::Mul(each, xy[l]), b = hn::Mul(each, z0[l]);
#if HWY_MAX_BYTES >= 32
    const D2 d2;
    const auto a0 = hn::LowerHalf(d2, a), a1 = hn::UpperHalf(d2, a), b0 = hn::LowerHalf(d2, b),
               b1 = hn::UpperHalf(d2, b);
    add(packed, lower[l], a0, b0), add(packed, lower[l + 2], a1, b1);
    subtract(packed, upper[l], a0, b0), subtract(packed, upper[l + 2], a1, b1);
#else
    add(packed, lower[l], a, b), subtract(packed, upper[l], a, b);
#endif
  }
  HWY_INLINE void scatter(V factor, double* packed, const std::uint32_t* lower, const std::uint32_t* upper) const {
    scatter<0>(factor, packed, lower, upper), scatter<1>(factor, packed, lower, upper);
  }
};
#endif

template <class Real>
std::size_t sum_batches(const ForcePass<Real>& pass) {
  using G = Group<Real>;
  const typename G::D d;
  std::size_t found = 0, lane = pass.batch_lane;
  for (const Batch& batch : pass.batches) {
    for (std::size_t s = 0; s < kLanes; s += G::kSprings, lane += G::kSprings) {
      G group;
      group.load_way(pass.at_packed, batch.lower.data() + s, batch.upper.data() + s);
      const auto factor = pull(d, group.turned(), hn::LoadU(d, pass.stiffness + lane),
                               hn::LoadU(d, pass.rest_force + lane), pass, lane, found);
      group.scatter(factor, pass.force_packed, batch.lower.data() + s, batch.upper.data() + s);
    }
  }
  return found;
}

template <class Real>
void unpack(std::span<const std::uint32_t> groups, Real* packed, const Triple<Real>& force) {
  const hn::CappedTag<Real, kLanes> d;
  const auto zero = hn::Zero(d);
  for (const std::uint32_t group : groups) {
    for (std::size_t s = 0; s < kLanes; s += hn::Lanes(d)) {
      const std::size_t slot = std::size_t{group} * kLanes + s;
      hn::Vec<decltype(d)> x, y, z, w;
      hn::LoadInterleaved4(d, packed + 4 * slot, x, y, z, w);
      store(d, load(d, force, slot) + Vec3V<decltype(x)>{x, y, z}, force, slot);
      for (std::size_t k = 0; k < 4; ++k) hn::StoreU(zero, d, packed + 4 * slot + k * hn::Lanes(d));
    }
  }
}

template <class Real>
void pack(std::span<const std::uint32_t> groups, const Triple<const Real>& at, Real* packed) {
  const hn::CappedTag<Real, kLanes> d;
  for (const std::uint32_t group : groups) {
    for (std::size_t s = 0; s < kLanes; s += hn::Lanes(d)) {
      const std::size_t slot = std::size_t{group} * kLanes + s;
      const auto p = load(d, at, slot);
      hn::StoreInterleaved4(p.x, p.y, p.z, hn::Zero(d), d, packed + 4 * slot);
    }
  }
}

template <class D, class V>
struct Moved {
  V at, rest, velocity;
  hn::Mask<D> good;
};

template <class D, class Real, class V>
HWY_INLINE Moved<D, V> moved(D d, const MovePass<Real>& pass, std::size_t i, const Real* ats, const Real* rests,
                             const Real* velocities, const Real* forces) {
  const V at = hn::LoadU(d, ats + i), velocity = hn::LoadU(d, velocities + i), force = hn::LoadU(d, forces + i);
  const V way =
      hn::Add(hn::Mul(hn::LoadU(d, pass.drift + i), velocity), hn::Mul(hn::LoadU(d, pass.force_gain + i), force));
  const V speed =
      hn::Add(hn::Mul(hn::LoadU(d, pass.decay + i), velocity), hn::Mul(hn::LoadU(d, pass.velocity_gain + i), force));
  Moved<D, V> next;
  // a speed that is not a number must stay one here, so small ones are taken away rather than others kept
  next.velocity = hn::IfThenZeroElse(hn::Lt(hn::Abs(speed), hn::Set(d, kLeastVelocity<Real>)), speed);
  if constexpr (sizeof(Real) == 4) {
    const V rest = hn::LoadU(d, rests + i);
    const V add = hn::Add(rest, way);
    next.at = hn::Add(at, add);
    next.rest = hn::Sub(add, hn::Sub(next.at, at));
  } else {
    next.at = hn::Add(at, way);
    next.rest = hn::Zero(d);
  }
  const V world = hn::Set(d, Real(kWorld));
  next.good = hn::And(hn::Le(hn::Abs(next.at), world), hn::Le(hn::Abs(next.velocity), world));
  return next;
}

// One axis of the block's bounds, and the new values where all is good.
template <class D, class V, class Real>
HWY_INLINE void finish(D d, Moved<D, V>& next, hn::Mask<D> good, bool all_good, std::size_t i, Real* ats, Real* rests,
                       Real* velocities, V& low, V& high) {
  if (HWY_UNLIKELY(!all_good)) {
    next.at = hn::IfThenElse(good, next.at, hn::LoadU(d, ats + i));
    if constexpr (sizeof(Real) == 4) next.rest = hn::IfThenElse(good, next.rest, hn::LoadU(d, rests + i));
    next.velocity = hn::IfThenElseZero(good, next.velocity);
  }
  hn::StoreU(next.at, d, ats + i);
  if constexpr (sizeof(Real) == 4) hn::StoreU(next.rest, d, rests + i);
  hn::StoreU(next.velocity, d, velocities + i);
  low = hn::Min(low, next.at), high = hn::Max(high, next.at);
}

template <class Real>
std::uint32_t move(const MovePass<Real>& pass) {
  const hn::ScalableTag<Real> d;
  using V = hn::Vec<hn::ScalableTag<Real>>;
  std::uint32_t lost = kNone;
  for (std::size_t block = pass.first; block < pass.end; block += kBlockSlots) {
    const V far = hn::Set(d, std::numeric_limits<Real>::max());
    V low_x = far, low_y = far, low_z = far;
    V high_x = hn::Neg(far), high_y = high_x, high_z = high_x;
    const std::size_t end = HWY_MIN(block + kBlockSlots, std::size_t{pass.end});
    for (std::size_t i = block; i < end; i += hn::Lanes(d)) {
      const auto axis = [&](std::size_t a) HWY_ATTR {
        return moved<hn::ScalableTag<Real>, Real, V>(d, pass, i, pass.at.axis(a), pass.rest_of_at.axis(a),
                                                     pass.velocity.axis(a), pass.force.axis(a));
      };
      auto x = axis(0), y = axis(1), z = axis(2);
      const auto good = hn::And(hn::And(x.good, y.good), z.good);
      const bool all_good = hn::AllTrue(d, good);
      const auto end_axis = [&](std::size_t a, auto& next, V& low, V& high) HWY_ATTR {
        hn::StoreU(hn::LoadU(d, pass.external.axis(a) + i), d, pass.force.axis(a) + i);
        finish(hn::ScalableTag<Real>(), next, good, all_good, i, pass.at.axis(a), pass.rest_of_at.axis(a),
               pass.velocity.axis(a), low, high);
      };
      end_axis(0, x, low_x, high_x), end_axis(1, y, low_y, high_y), end_axis(2, z, low_z, high_z);
      if (HWY_UNLIKELY(!all_good) && lost == kNone) {
        std::uint32_t lanes[64];
        append_lanes(d, hn::Not(good), static_cast<std::uint32_t>(i), lanes);
        lost = lanes[0];
      }
    }
    const auto least = [&](V v) HWY_ATTR { return hn::GetLane(hn::MinOfLanes(d, v)); };
    const auto most = [&](V v) HWY_ATTR { return hn::GetLane(hn::MaxOfLanes(d, v)); };
    pass.bounds[block / kBlockSlots] = {{least(low_x), least(low_y), least(low_z)},
                                        {most(high_x), most(high_y), most(high_z)}};
  }
  return lost;
}

template <class Real>
std::size_t search(const SearchPass<Real>& pass) {
  const hn::ScalableTag<Real> d;
  const auto& [low, high] = pass.box;
  std::size_t count = 0;
  for (std::size_t block = 0; block < pass.end; block += kBlockSlots) {
    const Bounds<Real>& b = pass.bounds[block / kBlockSlots];
    const bool apart = b.high[0] < low[0] || b.low[0] > high[0] || b.high[1] < low[1] || b.low[1] > high[1] ||
                       b.high[2] < low[2] || b.low[2] > high[2];
    if (apart) continue;
    const std::size_t end = HWY_MIN(block + kBlockSlots, std::size_t{pass.end});
    for (std::size_t i = block; i < end; i += hn::Lanes(d)) {
      const auto p = load(d, pass.at, i);
      const auto in_x = hn::And(hn::Ge(p.x, hn::Set(d, low[0])), hn::Le(p.x, hn::Set(d, high[0])));
      const auto in_y = hn::And(hn::Ge(p.y, hn::Set(d, low[1])), hn::Le(p.y, hn::Set(d, high[1])));
      const auto in_z = hn::And(hn::Ge(p.z, hn::Set(d, low[2])), hn::Le(p.z, hn::Set(d, high[2])));
      const auto inside = hn::And(hn::And(in_x, in_y), in_z);
      if (hn::AllFalse(d, inside)) continue;
      count += append_lanes(d, inside, static_cast<std::uint32_t>(i), pass.found + count);
    }
  }
  while (count > 0 && pass.found[count - 1] >= pass.end) --count;
  return count;
}

template <class Real>
constexpr Kernel<Real> kKernel{sum_segments<Real>, sum_batches<Real>, unpack<Real>,
                               pack<Real>,         move<Real>,        search<Real>};

}  // namespace

extern const KernelSet kSet;
const KernelSet kSet {
  HWY_TARGET == HWY_AVX3   ? "avx512"
  : HWY_TARGET == HWY_AVX2 ? "avx2"
  : HWY_TARGET == HWY_SSE4 ? "sse4"
  : HWY_TARGET == HWY_WASM ? "wasm"
                           : "neon",
      kKernel<float>,
#if HWY_HAVE_FLOAT64
      kKernel<double>
#else  // Highway 1.0 has no vectors of doubles for WebAssembly
      scalar_kernels().float64
#endif
};

}  // namespace crumble::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // a target with vectors

#if HWY_ONCE

namespace crumble {

std::span<const KernelSet* const> simd_kernels() {
  static const std::vector<const KernelSet*> kSets = [] {  // never given back: not of the host's memory
    std::vector<const KernelSet*> sets;
#if HWY_ARCH_X86
    __builtin_cpu_init();
#if HWY_TARGETS & HWY_SSE4
    if (__builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("pclmul") && __builtin_cpu_supports("aes"))
      sets.push_back(&N_SSE4::kSet);
#endif
#if HWY_TARGETS & HWY_AVX2
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2")) {
      sets.push_back(&N_AVX2::kSet);
    }
#endif
#if HWY_TARGETS & HWY_AVX3
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd")) {
      sets.push_back(&N_AVX3::kSet);
    }
#endif
#else
#if HWY_TARGETS & HWY_NEON
    sets.push_back(&N_NEON::kSet);
#endif
#if HWY_TARGETS & HWY_WASM
    sets.push_back(&N_WASM::kSet);
#endif
#endif
    return sets;
  }();
  return kSets;
}

}  // namespace crumble
#endif  // HWY_ONCE
