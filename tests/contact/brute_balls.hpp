// Ball contact told again without a list, a search or a block: all pairs of nodes, in every step.
#pragma once

#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "crumble/base/memory.hpp"
#include "crumble/contact/ball_contacts.hpp"
#include "crumble/fracture/fragments.hpp"

namespace crumble {

class BruteBalls {
 public:
  struct Body {
    Vector<Edge> springs;
    Vector<double> radii, masses, stiffnesses, stiffness_sums;
    Vector<std::uint8_t> on_surface, fixed;
    Friction friction;
    double tau;

    BallSetup setup() const {
      return {springs, radii, masses, stiffnesses, stiffness_sums, on_surface, fixed, friction, tau};
    }
  };
  using Pair = std::pair<std::uint32_t, std::uint32_t>;

  explicit BruteBalls(Body body) : body_(std::move(body)), exposed_(body_.radii.size()) {
    for (const auto& [a, b] : body_.springs) joined_.insert({a, b});
  }

  void update(const Vector<std::uint32_t>& cuts, Vector<std::uint32_t> labels, Vector<BallFragment> fragments) {
    for (const std::uint32_t spring : cuts) {
      const auto [a, b] = body_.springs[spring];
      joined_.erase({a, b});
      exposed_[a] = exposed_[b] = true;
    }
    labels_ = std::move(labels), fragments_ = std::move(fragments);
  }

  /// Force on the first node of each pair that touches.
  std::map<Pair, Vec3> find(const Vector<Vec3>& x, const Vector<Vec3>& v) {
    Vector<Pair> touching;
    for (std::uint32_t a = 0; a < x.size(); ++a) {
      for (std::uint32_t b = a + 1; b < x.size(); ++b) {
        if (!may_touch(a, b)) continue;
        const double distance = norm(x[a] - x[b]), sum = body_.radii[a] + body_.radii[b];
        const auto [memory, is_new] = memories_.try_emplace({a, b}, std::min(sum, distance), Vec3::Zero());
        auto& [reach, shear] = memory->second;
        const bool touches = !is_new && distance < reach;
        reach = std::max(reach, std::min(sum, distance));
        if (touches) touching.push_back({a, b});
        if (!touches) shear = Vec3::Zero();
      }
    }
    std::map<std::uint32_t, int> of_node, of_fragment;
    for (const auto& [a, b] : touching)
      ++of_node[a], ++of_node[b], ++of_fragment[labels_[a]], ++of_fragment[labels_[b]];
    std::map<Pair, Vec3> forces;
    for (const auto& pair : touching) {
      double k = (body_.stiffnesses[pair.first] + body_.stiffnesses[pair.second]) / 2;
      for (const std::uint32_t i : {pair.first, pair.second}) {
        const double per_tau2 = 1 / (body_.tau * body_.tau);
        const BallFragment& fragment = fragments_[labels_[i]];
        if (fragment.asleep) continue;
        k = std::min(k, fragment.mass / 4 * per_tau2 / of_fragment[labels_[i]]);
        if (body_.fixed[i]) continue;
        k = std::min(k, body_.stiffness_sums[i] / 8 / of_node[i]);
        if (fragment.mass < std::numeric_limits<double>::infinity()) {
          k = std::min(k, body_.masses[i] / 2 * per_tau2 / of_node[i]);
        }
      }
      forces[pair] = force(k, x[pair.first] - x[pair.second], v[pair.first] - v[pair.second], memories_[pair]);
    }
    return forces;
  }

  std::size_t memory_count() const { return memories_.size(); }

 private:
  using Memory = std::pair<double, Vec3>;  // contact distance, shear

  bool may_touch(std::uint32_t a, std::uint32_t b) const {
    if (labels_[a] == kNoFragment || labels_[b] == kNoFragment) return false;
    if (labels_[a] == labels_[b]) return exposed_[a] && exposed_[b] && !joined_.contains({a, b});
    return (exposed_[a] || body_.on_surface[a]) && (exposed_[b] || body_.on_surface[b]);
  }

  Vec3 force(double k, const Vec3& x, const Vec3& v, Memory& memory) const {
    auto& [reach, shear] = memory;
    const Vec3 n = x / norm(x);
    const double parting = dot(v, n);
    const double normal = k * std::max(0.0, reach - norm(x) - 4.0 / 3 * body_.tau * parting);
    const Vec3 slide = v - parting * n;
    shear = shear - dot(shear, n) * n + body_.tau * slide;
    const Vec3 ahead = shear + 4.0 / 3 * body_.tau * slide;
    Vec3 tangential = -k * ahead;
    if (norm(tangential) > body_.friction.static_coefficient * normal) {
      const double share = body_.friction.dynamic_coefficient * normal / norm(tangential);
      tangential *= share;
      shear = share * ahead;
    }
    return normal * n + tangential;
  }

  Body body_;
  std::set<Pair> joined_;
  Vector<bool> exposed_;
  Vector<std::uint32_t> labels_;
  Vector<BallFragment> fragments_;
  std::map<Pair, Memory> memories_;
};

}  // namespace crumble
