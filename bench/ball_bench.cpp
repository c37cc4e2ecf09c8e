// What fragments against fragments cost: one find(), and in it the search for neighbors.
//   ./ball_bench [seconds of simulated time, 2]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "contact/crumb_rig.hpp"
#include "crumble/base/clock.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/random.hpp"
#include "crumble/bubblemesh/presets.hpp"
#include "crumble/tetmesh/lattice_box.hpp"

namespace crumble {
namespace {

using Ids = crumble::Vector<std::uint32_t>;

// Each node goes to the nearest of `count` random nodes.
Ids shards(const TetMesh& mesh, std::size_t count) {
  Random random(7);
  crumble::Vector<Vec3> seeds;
  while (seeds.size() < count) seeds.push_back(mesh.positions[random.below(mesh.node_count())]);
  Ids nearest;
  for (const Vec3& at : mesh.positions) {
    const auto nearer = [&](const Vec3& a, const Vec3& b) { return squared_norm(a - at) < squared_norm(b - at); };
    nearest.push_back(static_cast<std::uint32_t>(std::min_element(seeds.begin(), seeds.end(), nearer) - seeds.begin()));
  }
  crumble::Vector<std::uint8_t> intact;
  for (const auto& [a, b] : mesh.springs) intact.push_back(nearest[a] == nearest[b]);
  FragmentLabeler labeler(mesh.node_count(), mesh.springs);
  labeler.label(intact);
  return {labeler.labels().begin(), labeler.labels().end()};
}

struct Times {
  crumble::Vector<double> all, with_search;
  double pairs = 0;
};

double quantile(crumble::Vector<double> values, double part) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return 1e6 * values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
}

// find() is timed by itself; what moves the crumbs is not.
void timed_step(CrumbRig& rig, Times& times) {
  VecArray at(rig.balls->nodes().size()), speeds(rig.balls->nodes().size());
  for (std::size_t i = 0; i < at.size(); ++i) {
    at.set(i, rig.positions[rig.balls->nodes()[i]]);
    speeds.set(i, rig.velocities[rig.balls->nodes()[i]]);
  }
  const std::uint64_t searches = rig.balls->searches();
  const double start = wall_seconds();
  rig.balls->find(at, speeds);
  const double seconds = wall_seconds() - start;
  (rig.balls->searches() > searches ? times.with_search : times.all).push_back(seconds);
  times.pairs += static_cast<double>(rig.balls->contact_count());
  rig.move();
}

void report(const char* name, const CrumbRig& rig, const Times& times) {
  const double steps = static_cast<double>(times.all.size() + times.with_search.size());
  std::printf("%-34s %7zu %6zu %9.0f | %7.2f %7.2f | %6.1f%% %7.2f %7.2f\n", name, rig.balls->nodes().size(),
              rig.crumbs.size(), times.pairs / steps, quantile(times.all, 0.5), quantile(times.all, 0.99),
              100 * static_cast<double>(times.with_search.size()) / steps, quantile(times.with_search, 0.5),
              quantile(times.with_search, 0.99));
}

Times run(CrumbRig& rig, std::size_t steps) {
  Times times;
  for (std::size_t i = 0; i < steps; ++i) timed_step(rig, times);
  return times;
}

void heap_of_the_cube(std::size_t steps) {
  const TetMesh mesh = generate_paper_body(PaperBody::cube).mesh;
  CrumbRig rig({.positions = mesh.positions,
                .labels = shards(mesh, 200),
                .node_mass = 0.03 / static_cast<double>(mesh.node_count()),
                .springs = mesh.springs});
  for (Crumb& c : rig.crumbs) c.center.y() += 0.02;
  rig.move();
  report("cube in 200, falling, then apart", rig, run(rig, 500));
  run(rig, steps);
  std::printf("  kinetic energy now %.1e J\n", rig.kinetic_energy());
  report("its heap at rest", rig, run(rig, 1000));
  Random random(3);
  Times stirred;
  for (int i = 0; i < 1000; ++i) {
    if (i % 50 == 0) {
      for (Crumb& c : rig.crumbs)
        c.velocity += Vec3(random.uniform(-1, 1), random.uniform(0, 1), random.uniform(-1, 1)) * 0.3;
    }
    timed_step(rig, stirred);
  }
  report("the heap stirred, 0.3 m/s", rig, stirred);
}

// The body does not move: what is measured is what 50 crumbs cost a large one.
void crumbs_of_a_large_body(double cells) {
  const double spacing = 0.003;
  const TetMesh mesh = make_lattice_box(Vec3(cells, cells, cells) * spacing, spacing);
  Ids labels(mesh.node_count(), 0);
  Random random(5);
  const double top = cells * spacing;
  crumble::Vector<std::uint32_t> surface;
  for (std::uint32_t i = 0; i < mesh.node_count(); ++i) {
    if (mesh.positions[i].y() > top - 1e-6) surface.push_back(i);
  }
  for (std::uint32_t crumb = 1; crumb <= 50; ++crumb) labels[surface[random.below(surface.size())]] = crumb;
  crumble::Vector<std::uint8_t> intact, on_surface(mesh.node_count()), fixed(mesh.node_count());
  for (const auto& [a, b] : mesh.springs) intact.push_back(labels[a] == labels[b]);
  for (std::uint32_t i = 0; i < mesh.node_count(); ++i) on_surface[i] = mesh.kinds[i] != NodeKind::inside;
  const crumble::Vector<double> radii(mesh.node_count(), 0.0015), masses(mesh.node_count(), 5e-5),
      stiffnesses(mesh.node_count(), 30.0), sums(mesh.node_count(), 390.0);
  BallContacts balls({mesh.springs, radii, masses, stiffnesses, sums, on_surface, fixed, {0.5, 0.5}, 1e-3});
  Ids cuts;
  for (std::uint32_t s = 0; s < intact.size(); ++s) {
    if (!intact[s]) cuts.push_back(s);
  }
  crumble::Vector<BallFragment> fragments(51, {5e-5, false});
  fragments[0].mass = 1;
  const double start = wall_seconds();
  balls.update(cuts, labels, fragments);
  const double update = wall_seconds() - start;
  VecArray at(balls.nodes().size()), speeds(balls.nodes().size());
  for (std::size_t i = 0; i < at.size(); ++i) at.set(i, mesh.positions[balls.nodes()[i]]);
  crumble::Vector<double> plain, searching;
  double pairs = 0;
  for (int step = 0; step < 2000; ++step) {
    for (std::size_t i = 0; i < at.size(); ++i) {
      if (labels[balls.nodes()[i]] > 0) at.y[i] += step / 200 % 2 ? 1e-5 : -1e-5;
    }
    const std::uint64_t searches = balls.searches();
    const double begin = wall_seconds();
    balls.find(at, speeds);
    (balls.searches() > searches ? searching : plain).push_back(wall_seconds() - begin);
    pairs += static_cast<double>(balls.contact_count()) / 2000;
  }
  std::printf("%-34s %7zu %6d %9.0f | %7.2f %7.2f | %6.1f%% %7.2f %7.2f  update %.1f us\n",
              (std::to_string(mesh.node_count()) + " nodes, 50 crumbs").c_str(), at.size(), 51, pairs,
              quantile(plain, 0.5), quantile(plain, 0.99), static_cast<double>(searching.size()) / 20,
              quantile(searching, 0.5), quantile(searching, 0.99), update * 1e6);
}

}  // namespace
}  // namespace crumble

int main(int argc, char** argv) {
  std::printf("%-34s %7s %6s %9s | %7s %7s | %7s %7s %7s\n", "us per find()", "balls", "frags", "touching", "p50",
              "p99", "search", "p50", "p99");
  crumble::heap_of_the_cube(static_cast<std::size_t>(1000 * (argc > 1 ? std::atof(argv[1]) : 2)));
  crumble::crumbs_of_a_large_body(46);
}
