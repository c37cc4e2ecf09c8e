// What a question to a tool costs: one node of the body, far from it, near its surface, inside.
//   ./solid_bench
// And what making a mesh tool costs.
#include <benchmark/benchmark.h>

#include <cmath>

#include "crumble/base/memory.hpp"
#include "crumble/base/random.hpp"
#include "crumble/base/transcendental.hpp"
#include "crumble/geometry/mesh_solid.hpp"
#include "crumble/geometry/support_solid.hpp"

namespace crumble {
namespace {

constexpr double kRadius = 0.02, kTube = 0.006;  // metres

// A ring of about `triangles` triangles.
TriangleMesh make_ring(std::uint32_t triangles) {
  const auto around = static_cast<std::uint32_t>(std::sqrt(triangles)), along = triangles / 2 / around;
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < along; ++i) {
    for (std::uint32_t k = 0; k < around; ++k) {
      const double u = 2 * kPi * i / along, v = 2 * kPi * k / around, r = kRadius + kTube * cos_exact(v);
      mesh.vertices.push_back({r * cos_exact(u), r * sin_exact(u), kTube * sin_exact(v)});
      const std::uint32_t i_next = (i + 1) % along, k_next = (k + 1) % around;
      const std::uint32_t a = i * around + k, b = i_next * around + k, c = i_next * around + k_next;
      mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {a, c, i * around + k_next}});
    }
  }
  return mesh;
}

void ellipsoid_support(void*, const double direction[3], double point[3]) {
  constexpr double kAxes[3] = {0.004, 0.006, 0.01};
  double squared = 0;
  for (int k = 0; k < 3; ++k) squared += kAxes[k] * kAxes[k] * direction[k] * direction[k];
  for (int k = 0; k < 3; ++k) point[k] = kAxes[k] * kAxes[k] * direction[k] / std::sqrt(squared);
}

enum class Place { far, near, inside };

// Points of that kind in and about the solid's box, each next to the one before as a body's nodes are.
crumble::Vector<Vec3> points_of(const Solid& solid, Place place) {
  Vec3 low = solid->corners()[0], high = low;
  for (std::size_t i = 0; i < solid->corners().size(); ++i) {
    low = low.cwiseMin(solid->corners()[i]), high = high.cwiseMax(solid->corners()[i]);
  }
  const Vec3 margin = 0.1 * (high - low);
  Random random(1);
  crumble::Vector<Vec3> points;
  while (points.size() < 1000) {
    const Vec3 part(random.uniform(), random.uniform(), random.uniform());
    const Vec3 p = low - margin + part.cwiseProduct(high - low + 2 * margin);
    const double distance = solid->nearest(p, 1).signed_distance;
    if (place == Place::far ? distance > 1e-3 : place == Place::inside ? distance < 0 : distance > 0 && distance < 3e-4)
      points.push_back(p);
  }
  return points;
}

void find_inside(benchmark::State& state, const Solid& solid, Place place) {
  const crumble::Vector<Vec3> points = points_of(solid, place);
  crumble::Vector<std::uint32_t> hints(points.size(), 0);
  SolidPoint nearest;
  for (auto _ : state) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      benchmark::DoNotOptimize(solid->find_inside(points[i], hints[i], nearest));
    }
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * points.size()));
}

void make_mesh(benchmark::State& state) {
  const TriangleMesh mesh = make_ring(static_cast<std::uint32_t>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(make_mesh_solid(mesh));
}
BENCHMARK(make_mesh)->Unit(benchmark::kMillisecond)->Arg(2000)->Arg(10000)->Arg(20000)->Arg(100000);

void register_kind(const std::string& name, const Solid& solid) {
  for (const auto& [place, word] :
       {std::pair(Place::far, "far"), std::pair(Place::near, "near"), std::pair(Place::inside, "inside")}) {
    benchmark::RegisterBenchmark((name + "/" + word).c_str(), find_inside, solid, place);
  }
}

}  // namespace
}  // namespace crumble

int main(int argc, char** argv) {
  using namespace crumble;
  register_kind("stick_16_sides", make_round_stick(0.004, 0.05, 16));
  register_kind("stick_60_sides", make_round_stick(0.004, 0.05, 60));
  register_kind("mesh_2k", make_mesh_solid(make_ring(2000)));
  register_kind("mesh_20k", make_mesh_solid(make_ring(20000)));
  register_kind("support", make_support_solid({ellipsoid_support, nullptr}, Vec3::Zero()));
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
