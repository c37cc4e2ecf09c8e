// What a servo tick costs: CPU time of whole ticks of the haptic loop while a simulated hand presses the paper's cube
// until it breaks, beside the bare steps of the same simulation with the same poses. Microseconds.
//   loop_bench [SECONDS]
// Each loop is run alone, then with a thread beside it that takes status, times and states as fast as it can, then one
// that takes a state and then stalls for a second: a reader must not cost the loop anything. The three take turns over
// the same motion; each figure is the median over its turns.
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <thread>

#include "crumble/base/clock.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/device/hand.hpp"
#include "crumble/haptics/loop.hpp"
#include "runner/clocks.hpp"
#include "scenes/scene.hpp"

namespace crumble::bench {
namespace {

using namespace std::chrono_literals;

constexpr int kTurns = 5;

struct Kind {
  const char* name;
  BodyCoupling coupling;
  std::uint32_t body_ticks;
};
constexpr Kind kKinds[] = {{"direct", BodyCoupling::direct, 1},
                           {"local_model, every 3rd tick steps", BodyCoupling::local_model, 3},
                           {"paper, every 3rd tick steps", BodyCoupling::paper, 3}};

HandOptions firm_hand(const Pose& start, double seconds) {
  HandOptions hand;
  hand.start = start;
  hand.mass = 0.25, hand.stiffness = 500, hand.damping = 10;
  hand.points = {{0.7, Vec3::Zero()}, {seconds, {0, -0.024, 0}}};
  return hand;
}

enum class Reader { none, eager, stalls };

class Beside {
 public:
  Beside(Reader kind, const HapticLoop& loop, StatePublisher& publisher) {
    if (kind == Reader::none) return;
    thread_ = std::thread([this, kind, &loop, &publisher] {
      while (!end_) {
        sum_ += loop.status().ticks + loop.times().tick_wall.count + publisher.latest().step;
        if (kind == Reader::stalls) {
          for (int i = 0; i < 1000 && !end_; ++i) std::this_thread::sleep_for(1ms);
        }
      }
    });
  }
  ~Beside() {
    end_ = true;
    if (thread_.joinable()) thread_.join();
  }

 private:
  std::thread thread_;
  std::atomic<bool> end_{false};
  std::uint64_t sum_ = 0;
};

struct Cost {
  Percentiles tick, step;
  std::uint64_t cuts = 0;
};

Cost measure(const Scene& scene, const Kind& kind, Reader reader, double seconds) {
  SimulationDef def = scene.def;
  def.step.tau = 1e-3 * kind.body_ticks;
  Simulation sim(def);
  const Simulation fresh = sim;
  SimulatedHand hand(firm_hand(scene.motions[0].start, seconds), 1e-3);
  LoopDef loop_def;
  loop_def.driver = LoopDriver::host;
  loop_def.coupling = kind.coupling, loop_def.body_ticks = kind.body_ticks;
  loop_def.hands.resize(1);
  loop_def.hands[0].device = &hand;
  HapticLoop loop(sim, loop_def);
  StatePublisher publisher(sim);
  loop.publish_to(publisher);
  const auto ticks = static_cast<std::size_t>(seconds / 1e-3);
  crumble::Vector<double> tick_cost(ticks), step_cost(ticks / kind.body_ticks);
  crumble::Vector<Pose> poses(ticks);
  {
    const Beside beside(reader, loop, publisher);
    for (std::size_t k = 0; k < ticks; ++k) {
      const double before = thread_cpu_seconds();
      loop.tick();
      tick_cost[k] = 1e6 * (thread_cpu_seconds() - before);
      poses[k] = loop.status().hands[0].tool;
    }
  }
  Simulation bare = fresh;
  for (std::size_t k = 0; k < step_cost.size(); ++k) {
    const double before = thread_cpu_seconds();
    bare.step({&poses[k * kind.body_ticks], 1});
    step_cost[k] = 1e6 * (thread_cpu_seconds() - before);
  }
  return {percentiles(std::move(tick_cost)), percentiles(std::move(step_cost)), sim.counters().cuts};
}

void report(const char* name, const crumble::Vector<Cost>& costs) {
  const auto middle = [&](auto&& pick) {
    crumble::Vector<double> values;
    for (const Cost& cost : costs) values.push_back(pick(cost));
    return median(values);
  };
  std::printf("  %-22s tick p50 %6.1f  p99 %6.1f  p99.9 %6.1f  max %7.1f   bare step p50 %6.1f  p99 %6.1f\n", name,
              middle([](const Cost& c) { return c.tick.p50; }), middle([](const Cost& c) { return c.tick.p99; }),
              middle([](const Cost& c) { return c.tick.p99_9; }), middle([](const Cost& c) { return c.tick.max; }),
              middle([](const Cost& c) { return c.step.p50; }), middle([](const Cost& c) { return c.step.p99; }));
}

void run(double seconds) {
  const Scene scene = load_scene("tofu_cube", Preset::standard);
  for (const Kind& kind : kKinds) {
    crumble::Vector<Cost> alone, eager, stalled;
    for (int turn = 0; turn < kTurns; ++turn) {
      alone.push_back(measure(scene, kind, Reader::none, seconds));
      eager.push_back(measure(scene, kind, Reader::eager, seconds));
      stalled.push_back(measure(scene, kind, Reader::stalls, seconds));
    }
    std::printf("%s; %llu springs cut\n", kind.name, static_cast<unsigned long long>(alone[0].cuts));
    report("alone", alone);
    report("reader without pause", eager);
    report("reader that stalls 1 s", stalled);
  }
}

}  // namespace
}  // namespace crumble::bench

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 4;
  if (!(seconds >= 1)) {
    std::fprintf(stderr, "loop_bench [SECONDS], 1 or more\n");
    return 2;
  }
  crumble::bench::run(seconds);
}
