// What the border costs: a step by crumble_sim_step and the same by the C++ library, in turns, on the smallest body
// there is. Thread CPU time; the difference is the price of a call, by the least disturbed round of each and by the
// median of all. Beside it what an addition takes, since shared machines are now fast, now slow. CI does not judge it.
//   ./capi_bench [rounds]
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "crumble/crumble.h"
#include "crumble/sim/simulation.hpp"

namespace {

constexpr int kSteps = 200;  // of one round

double cpu_nanoseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

void check(crumble_result result) {
  if (result == CRUMBLE_OK) return;
  std::fprintf(stderr, "%s\n", crumble_last_error());
  std::exit(1);
}

const double kPositions[] = {0, 0, 0, 0.01, 0, 0, 0, 0.01, 0, 0, 0, 0.01};
const std::uint32_t kTetrahedron[] = {0, 1, 2, 3};

crumble_sim make_c() {
  crumble_mesh mesh = nullptr;
  crumble_sim sim = nullptr;
  crumble_tool_def stick{};
  check(crumble_mesh_create_from_tets(kPositions, 4, kTetrahedron, 1, &mesh));
  check(crumble_sim_create(mesh, nullptr, &sim));
  check(crumble_mesh_destroy(mesh));
  check(crumble_tool_def_init(&stick, sizeof stick));
  check(crumble_sim_add_tool(sim, &stick, nullptr));
  return sim;
}

crumble::Simulation make_cpp() {
  crumble::SimulationDef def;
  crumble::Vector<crumble::Vec3> positions;
  for (int i = 0; i < 4; ++i) positions.push_back({kPositions[3 * i], kPositions[3 * i + 1], kPositions[3 * i + 2]});
  def.mesh = crumble::make_tet_mesh(positions, {{0, 1, 2, 3}});
  def.tools.push_back({crumble::make_round_stick(0.004, 0.05, 16), {}, {}});
  return crumble::Simulation(std::move(def));
}

template <class Step>
double time_round(Step&& step) {
  const double begin = cpu_nanoseconds();
  for (int i = 0; i < kSteps; ++i) step();
  return (cpu_nanoseconds() - begin) / kSteps;
}

double time_addition() {
  constexpr int kCount = 1'000'000;
  const double begin = cpu_nanoseconds();
  std::uint64_t sum = 1;
  for (int i = 0; i < kCount; ++i) {
    __asm__ volatile("" : "+r"(sum));
    sum += 3;
  }
  return (cpu_nanoseconds() - begin) / kCount;
}

double least(const std::vector<double>& values) {
  return *std::min_element(values.begin(), values.end());
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

}  // namespace

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 2000;
  const crumble_sim c = make_c();
  crumble::Simulation cpp = make_cpp();
  const crumble_pose away{{0, 1, 0}, {1, 0, 0, 0}};
  const crumble::Pose also_away{{0, 1, 0}, crumble::Quat::Identity()};
  crumble_wrench wrench{};
  double sum = 0;
  std::vector<double> c_times, cpp_times, differences;
  for (int round = 0; round < rounds; ++round) {
    const double cpp_time = time_round([&] {
      cpp.step({&also_away, 1});
      sum += cpp.wrench(0).force.y();
    });
    const double c_time = time_round([&] {
      check(crumble_sim_step(c, &away, &wrench));
      sum += wrench.force[1];
    });
    c_times.push_back(c_time), cpp_times.push_back(cpp_time), differences.push_back(c_time - cpp_time);
  }
  const double refused = time_round([&] { crumble_sim_step(nullptr, &away, &wrench); });
  std::printf(
      "ns                    least   median of %d rounds\nstep through C++   %8.1f %8.1f\nstep through C     %8.1f "
      "%8.1f\n"
      "the call           %8.1f %8.1f\na refused call     %8.1f\nan addition        %8.2f\n",
      rounds, least(cpp_times), median(cpp_times), least(c_times), median(c_times), least(c_times) - least(cpp_times),
      median(differences), refused, time_addition());
  check(crumble_sim_destroy(c));
  return sum == 0 ? 0 : 1;
}
