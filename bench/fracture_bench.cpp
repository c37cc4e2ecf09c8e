// Fragments and surface on a body of about 8000 springs and 6000 tetrahedra.
//   ./fracture_bench --benchmark_min_time=1
#include <benchmark/benchmark.h>

#include <ctime>

#include "crumble/base/memory.hpp"
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
Vector<std::uint8_t> intact_flags(std::int64_t percent) {
  Random random(7);
  Vector<std::uint8_t> intact(body().springs.size());
  for (std::uint8_t& flag : intact) flag = random.uniform() * 100 >= static_cast<double>(percent);
  return intact;
}

void name_body(benchmark::State& state) {
  state.counters["springs"] = static_cast<double>(body().springs.size());
  state.counters["tetrahedra"] = static_cast<double>(body().tetrahedra.size());
}

// The argument is the percentage of cut springs.
void label_fragments(benchmark::State& state) {
  const Vector<std::uint8_t> intact = intact_flags(state.range(0));
  FragmentLabeler labeler(body().node_count(), body().springs);
  for (auto _ : state) benchmark::DoNotOptimize(labeler.label(intact));
  state.counters["fragments"] = static_cast<double>(labeler.count());
  name_body(state);
}
BENCHMARK(label_fragments)->Arg(0)->Arg(10)->Arg(50)->Arg(100)->Unit(benchmark::kMicrosecond);

// A body a little deformed, as the extractor gets it.
struct Scene {
  explicit Scene(std::int64_t percent)
      : positions(body().positions), intact(intact_flags(percent)), labeler(body().node_count(), body().springs) {
    Random random(8);
    for (double& x : positions.x) x += random.uniform(-2e-4, 2e-4);
    labeler.label(intact);
    labels.assign(labeler.labels().begin(), labeler.labels().end());
  }
  SurfaceInput now() const { return {positions, intact, labels, time}; }

  VecArray positions;
  Vector<std::uint8_t> intact;
  FragmentLabeler labeler;
  Vector<std::uint32_t> labels;
  double time = 0;
};

// Everything anew: triangles, positions, normals.
void rebuild_surface(benchmark::State& state) {
  const Scene scene(state.range(0));
  SurfaceExtractor surface(body());
  for (auto _ : state) surface.rebuild(scene.now());
  state.counters["triangles"] = static_cast<double>(surface.triangles().size());
  name_body(state);
}
BENCHMARK(rebuild_surface)->Arg(0)->Arg(10)->Arg(50)->Arg(100)->Unit(benchmark::kMicrosecond);

// The next picture without a new cut: rotations, positions, normals.
void update_surface(benchmark::State& state) {
  const Scene scene(state.range(0));
  SurfaceExtractor surface(body());
  surface.update(scene.now());
  for (auto _ : state) surface.update(scene.now());
  name_body(state);
}
BENCHMARK(update_surface)->Arg(0)->Arg(10)->Arg(50)->Arg(100)->Unit(benchmark::kMicrosecond);

// The next picture after 50 cuts, in CPU time. Labels stay as they were.
void update_surface_after_50_cuts(benchmark::State& state) {
  const Scene before(state.range(0));
  Scene after = before;
  Random random(9);
  for (int cut = 0; cut < 50;) {
    std::uint8_t& flag = after.intact[random.below(after.intact.size())];
    cut += flag;
    flag = 0;
  }
  SurfaceExtractor surface(body());
  std::size_t changed = 0;
  for (auto _ : state) {
    surface.rebuild(before.now());
    surface.update(before.now());
    const std::clock_t start = std::clock();
    surface.update(after.now());
    state.SetIterationTime(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    changed = surface.changed_triangles().size();
  }
  state.counters["changed"] = static_cast<double>(changed);
  name_body(state);
}
BENCHMARK(update_surface_after_50_cuts)->Arg(0)->Arg(10)->Arg(50)->UseManualTime()->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace crumble

BENCHMARK_MAIN();
