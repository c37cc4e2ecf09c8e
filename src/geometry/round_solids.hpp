// What the solids of revolution about Z share.
#pragma once

#include <array>
#include <string>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/transcendental.hpp"
#include "crumble/geometry/triangle_mesh.hpp"

namespace crumble {

struct ProfilePoint {
  double radius;  // distance from the axis
  double z;
};

/// Unit vector from the axis to p, +X for a point on it.
inline Vec3 away_from_axis(const Vec3& p, double distance) {
  return distance > 0 ? Vec3(p.x() / distance, p.y() / distance, 0) : Vec3::UnitX();
}

/// Squares of sizes must stay numbers, and nothing is moved about farther away than this anyway.
inline void require_size(const char* field, double value) {
  require_positive(field, value);
  require_in_range(field, value, 0, 1000);
}

/// The closed surface that `profile` sweeps when it turns about Z. Its first and last point lie on the axis, the first
/// one lowest.
inline TriangleMesh revolve(const Vector<ProfilePoint>& profile) {
  constexpr std::uint32_t kSides = 32;
  TriangleMesh mesh;
  mesh.vertices.push_back({0, 0, profile.front().z});
  for (std::size_t ring = 1; ring + 1 < profile.size(); ++ring) {
    for (std::uint32_t i = 0; i < kSides; ++i) {
      const double angle = 2 * kPi * i / kSides;
      mesh.vertices.push_back(
          {profile[ring].radius * cos_exact(angle), profile[ring].radius * sin_exact(angle), profile[ring].z});
    }
  }
  mesh.vertices.push_back({0, 0, profile.back().z});
  const auto rings = static_cast<std::uint32_t>(profile.size()) - 2, last = 1 + kSides * rings;
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const std::uint32_t next = (i + 1) % kSides;
    mesh.triangles.push_back({0, 1 + next, 1 + i});
    for (std::uint32_t ring = 0; ring + 1 < rings; ++ring) {
      const std::uint32_t low = 1 + kSides * ring, high = low + kSides;
      mesh.triangles.push_back({low + i, low + next, high + next});
      mesh.triangles.push_back({low + i, high + next, high + i});
    }
    mesh.triangles.push_back({last - kSides + i, last - kSides + next, last});
  }
  return mesh;
}

}  // namespace crumble
