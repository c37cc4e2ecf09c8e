// The whole step and each of its stages while a stick presses the paper's bodies, and a body of 8000 springs.
//   ./step_bench --benchmark_min_time=2
// Time and CPU are those of a step. Counters: how often the paper's 300 Hz fits into the CPU time (the paper reaches
// 1.15 with 8000 edges), and the mean wall time of each stage in microseconds, in the order of a step.
#include <benchmark/benchmark.h>

#include "crumble/base/memory.hpp"
#include "scenes/scene.hpp"

namespace crumble {
namespace {

constexpr std::size_t kWindow = 1000;  // steps that are measured again and again: 1 s of the press

// A body with the stick a third deep in it, and the poses that take the stick on.
class Press {
 public:
  explicit Press(const Scene& scene) : sim_(scene.def) {
    const auto device = open_press(scene.motions[0].press, scene.def.step.tau);
    const auto warm_up = static_cast<std::size_t>(scene.top / 3 / scene.motions[0].press.speed / scene.def.step.tau);
    DeviceSample sample;
    for (std::size_t step = 0; step < warm_up; ++step) {
      if (device->read(sample) == ReadStatus::ok) sim_.step({&sample.pose, 1});
    }
    snapshot_ = sim_.snapshot();
    while (poses_.size() < kWindow && device->read(sample) == ReadStatus::ok) poses_.push_back(sample.pose);
  }
  bool at_end() const { return next_ == poses_.size(); }
  void rewind() {
    sim_.restore(snapshot_);
    next_ = 0;
  }
  void step() { sim_.step({&poses_[next_++], 1}); }
  const Simulation& sim() const { return sim_; }

 private:
  Simulation sim_;
  Vector<std::uint8_t> snapshot_;
  Vector<Pose> poses_;
  std::size_t next_ = 0;
};

void add(StepProfile& sum, const StepProfile& step) {
  sum.move_tool += step.move_tool;
  sum.find_contacts += step.find_contacts;
  sum.project_contacts += step.project_contacts;
  sum.touch_fragments += step.touch_fragments;
  sum.solve_network += step.solve_network;
  sum.cut_springs += step.cut_springs;
  sum.sum_reaction += step.sum_reaction;
  sum.finish_step += step.finish_step;
}

void report(benchmark::State& state, const Press& press, const StepProfile& sum) {
  using benchmark::Counter;
  const auto mean_us = [](double seconds) { return Counter(1e6 * seconds, Counter::kAvgIterations); };
  state.counters["of_300hz"] = Counter(1.0 / 300, Counter::kIsIterationInvariantRate);
  state.counters["springs"] = static_cast<double>(press.sim().mesh().springs.size());
  state.counters["contacts"] = press.sim().info().contacts;
  state.counters["1_move_tool"] = mean_us(sum.move_tool);
  state.counters["2_find_contacts"] = mean_us(sum.find_contacts);
  state.counters["3_project_contacts"] = mean_us(sum.project_contacts);
  state.counters["4_touch_fragments"] = mean_us(sum.touch_fragments);
  state.counters["5_solve_network"] = mean_us(sum.solve_network);
  state.counters["6_cut_springs"] = mean_us(sum.cut_springs);
  state.counters["7_sum_reaction"] = mean_us(sum.sum_reaction);
  state.counters["8_finish_step"] = mean_us(sum.finish_step);
}

void step(benchmark::State& state, const char* name, Precision precision) {
  Scene scene = load_scene(name, Preset::standard);
  scene.def.step.precision = precision;
  Press press(scene);
  StepProfile sum;
  for (auto _ : state) {
    if (press.at_end()) {
      state.PauseTiming();
      press.rewind();
      state.ResumeTiming();
    }
    press.step();
    add(sum, press.sim().profile());
  }
  report(state, press, sum);
}
BENCHMARK_CAPTURE(step, cube_float32, "tofu_cube", Precision::float32)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(step, cube_float64, "tofu_cube", Precision::float64)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(step, slab_float32, "tofu_slab", Precision::float32)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(step, slab_float64, "tofu_slab", Precision::float64)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(step, globe_float32, "tofu_globe", Precision::float32)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(step, globe_float64, "tofu_globe", Precision::float64)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(step, cube_8000_float32, "tofu_cube_8000", Precision::float32)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(step, cube_8000_float64, "tofu_cube_8000", Precision::float64)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace crumble

BENCHMARK_MAIN();
