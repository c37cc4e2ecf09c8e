// A pair is a spring of stiffness k along its line and one across it, both without memory of where the nodes are but
// through the contact distance d0 and the shear s, the way that the two have slid since they touched (Cundall and
// Strack, "A discrete numerical model for granular assemblies", Geotechnique 29, 1979):
//
//   f_n = max(0, k (d0 - d - 4/3 tau v_n))                                  v_n: speed at which they part
//   f_t = -k (s + 4/3 tau v_t), while that is <= mu_s f_n, else cut down to mu_d f_n, and s with it
//
// Taking overlap and shear where they will be 4/3 of a step later is a dashpot of 4/3 k tau. A step of a free body
// under forces that are frozen over it multiplies the energy of an undamped spring by more than 1; with this dashpot,
// whatever the bodies' shapes and however many pairs there are, damping and stiffness have the same modes, and a mode
// of rate w^2 (in 1 / tau^2) has the step matrix
//
//   [1 - w^2 / 2, 1 - 2 w^2 / 3; -w^2, 1 - 4 w^2 / 3]    det = 1 - 5 w^2 / 6,  trace = 2 - 11 w^2 / 6
//
// so it decays for w^2 < 3/2. No mode of rigid fragments is faster if the stiffness K_A of all pairs of a fragment and
// K_i of all pairs of a node obey K_A <= M_A / (4 tau^2) and K_i <= m_i / (2 tau^2), which ball_contacts.cpp sees to.
// Of two fragments that touch each contributes up to 1/4 by its translation, K_A / M_A, and up to 1/2 by its rotation,
// sum K_i r_i^2 / sum m_i r_i^2 about any axis; and a pair stretches by no more than its two nodes move together, which
// is the factor of 2 from there to 3/2.
//
// Twice that stiffness with a dashpot of k tau would do for the modes too; but a pair that meets at speed v is first
// seen up to v tau deep, and that overlap comes for nothing: crumbs were seen to bounce on it for seconds.
#include "ball_forces.hpp"

#include <cmath>

namespace crumble {

namespace {

constexpr double kAhead = 4.0 / 3;  // steps

#if defined(__x86_64__) && defined(__GNUC__)
#define CRUMBLE_CHOOSES_PROCESSOR
[[gnu::always_inline]]
#endif
inline void
push(BallBlock& b, std::size_t count, const Friction& friction, double tau) noexcept {
  const double ahead = kAhead * tau, mu_s = friction.static_coefficient, mu_d = friction.dynamic_coefficient;
  constexpr double kTiny = 1e-150;
  const std::size_t end = (count + 7) & ~std::size_t{7};
  for (std::size_t i = 0; i < end; ++i) {
    const double k = b.stiffness[i];
    const double distance = std::sqrt((b.x[i] * b.x[i] + b.y[i] * b.y[i]) + b.z[i] * b.z[i]);
    const double per_metre = 1 / (distance > kTiny ? distance : kTiny);
    const double nx = b.x[i] * per_metre, ny = b.y[i] * per_metre, nz = b.z[i] * per_metre;
    const double parting = (b.vx[i] * nx + b.vy[i] * ny) + b.vz[i] * nz;
    const double overlap = (std::sqrt(b.reach[i]) - distance) - ahead * parting;
    const double normal_force = k * (overlap > 0 ? overlap : 0);

    const double tx = b.vx[i] - parting * nx, ty = b.vy[i] - parting * ny, tz = b.vz[i] - parting * nz;
    const double along = (b.shear_x[i] * nx + b.shear_y[i] * ny) + b.shear_z[i] * nz;
    const double sx = (b.shear_x[i] - along * nx) + tau * tx, sy = (b.shear_y[i] - along * ny) + tau * ty;
    const double sz = (b.shear_z[i] - along * nz) + tau * tz;
    const double px = sx + ahead * tx, py = sy + ahead * ty, pz = sz + ahead * tz;
    const double drag = k * std::sqrt((px * px + py * py) + pz * pz);
    const double hold = mu_s * normal_force, slide = mu_d * normal_force / (drag > kTiny ? drag : kTiny);
    const double share = drag <= hold ? 1 : slide;
    const double qx = share * px, qy = share * py, qz = share * pz;

    b.fx[i] = normal_force * nx - k * qx;
    b.fy[i] = normal_force * ny - k * qy;
    b.fz[i] = normal_force * nz - k * qz;
    // + 0.0: no negative zero, since a snapshot keeps no shear of 0
    b.shear_x[i] = (drag <= hold ? sx : qx) + 0.0;
    b.shear_y[i] = (drag <= hold ? sy : qy) + 0.0;
    b.shear_z[i] = (drag <= hold ? sz : qz) + 0.0;
    b.x[i] = nx, b.y[i] = ny, b.z[i] = nz;
    b.approach[i] = -parting;
  }
}

#ifdef CRUMBLE_CHOOSES_PROCESSOR
[[gnu::target("avx2")]] void push_avx2(BallBlock& b, std::size_t count, const Friction& friction, double tau) noexcept {
  push(b, count, friction, tau);
}
[[gnu::target("avx512f,avx512vl,avx512dq,avx512bw")]] void push_avx512(BallBlock& b, std::size_t count,
                                                                       const Friction& friction, double tau) noexcept {
  push(b, count, friction, tau);
}
#endif

void push_baseline(BallBlock& b, std::size_t count, const Friction& friction, double tau) noexcept {
  push(b, count, friction, tau);
}

}  // namespace

// The same code for wider vectors, where there are some: a quarter of the time, and the same bits.
BallLaw ball_law() noexcept {
#ifdef CRUMBLE_CHOOSES_PROCESSOR
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512bw")) {
    return push_avx512;
  }
  if (__builtin_cpu_supports("avx2")) return push_avx2;
#endif
  return push_baseline;
}

BallLaw baseline_ball_law() noexcept {
  return push_baseline;
}

}  // namespace crumble
