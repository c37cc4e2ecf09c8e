// What a reader costs the stepping thread: CPU time of steps, publish() included, beside a thread that
//   sleeps    all the time
//   draws     brings a surface up to a state that it has, again and again: what any work beside it costs, by the
//             memory and the processor that the two share
//   reads     takes the latest state each time, and its events, and draws that
//   publisher_bench [SECONDS [SPRINGS]]
// Without SPRINGS the paper's cube under its stick, which breaks it; with it the benchmark's lattice of about as many
// springs in float32. Steps at 1 kHz, reads at 60 Hz, or as fast as they go. The three take turns, all over the same
// steps; each figure is the median over its stretches, since a shared machine has good and bad seconds. Microseconds.
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "crumble/base/clock.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/fracture/surface.hpp"
#include "crumble/sim/publisher.hpp"
#include "runner/body.hpp"
#include "runner/clocks.hpp"
#include "scenes/scene.hpp"

namespace crumble::bench {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

enum Work { kSleeps, kDraws, kReads, kWorks };

class Reader {
 public:
  Reader(const TetMesh& mesh, StatePublisher& publisher)
      : surface_(mesh), publisher_(publisher), events_(1024), thread_([this] { run(); }) {}
  ~Reader() {
    end_.store(true);
    thread_.join();
  }
  void set(Work work) { work_.store(work); }
  std::uint64_t states() const { return states_.load(); }

 private:
  void run() {
    for (auto next = Clock::now(); !end_.load(); std::this_thread::sleep_until(next += 1000ms / 60)) {
      next = std::max(next, Clock::now() - 1000ms / 60);
      const Work work = work_.load();
      if (work == kReads) read();
      if (work != kSleeps && state_) {
        surface_.update({state_->positions, state_->intact, state_->fragments, state_->time});
      }
    }
  }
  void read() {
    state_ = &publisher_.latest();
    while (publisher_.read_events(events_) == events_.size()) {
    }
    states_.fetch_add(state_->step != last_step_);
    last_step_ = state_->step;
  }

  SurfaceExtractor surface_;
  StatePublisher& publisher_;
  crumble::Vector<Event> events_;
  std::uint64_t last_step_ = 0;
  const PublishedState* state_ = nullptr;
  std::atomic<Work> work_{kSleeps};
  std::atomic<bool> end_{false};
  std::atomic<std::uint64_t> states_{0};
  std::thread thread_;  // last: it uses the others
};

struct Press {
  SimulationDef def;
  Pose start;
  double speed = 0;                      // m/s, downwards
  std::size_t warm_up = 0, stretch = 0;  // steps

  Pose pose(std::uint64_t step) const {
    Pose pose = start;
    pose.position.y() -= speed * def.step.tau * static_cast<double>(step);
    return pose;
  }
};

Press press_cube() {
  Scene scene = load_scene("tofu_cube", Preset::standard);
  return {std::move(scene.def), scene.motions[0].start, 0.01, 400, 1600};
}

Press press_lattice(std::size_t springs) {
  BenchBody body = make_body(springs, "lattice", "paper");
  body.def.step.precision = Precision::float32;
  Pose start;
  start.position.y() = body.height + 0.004;
  return {std::move(body.def), start, 0.01, 200, 300};
}

Percentiles time_stretch(const Press& press, Simulation& sim, StatePublisher& publisher) {
  crumble::Vector<double> times;
  auto next = Clock::now();
  for (std::size_t i = 0; i < press.stretch; ++i) {
    const Pose pose = press.pose(sim.info().step);
    const double before = thread_cpu_seconds();
    sim.step({&pose, 1});
    publisher.publish(sim);
    times.push_back(1e6 * (thread_cpu_seconds() - before));
    std::this_thread::sleep_until(next += 1ms);
  }
  return percentiles(std::move(times));
}

struct Arm {
  crumble::Vector<double> p50, p99;
  void add(const Percentiles& p) { p50.push_back(p.p50), p99.push_back(p.p99); }
};

void print(const char* name, const Arm* arms, crumble::Vector<double> Arm::*column) {
  const double sleeps = median(arms[kSleeps].*column), draws = median(arms[kDraws].*column);
  const double reads = median(arms[kReads].*column);
  std::printf("%s  sleeps %8.2f  draws %8.2f  reads %8.2f  reads/sleeps %.3f  reads/draws %.3f\n", name, sleeps, draws,
              reads, reads / sleeps, reads / draws);
}

void run(const Press& press, double seconds) {
  Simulation sim(press.def);
  StatePublisher publisher(sim);
  Reader reader(sim.mesh(), publisher);
  while (sim.info().step < press.warm_up) {
    const Pose pose = press.pose(sim.info().step);
    sim.step({&pose, 1});
  }
  const crumble::Vector<std::uint8_t> saved = sim.snapshot();
  Arm arms[kWorks];
  const double end = wall_seconds() + seconds;
  for (int stretch = -kWorks; wall_seconds() < end || stretch <= 0 || stretch % kWorks != 0; ++stretch) {
    const auto work = static_cast<Work>((stretch + kWorks) % kWorks);
    sim.restore(saved);
    publisher.publish_now(sim);
    reader.set(work);
    const Percentiles p = time_stretch(press, sim, publisher);
    if (stretch >= 0) arms[work].add(p);  // those before warm up
  }
  reader.set(kSleeps);
  std::printf("%zu nodes, %zu springs, %zu cuts, %zu states read; 3 x %zu stretches of %zu steps\n",
              sim.mesh().node_count(), sim.network().spring_count(), static_cast<std::size_t>(sim.counters().cuts),
              static_cast<std::size_t>(reader.states()), arms[kReads].p99.size(), press.stretch);
  print("p50", arms, &Arm::p50);
  print("p99", arms, &Arm::p99);
}

}  // namespace
}  // namespace crumble::bench

int main(int argc, char** argv) {
  using namespace crumble::bench;
  const double seconds = argc > 1 ? std::atof(argv[1]) : 60;
  run(argc > 2 ? press_lattice(std::strtoull(argv[2], nullptr, 10)) : press_cube(), seconds);
}
