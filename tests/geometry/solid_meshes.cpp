#include "geometry/solid_meshes.hpp"

#include <cmath>

#include "crumble/base/memory.hpp"
#include "crumble/base/random.hpp"
#include "crumble/geometry/convex.hpp"
#include "geometry/direction_sphere.hpp"

namespace crumble {
namespace {

using Point2 = std::array<double, 2>;

Vector<Point2> circle(double x, double y, double radius, std::uint32_t steps) {
  Vector<Point2> points;
  for (std::uint32_t i = 0; i < steps; ++i) {
    const double angle = 2 * M_PI * (i + 0.3) / steps;
    points.push_back({x + radius * std::cos(angle), y + radius * std::sin(angle)});
  }
  return points;
}

}  // namespace

TriangleMesh make_prism(const Vector<Point2>& polygon, double height) {
  TriangleMesh mesh;
  const auto n = static_cast<std::uint32_t>(polygon.size());
  for (const double z : {-0.5 * height, 0.5 * height}) {
    for (const Point2& p : polygon) mesh.vertices.push_back({p[0], p[1], z});
  }
  mesh.vertices.push_back({0, 0, -0.5 * height});
  mesh.vertices.push_back({0, 0, 0.5 * height});
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t next = (i + 1) % n;
    mesh.triangles.push_back({2 * n, next, i});
    mesh.triangles.push_back({2 * n + 1, n + i, n + next});
    mesh.triangles.push_back({i, next, n + next});
    mesh.triangles.push_back({i, n + next, n + i});
  }
  return mesh;
}

TriangleMesh make_revolved(const Vector<Point2>& profile, std::uint32_t steps) {
  TriangleMesh mesh;
  Vector<Vector<std::uint32_t>> ring(profile.size());
  for (std::size_t i = 0; i < profile.size(); ++i) {
    for (std::uint32_t k = 0; k < steps; ++k) {
      if (k == 0 || profile[i][0] > 0) {
        const double angle = 2 * M_PI * k / steps;
        mesh.vertices.push_back({profile[i][0] * std::cos(angle), profile[i][0] * std::sin(angle), profile[i][1]});
      }
      ring[i].push_back(static_cast<std::uint32_t>(mesh.vertices.size() - 1));
    }
  }
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const auto &here = ring[i], &above = ring[(i + 1) % profile.size()];
    for (std::uint32_t k = 0; k < steps; ++k) {
      const std::uint32_t next = (k + 1) % steps;
      if (here[k] != here[next]) mesh.triangles.push_back({here[k], here[next], above[next]});
      if (above[k] != above[next]) mesh.triangles.push_back({here[k], above[next], above[k]});
    }
  }
  return mesh;
}

TriangleMesh make_blob(int levels, double roughness, std::uint64_t seed) {
  TriangleMesh mesh = make_direction_sphere(levels);
  Random random(seed);
  std::array<Vec3, 6> waves;
  for (Vec3& wave : waves) wave = {random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(-4, 4)};
  for (Vec3& v : mesh.vertices) {
    double noise = 0;
    for (const Vec3& wave : waves) noise += std::sin(wave.dot(v)) / waves.size();
    v *= 1 + roughness * noise;
  }
  return mesh;
}

TriangleMesh make_l_shape() {
  return make_prism({{-0.5, -0.5}, {2, -0.5}, {2, 0.5}, {0.5, 0.5}, {0.5, 2}, {-0.5, 2}}, 1);
}

TriangleMesh make_torus(double radius, double tube, std::uint32_t steps, std::uint32_t tube_steps) {
  return make_revolved(circle(radius, 0, tube, tube_steps), steps);
}

TriangleMesh make_cup() {
  return make_revolved({{0, 0}, {0.5, 0}, {1, 0}, {1, 1.5}, {0.9, 1.5}, {0.9, 0.8}, {0.9, 0.1}, {0, 0.1}}, 20);
}

TriangleMesh make_gear() {
  Vector<Point2> polygon;
  for (int i = 0; i < 48; ++i) {
    const double angle = 2 * M_PI * i / 48, radius = i % 4 < 2 ? 1 : 0.8;
    polygon.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return make_prism(polygon, 0.4);
}

TriangleMesh make_hollow_box() {
  TriangleMesh mesh = make_bar({2, 2, 2}).surface;
  const TriangleMesh cavity = make_bar({1, 1, 1}).surface;
  for (const auto& [a, b, c] : cavity.triangles) mesh.triangles.push_back({a + 8, c + 8, b + 8});
  mesh.vertices.insert(mesh.vertices.end(), cavity.vertices.begin(), cavity.vertices.end());
  return mesh;
}

Vector<NamedMesh> concave_meshes() {
  return {{"L shape", make_l_shape()}, {"torus", make_torus(1, 0.3, 24, 12)}, {"cup", make_cup()},
          {"gear", make_gear()},       {"blob", make_blob(2, 0.5, 3)},        {"hollow box", make_hollow_box()}};
}

}  // namespace crumble
