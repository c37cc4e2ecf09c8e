// What fragments cost: the search in the step, and the reader's measures and lists.
//   ./fragments_bench --benchmark_min_time=0.5
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "crumble/base/memory.hpp"
#include "crumble/base/random.hpp"
#include "crumble/fracture/fragment_tracker.hpp"
#include "crumble/fracture/fragments.hpp"
#include "crumble/tetmesh/lattice_box.hpp"

namespace crumble {
namespace {

using Ids = Vector<std::uint32_t>;

// 10 cubes along each edge: 1331 nodes, 7930 springs, 6000 tetrahedra.
const TetMesh& small_body() {
  static const TetMesh mesh = make_lattice_box(Vec3(0.03, 0.03, 0.03), 0.003);
  return mesh;
}

// 52 cubes: 148 877 nodes, 1 008 436 springs.
const TetMesh& large_body() {
  static const TetMesh mesh = make_lattice_box(Vec3(0.156, 0.156, 0.156), 0.003);
  return mesh;
}

double distance(const TetMesh& mesh, std::uint32_t spring, double place) {
  const auto [a, b] = mesh.springs[spring];
  return std::abs((mesh.positions[a].x() + mesh.positions[b].x()) / 2 - place);
}

// The `count` springs whose middles are nearest to the plane x = `place`.
Ids springs_near_plane(const TetMesh& mesh, double place, std::size_t count) {
  Ids springs(mesh.springs.size());
  for (std::uint32_t s = 0; s < springs.size(); ++s) springs[s] = s;
  std::stable_sort(springs.begin(), springs.end(),
                   [&](auto a, auto b) { return distance(mesh, a, place) < distance(mesh, b, place); });
  springs.resize(count);
  std::sort(springs.begin(), springs.end());
  return springs;
}

Ids springs_across(const TetMesh& mesh, double place) {
  Ids across;
  for (std::uint32_t s = 0; s < mesh.springs.size(); ++s) {
    const auto [a, b] = mesh.springs[s];
    if ((mesh.positions[a].x() < place) != (mesh.positions[b].x() < place)) across.push_back(s);
  }
  return across;
}

// One spring after the other, at random, until a fortieth of them is cut: time per call.
void single_cuts(benchmark::State& state, const TetMesh& mesh) {
  Random random(9);
  Ids order(mesh.springs.size() / 40);
  for (std::uint32_t& spring : order) spring = static_cast<std::uint32_t>(random.below(mesh.springs.size()));
  FragmentTracker tracker(mesh.node_count(), mesh.springs);
  for (auto _ : state) {
    for (std::size_t i = 0; i < order.size(); ++i) tracker.cut({&order[i], 1}, i);
    state.PauseTiming();
    tracker.reset();
    state.ResumeTiming();
  }
  state.counters["per_call"] = benchmark::Counter(
      static_cast<double>(order.size()), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK_CAPTURE(single_cuts, small, small_body())->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(single_cuts, large, large_body())->Unit(benchmark::kMicrosecond);

void idle_call(benchmark::State& state) {
  FragmentTracker tracker(small_body().node_count(), small_body().springs);
  for (auto _ : state) {
    tracker.cut({}, 1);
    benchmark::ClobberMemory();
  }
}
BENCHMARK(idle_call)->Unit(benchmark::kNanosecond);

// 500 cuts in one call, along a plane at so many per cent of the width.
void burst_of_500(benchmark::State& state) {
  const double place = (static_cast<double>(state.range(0)) / 100 - 0.5) * 0.03;
  const Ids burst = springs_near_plane(small_body(), place, 500);
  FragmentTracker tracker(small_body().node_count(), small_body().springs);
  for (auto _ : state) {
    tracker.cut(burst, 1);
    state.PauseTiming();
    if (tracker.count() < 2) state.SkipWithError("the plane parted nothing");
    tracker.reset();
    state.ResumeTiming();
  }
}
BENCHMARK(burst_of_500)->Arg(15)->Arg(45)->Unit(benchmark::kMicrosecond);

// The same state labelled afresh, for comparison.
void labelling_after_burst(benchmark::State& state) {
  Vector<std::uint8_t> intact(small_body().springs.size(), 1);
  for (const std::uint32_t spring : springs_near_plane(small_body(), -0.0015, 500)) intact[spring] = 0;
  FragmentLabeler labeler(small_body().node_count(), small_body().springs);
  for (auto _ : state) benchmark::DoNotOptimize(labeler.label(intact));
}
BENCHMARK(labelling_after_burst)->Unit(benchmark::kMicrosecond);

// A plane through the large body: how many calls until the halves are known, and the dearest of them.
void plane_through_large_body(benchmark::State& state) {
  const Ids burst = springs_across(large_body(), 0.0001);
  FragmentTracker tracker(large_body().node_count(), large_body().springs);
  double calls = 0, worst = 0;
  for (auto _ : state) {
    calls = 0;
    do {
      const auto start = std::chrono::steady_clock::now();
      tracker.cut(calls == 0 ? std::span<const std::uint32_t>(burst) : std::span<const std::uint32_t>(), 1);
      worst = std::max(worst, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
      ++calls;
    } while (!tracker.settled());
    state.PauseTiming();
    tracker.reset();
    state.ResumeTiming();
  }
  state.counters["cuts"] = static_cast<double>(burst.size());
  state.counters["calls"] = calls;
  state.counters["worst_us"] = worst * 1e6;
}
BENCHMARK(plane_through_large_body)->Unit(benchmark::kMicrosecond);

// Labels of 1 fragment, of 5 x 5 x 8 blocks, or of one fragment per node.
Ids block_labels(std::size_t count) {
  Ids labels;
  for (std::uint32_t node = 0; node < small_body().node_count(); ++node) {
    const auto block = [&](int axis, double low, std::uint32_t blocks) {
      return static_cast<std::uint32_t>((small_body().positions[node][axis] - low) / 0.0300001 * blocks);
    };
    const std::uint32_t of_200 = (block(0, -0.015, 5) * 5 + block(1, 0, 5)) * 8 + block(2, -0.015, 8);
    labels.push_back(count == 1 ? 0 : count == 200 ? of_200 : node);
  }
  return labels;
}

void measure(benchmark::State& state) {
  const auto count = static_cast<std::size_t>(state.range(0));
  const Ids labels = block_labels(count);
  const Vector<double> masses(labels.size(), 1e-5);
  const VecArray positions(small_body().positions), velocities(labels.size());
  Vector<Fragment> fragments(count);
  for (auto _ : state) {
    measure_fragments(small_body(), labels, masses, positions, fragments, velocities);
    benchmark::ClobberMemory();
  }
}
BENCHMARK(measure)->Arg(1)->Arg(200)->Arg(1331)->Unit(benchmark::kMicrosecond);

void list(benchmark::State& state) {
  const auto count = static_cast<std::size_t>(state.range(0));
  const Ids labels = block_labels(count);
  FragmentLists lists(small_body());
  for (auto _ : state) {
    lists.update(labels, count);
    benchmark::ClobberMemory();
  }
}
BENCHMARK(list)->Arg(1)->Arg(200)->Arg(1331)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace crumble

BENCHMARK_MAIN();
