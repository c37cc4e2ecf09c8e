// Fragments and surface on a body of about 8000 springs and 6000 tetrahedra.
//   ./fracture_bench --benchmark_min_time=1
#include <benchmark/benchmark.h>

#include <numeric>
#include <vector>

#include "crumble/base/random.hpp"
#include "crumble/fracture/fragments.hpp"
#include "crumble/fracture/surface.hpp"
#include "crumble/tetmesh/lattice_box.hpp"

namespace crumble {
namespace {

// 10 x 10 x 10 cubes: 6000 tetrahedra, 7930 springs.
const TetMesh& body() {
  static const TetMesh mesh = make_lattice_box(Vec3(0.03, 0.03, 0.03), 0.003);
  return mesh;
}

// `percent` of the springs cut, chosen at random.
std::vector<std::uint8_t> intact_flags(std::int64_t percent) {
  Random random(7);
  std::vector<std::uint8_t> intact(body().springs.size());
  for (std::uint8_t& flag : intact) flag = random.uniform() * 100 >= static_cast<double>(percent);
  return intact;
}

void name_body(benchmark::State& state) {
  state.counters["springs"] = static_cast<double>(body().springs.size());
  state.counters["tetrahedra"] = static_cast<double>(body().tetrahedra.size());
}

// The argument is the percentage of cut springs.
void label_fragments(benchmark::State& state) {
  const std::vector<std::uint8_t> intact = intact_flags(state.range(0));
  FragmentLabeler labeler(body().node_count(), body().springs);
  for (auto _ : state) benchmark::DoNotOptimize(labeler.label(intact));
  state.counters["fragments"] = static_cast<double>(labeler.count());
  name_body(state);
}
BENCHMARK(label_fragments)->Arg(0)->Arg(10)->Arg(50)->Arg(100)->Unit(benchmark::kMicrosecond);

void extract_surface(benchmark::State& state) {
  const std::vector<std::uint8_t> intact = intact_flags(state.range(0));
  FragmentLabeler labeler(body().node_count(), body().springs);
  labeler.label(intact);
  SurfaceExtractor surface(body());
  for (auto _ : state) surface.extract(intact, labeler.labels());
  state.counters["triangles"] = static_cast<double>(surface.triangles().size());
  name_body(state);
}
BENCHMARK(extract_surface)->Arg(0)->Arg(10)->Arg(50)->Arg(100)->Unit(benchmark::kMicrosecond);

// Rotation fits, positions and normals of a body a little deformed.
void update_surface(benchmark::State& state) {
  const std::vector<std::uint8_t> intact = intact_flags(state.range(0));
  FragmentLabeler labeler(body().node_count(), body().springs);
  labeler.label(intact);
  SurfaceExtractor surface(body());
  surface.extract(intact, labeler.labels());
  VecArray positions(body().positions);
  Random random(8);
  for (double& x : positions.x) x += random.uniform(-2e-4, 2e-4);
  for (auto _ : state) surface.update(positions);
  name_body(state);
}
BENCHMARK(update_surface)->Arg(0)->Arg(10)->Arg(50)->Arg(100)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace crumble

BENCHMARK_MAIN();
