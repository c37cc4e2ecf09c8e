// Sums over the nodes of a loose fragment, two places at a time, and the rigid motion that follows from them.
#pragma once

#include <cstring>

#include "crumble/base/vec_array.hpp"
#include "network/rigid_frames.hpp"

namespace crumble {

// Two places at a time, as GCC's and Clang's own kind of vector: every sum is that of the even places plus that of the
// odd ones, on every processor.
using Pair = double __attribute__((vector_size(16)));

inline Pair load(const double* from) {
  Pair to;
  std::memcpy(&to, from, sizeof to);
  return to;
}
inline void store(const Pair& from, double* to) {
  std::memcpy(to, &from, sizeof from);
}
inline double sum(const Pair& v) {
  return v[0] + v[1];
}

struct Pair3 {
  Pair x{}, y{}, z{};

  static Pair3 all(const Vec3& v) { return {Pair{v.x(), v.x()}, Pair{v.y(), v.y()}, Pair{v.z(), v.z()}}; }
  static Pair3 at(const VecArray& a, std::size_t i) { return {load(&a.x[i]), load(&a.y[i]), load(&a.z[i])}; }
  void put(VecArray& a, std::size_t i) const { store(x, &a.x[i]), store(y, &a.y[i]), store(z, &a.z[i]); }
  Vec3 sums() const { return {sum(x), sum(y), sum(z)}; }
};
inline Pair3 operator+(const Pair3& a, const Pair3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Pair3 operator-(const Pair3& a, const Pair3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Pair3 times(const Pair& s, const Pair3& a) {
  return {s * a.x, s * a.y, s * a.z};
}
inline Pair3 times(const Mat3& m, const Pair3& v) {
  return {(m(0, 0) * v.x + m(0, 1) * v.y) + m(0, 2) * v.z, (m(1, 0) * v.x + m(1, 1) * v.y) + m(1, 2) * v.z,
          (m(2, 0) * v.x + m(2, 1) * v.y) + m(2, 2) * v.z};
}
inline Pair3 cross_of(const Pair3& a, const Pair3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// m(v) = a x v.
inline Mat3 cross_matrix(const Vec3& a) {
  Mat3 m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

inline Mat3 product(const Mat3& a, const Mat3& b) {
  Mat3 m;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) m(i, k) = (a(i, 0) * b(0, k) + a(i, 1) * b(1, k)) + a(i, 2) * b(2, k);
  }
  return m;
}

// First and second moments of a group about some point near it, from which those about its center follow.
struct Moments {
  Pair3 first, momentum, angular, diagonal, mixed;  // mixed: xy, xz, yz

  void add(const Pair& mass, const Pair3& r, const Pair3& velocity) {
    const Pair3 mr = times(mass, r), mv = times(mass, velocity);
    first = first + mr;
    momentum = momentum + mv;
    angular = angular + cross_of(r, mv);
    diagonal = diagonal + Pair3{mr.x * r.x, mr.y * r.y, mr.z * r.z};
    mixed = mixed + Pair3{mr.x * r.y, mr.x * r.z, mr.y * r.z};
  }
};

struct Rigid {
  Vec3 center, velocity, momentum;  // center: from the point that the moments are about
  Inertia inertia;

  Rigid(const Moments& m, double mass) {
    center = m.first.sums() / mass;
    const Vec3 linear = m.momentum.sums();
    velocity = linear / mass;
    momentum = m.angular.sums() - cross(center, linear);
    const Vec3 square = m.diagonal.sums(), mixed = m.mixed.sums(), mc = mass * center;
    const double x2 = square.x() - mc.x() * center.x(), y2 = square.y() - mc.y() * center.y(),
                 z2 = square.z() - mc.z() * center.z();
    inertia = {y2 + z2,
               x2 + z2,
               x2 + y2,
               mc.x() * center.y() - mixed.x(),
               mc.x() * center.z() - mixed.y(),
               mc.y() * center.z() - mixed.z()};
  }
};

}  // namespace crumble
