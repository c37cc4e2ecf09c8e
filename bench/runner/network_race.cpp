#include "runner/network_race.hpp"

#include <algorithm>
#include <functional>

#include "baselines/bullet_network.hpp"
#include "baselines/plain_network.hpp"
#include "crumble/base/clock.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/random.hpp"

namespace crumble::bench {
namespace {

constexpr int kRounds = 21;
constexpr double kLapSeconds = 2e-3;  // a lap is at least one step

struct Contestant {
  std::function<void()> restart, step;
  std::size_t laps = 1;          // steps per round
  Vector<double> cpu{}, wall{};  // of a step, microseconds, one per round
};

// The first step warms the caches up and is not counted.
void run_round(Contestant& c) {
  c.restart();
  c.step();
  const double cpu = thread_cpu_seconds(), wall = wall_seconds();
  for (std::size_t i = 0; i < c.laps; ++i) c.step();
  const double share = 1e6 / static_cast<double>(c.laps);
  c.wall.push_back((wall_seconds() - wall) * share);
  c.cpu.push_back((thread_cpu_seconds() - cpu) * share);
}

void run_rounds(const Vector<Contestant*>& contestants) {
  for (Contestant* c : contestants) {
    run_round(*c);
    c->laps = static_cast<std::size_t>(std::clamp(kLapSeconds * 1e6 / c->wall[0], 1.0, 1000.0));
    c->cpu.clear(), c->wall.clear();
  }
  for (int round = 0; round < kRounds; ++round) {
    for (Contestant* c : contestants) run_round(*c);
  }
}

double median_ratio(const Vector<double>& a, const Vector<double>& b) {
  Vector<double> ratios;
  for (std::size_t i = 0; i < a.size(); ++i) ratios.push_back(a[i] / b[i]);
  return median(std::move(ratios));
}

// A body that is moving: every free node a little off its place, by up to 1 % of the spacing on each axis.
Vector<Vec3> disturbed(const TetMesh& mesh, const SpringNetwork& network) {
  Random random(2);
  Vector<Vec3> positions = mesh.positions;
  const double most = 0.01 * network.rest_lengths[0];
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (network.fixed[i]) continue;
    for (int axis = 0; axis < 3; ++axis) positions[i][axis] += random.uniform(-most, most);
  }
  return positions;
}

double greatest_difference(const NetworkSolver& solver, std::span<const Vec3> expected,
                           std::span<const std::uint32_t> places) {
  double greatest = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    greatest = std::max(greatest, norm(solver.position(places[i]) - expected[i]));
  }
  return greatest;
}

}  // namespace

void race_networks(const BenchBody& body, const SpringNetwork& network, const StepCoefficients& coefficients,
                   const SolverSettings& settings, Row& row) {
  const SimulationDef& def = body.def;
  const bool shuffled = body.structure == "shuffled";
  const SpringNetwork ordered =
      make_network(body.ordered, def.material, def.mass_rule, nodes_below(body.ordered, 1e-6));
  const Vector<Vec3> start = disturbed(body.ordered, ordered);
  Vector<Vec3> start_as_it_comes(start.size());
  for (std::size_t i = 0; i < start.size(); ++i) start_as_it_comes[body.places[i]] = start[i];

  const auto solver = NetworkSolver::make(network, coefficients, def.mesh.positions, settings);
  for (std::uint32_t i = 0; i < start.size(); ++i) solver->place(i, start_as_it_comes[i], Vec3::Zero());
  ByteWriter saved;
  solver->save(saved);
  const auto restore = [&] {
    ByteReader bytes(saved.bytes(), "benchmark's state");
    solver->load(bytes);
  };
  Contestant ours{restore, [&] { solver->solve({}); }};

  PlainNetwork plain(ordered, make_coefficients(ordered, def.step.tau, def.step.policy));
  Contestant theirs{[&] { plain.place(start); }, [&] { plain.step(); }};
  Vector<Contestant*> contestants{&ours, &theirs};

  PlainNetwork plain_as_it_comes(network, coefficients);
  Contestant unsorted{[&] { plain_as_it_comes.place(start_as_it_comes); }, [&] { plain_as_it_comes.step(); }};
  if (shuffled) contestants.push_back(&unsorted);

  const auto bullet = make_bullet_network(ordered, body.ordered.positions, def.step.tau);
  Contestant soft_body{[&] { bullet->place(start); }, [&] { bullet->step(); }};
  if (bullet) contestants.push_back(&soft_body);

  run_rounds(contestants);
  row.network = median(ours.cpu), row.network_wall = median(ours.wall);
  row.plain = median(theirs.cpu), row.ratio = median_ratio(theirs.cpu, ours.cpu);
  if (shuffled) row.plain_as_it_comes = median(unsorted.cpu);
  if (bullet) row.bullet = median(soft_body.cpu), row.bullet_ratio = median_ratio(soft_body.cpu, ours.cpu);
  row.layout = solver->layout();
  row.kernel = solver->kernel();

  restore(), plain.place(start);
  for (int step = 0; step < 100; ++step) solver->solve({}), plain.step();
  row.difference_from_plain = greatest_difference(*solver, plain.positions(), body.places);
}

}  // namespace crumble::bench
