#include "runner/measure.hpp"

#include <algorithm>
#include <cmath>

#include "crumble/base/clock.hpp"
#include "crumble/base/memory.hpp"
#include "runner/choice.hpp"
#include "runner/network_race.hpp"

namespace crumble::bench {
namespace {

constexpr int kPasses = 3;

// The stick goes straight down: at 10 mm/s until it is 10 mm deep, then at 2 mm/s; a scaled stick that much deeper and
// faster. The timed window begins where the stick slows down, and springs break in it.
class Press {
 public:
  Press(const BenchBody& body, double tau)
      : top_(body.height + 0.004 * body.stick_scale),
        fast_(0.01 * body.stick_scale * tau),
        slow_(0.002 * body.stick_scale * tau),
        fast_steps_(static_cast<std::size_t>(0.01 * body.stick_scale / fast_)) {}
  std::size_t warm_up_steps() const { return fast_steps_; }
  Pose pose(std::size_t step) const {
    const auto fast = static_cast<double>(std::min(step, fast_steps_));
    const auto slow = static_cast<double>(step - std::min(step, fast_steps_));
    return {{0, top_ - fast * fast_ - slow * slow_, 0}, Quat::Identity()};
  }

 private:
  double top_, fast_, slow_;
  std::size_t fast_steps_;
};

void step(Simulation& sim, const Pose& pose) {
  const StepInfo& info = sim.step({&pose, 1});
  if (info.status == Code::diverged) {
    throw Error(Code::diverged, "the body diverged at step " + std::to_string(info.step));
  }
}

// Each of the steps has been timed in every pass.
struct Times {
  Vector<double> cpu, wall;  // microseconds
};

// What the machine does to any program: an empty loop that takes as long as the median step, as many times.
Times time_control(double microseconds, std::size_t count, double clock_cost) {
  constexpr std::uint64_t kTrial = 1'000'000;
  const double before = thread_cpu_seconds();
  empty_loop(kTrial);
  const double turn = 1e6 * (thread_cpu_seconds() - before) / static_cast<double>(kTrial);
  const auto turns = static_cast<std::uint64_t>(microseconds / turn);
  Times times;
  for (std::size_t i = 0; i < count; ++i) {
    const double cpu = thread_cpu_seconds(), wall = wall_seconds();
    empty_loop(turns);
    times.wall.push_back(1e6 * (wall_seconds() - wall));
    times.cpu.push_back(1e6 * (thread_cpu_seconds() - cpu) - clock_cost);
  }
  return times;
}

// Microseconds that a clock adds to what it measures.
double cost_of(double (*clock)() noexcept) {
  Vector<double> costs;
  for (int i = 0; i < 1001; ++i) {
    const double before = clock();
    wall_seconds(), wall_seconds();
    costs.push_back(1e6 * (clock() - before));
  }
  return median(std::move(costs));
}

// The step's own CPU time: what an interrupt takes hits one pass, what the step does comes back in each.
Vector<double> medians_of_passes(const Vector<double>& times, std::size_t steps) {
  Vector<double> medians;
  for (std::size_t i = 0; i < steps; ++i) {
    Vector<double> passes;
    passes.reserve(kPasses);
    for (std::size_t at = i; at < times.size(); at += steps) passes.push_back(times[at]);
    medians.push_back(median(std::move(passes)));
  }
  return medians;
}

StepProfile medians(const Vector<StepProfile>& profiles) {
  StepProfile result;
  for (double StepProfile::*stage :
       {&StepProfile::move_tool, &StepProfile::find_contacts, &StepProfile::project_contacts,
        &StepProfile::touch_fragments, &StepProfile::solve_network, &StepProfile::cut_springs,
        &StepProfile::sum_reaction, &StepProfile::finish_step}) {
    Vector<double> times;
    times.reserve(profiles.size());
    for (const StepProfile& profile : profiles) times.push_back(1e6 * profile.*stage);
    result.*stage = median(std::move(times));
  }
  return result;
}

// Warm up, save, try the window's beginning; then restore and time, three times over.
void time_steps(const BenchBody& body, Simulation& sim, Row& row) {
  const Press press(body, sim.definition().step.tau);
  const std::size_t first = press.warm_up_steps();
  for (std::size_t i = 0; i < first; ++i) step(sim, press.pose(i));
  row.cuts_before = sim.counters().cuts;
  const Vector<std::uint8_t> saved = sim.snapshot();
  for (std::size_t i = 0; i < std::min<std::size_t>(row.steps, 50); ++i) step(sim, press.pose(first + i));

  const double clock_cost = cost_of(thread_cpu_seconds);
  Times times;
  Vector<StepProfile> profiles;
  for (int pass = 0; pass < kPasses; ++pass) {
    sim.restore(saved);
    for (std::size_t i = 0; i < row.steps; ++i) {
      const Pose pose = press.pose(first + i);
      const double cpu = thread_cpu_seconds(), wall = wall_seconds();
      step(sim, pose);
      times.wall.push_back(1e6 * (wall_seconds() - wall));
      times.cpu.push_back(1e6 * (thread_cpu_seconds() - cpu) - clock_cost);
      profiles.push_back(sim.profile());
    }
  }
  row.step_cpu = percentiles(medians_of_passes(times.cpu, row.steps));
  row.step_raw = percentiles(std::move(times.cpu)), row.step_wall = percentiles(std::move(times.wall));
  row.stages = medians(profiles);
  row.cuts = sim.counters().cuts - row.cuts_before;
  row.contacts = sim.info().contacts;
  row.hash = sim.state_hash();
  Times control = time_control(row.step_wall.p50, kPasses * row.steps, cost_of(thread_cpu_seconds));
  row.control_raw = percentiles(std::move(control.cpu)), row.control_wall = percentiles(std::move(control.wall));
}

}  // namespace

Vector<std::string> precision_names() {
  return {"float32", "float64"};
}

Precision parse_precision(const std::string& name) {
  require_choice("--precision", name, precision_names());
  return name == "float32" ? Precision::float32 : Precision::float64;
}

Row measure(const BenchBody& body, const Settings& settings) {
  SimulationDef def = body.def;
  def.step.precision = parse_precision(settings.precision);
  def.step.kernel = settings.kernel;
  def.step.threads = settings.threads;
  Row row;
  row.structure = body.structure, row.stick = body.stick, row.lattice = body.lattice,
  row.precision = settings.precision;
  row.wanted_springs = body.wanted_springs, row.springs = def.mesh.springs.size(), row.nodes = def.mesh.node_count();
  row.steps = settings.steps, row.threads = settings.threads;

  Simulation sim(std::move(def));
  race_networks(
      body, sim.network(), sim.coefficients(),
      {sim.definition().step.precision, settings.kernel, settings.threads, {}, body.def.material.length_limit}, row);
  time_steps(body, sim, row);
  return row;
}

}  // namespace crumble::bench
