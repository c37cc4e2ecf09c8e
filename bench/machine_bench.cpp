// What the machine can do at best, for the roofline of docs/performance.md: bytes per second from each level of memory
// and roots and quotients per second, with the widest vectors that the processor has.
//   ./machine_bench
#include <benchmark/benchmark.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "machine_bench.cpp"  // this file, once for each kind of vectors
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <vector>

HWY_BEFORE_NAMESPACE();
namespace crumble::bench {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::ScalableTag<float>;

// Sum of an array, four sums at a time so that no addition waits for another.
float read_all(const float* from, std::size_t count) {
  const Tag d;
  const std::size_t lanes = hn::Lanes(d);
  auto a = hn::Zero(d), b = a, c = a, e = a;
  for (std::size_t i = 0; i < count; i += 4 * lanes) {
    a = hn::Add(a, hn::LoadU(d, from + i));
    b = hn::Add(b, hn::LoadU(d, from + i + lanes));
    c = hn::Add(c, hn::LoadU(d, from + i + 2 * lanes));
    e = hn::Add(e, hn::LoadU(d, from + i + 3 * lanes));
  }
  return hn::GetLane(hn::SumOfLanes(d, hn::Add(hn::Add(a, b), hn::Add(c, e))));
}

// In place: as much read as written, as with the forces.
void update_all(float* values, std::size_t count) {
  const Tag d;
  const auto one = hn::Set(d, 1.0f);
  for (std::size_t i = 0; i < count; i += hn::Lanes(d))
    hn::StoreU(hn::Add(hn::LoadU(d, values + i), one), d, values + i);
}

void root_all(float* values, std::size_t count) {
  const Tag d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) hn::StoreU(hn::Sqrt(hn::LoadU(d, values + i)), d, values + i);
}

void divide_all(float* values, std::size_t count) {
  const Tag d;
  const auto one = hn::Set(d, 1.5f);
  for (std::size_t i = 0; i < count; i += hn::Lanes(d))
    hn::StoreU(hn::Div(one, hn::LoadU(d, values + i)), d, values + i);
}

// One of each, which is what a spring takes.
void root_and_divide_all(float* values, std::size_t count) {
  const Tag d;
  const auto one = hn::Set(d, 1.5f);
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    hn::StoreU(hn::Div(one, hn::Sqrt(hn::LoadU(d, values + i))), d, values + i);
  }
}

const char* target_name() {
  return hwy::TargetName(HWY_TARGET);
}

}  // namespace HWY_NAMESPACE
}  // namespace crumble::bench
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace crumble::bench {
namespace {

HWY_EXPORT(read_all);
HWY_EXPORT(update_all);
HWY_EXPORT(root_all);
HWY_EXPORT(divide_all);
HWY_EXPORT(root_and_divide_all);
HWY_EXPORT(target_name);

std::size_t count_of(benchmark::State& state) {
  state.SetLabel(HWY_DYNAMIC_DISPATCH(target_name)());
  return static_cast<std::size_t>(state.range(0)) * 1024 / sizeof(float);
}

// The argument is the size in KiB: level 1, level 2, level 3, memory.
void read_bandwidth(benchmark::State& state) {
  const std::vector<float> values(count_of(state), 1.0f);
  for (auto _ : state) benchmark::DoNotOptimize(HWY_DYNAMIC_DISPATCH(read_all)(values.data(), values.size()));
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * values.size() * sizeof(float)));
}
BENCHMARK(read_bandwidth)->Arg(16)->Arg(512)->Arg(8 << 10)->Arg(256 << 10);

void update_bandwidth(benchmark::State& state) {
  std::vector<float> values(count_of(state), 1.0f);
  for (auto _ : state) HWY_DYNAMIC_DISPATCH(update_all)(values.data(), values.size());
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * values.size() * 2 * sizeof(float)));
}
BENCHMARK(update_bandwidth)->Arg(16)->Arg(512)->Arg(8 << 10)->Arg(256 << 10);

void time_operation(benchmark::State& state, void (*operation)(float*, std::size_t)) {
  std::vector<float> values(count_of(state), 1.3f);
  for (auto _ : state) operation(values.data(), values.size());
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * values.size()));
}
void roots(benchmark::State& state) {
  time_operation(state, HWY_DYNAMIC_DISPATCH(root_all));
}
void quotients(benchmark::State& state) {
  time_operation(state, HWY_DYNAMIC_DISPATCH(divide_all));
}
void roots_and_quotients(benchmark::State& state) {
  time_operation(state, HWY_DYNAMIC_DISPATCH(root_and_divide_all));
}
BENCHMARK(roots)->Arg(16);
BENCHMARK(quotients)->Arg(16);
BENCHMARK(roots_and_quotients)->Arg(16);

}  // namespace
}  // namespace crumble::bench

BENCHMARK_MAIN();
#endif
