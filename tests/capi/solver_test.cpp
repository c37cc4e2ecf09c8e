// Who computes a step: precision, kernel, threads, through C.
#include <atomic>
#include <cmath>
#include <thread>

#include "capi/rig.hpp"
#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

Vector<std::string> kernels() {
  Vector<std::string> names;
  for (std::uint32_t i = 0; const char* const name = crumble_kernel_name(i); ++i) names.emplace_back(name);
  return names;
}

// A host's threads: one for each half of the tasks.
struct Host {
  std::atomic<std::uint64_t> calls = 0, tasks = 0;
  std::atomic<std::uint32_t> least = 0xffffffffu, most = 0;  // counts it was called with
  crumble_sim own_sim = nullptr;
  std::atomic<crumble_result> answer_to_itself = CRUMBLE_OK;

  static void run(void* context, std::uint32_t count, void (*task)(void* data, std::uint32_t index), void* data) {
    Host& host = *static_cast<Host*>(context);
    ++host.calls;
    host.tasks += count;
    host.least = std::min(host.least.load(), count), host.most = std::max(host.most.load(), count);
    std::uint64_t unused = 0;
    if (host.own_sim) host.answer_to_itself = crumble_sim_state_hash(host.own_sim, &unused);
    std::thread other([&] {
      for (std::uint32_t i = count; i-- > count / 2;) task(data, i);
    });
    for (std::uint32_t i = 0; i < count / 2; ++i) task(data, i);
    other.join();
  }
};

class Solver : public CapiTest {
 protected:
  crumble_sim_info solver_info() {
    crumble_sim_info value{};
    value.struct_size = sizeof value;
    EXPECT_RESULT(CRUMBLE_OK, crumble_sim_get_info(sim, &value));
    return value;
  }
  // The hash after a press of `steps` by a simulation of `def`, which stays as `sim`.
  std::uint64_t press_with(int steps) {
    EXPECT_RESULT(CRUMBLE_OK, crumble_sim_destroy(sim));
    sim = make_sim();
    press(1, steps);
    return hash();
  }
};

// Large enough that threads have something to share.
class LargeSolver : public Solver {
 protected:
  LargeSolver() : large(21) {}
  void SetUp() override {
    Solver::SetUp();
    ASSERT_OK(crumble_mesh_destroy(mesh));
    ASSERT_OK(large.create(&mesh));
    ASSERT_GE(large.mesh.springs.size(), 50'000u);
    def.stiffness = 5;
  }
  const Cube large;
};

TEST_F(Solver, KernelsHaveNamesAndFindThemselves) {
  const Vector<std::string> names = kernels();
  ASSERT_FALSE(names.empty());
  EXPECT_EQ(names, kernel_names());
  EXPECT_EQ(names[0], "scalar");
  EXPECT_EQ(crumble_kernel_name(0xffffffffu), nullptr);
  for (const std::string& name : names) {
    EXPECT_NE(std::string(crumble_build_info()).find(" " + name), std::string::npos) << crumble_build_info();
  }
  for (std::uint32_t i = 0; i < names.size(); ++i) {
    def.kernel = crumble_kernel_name(i);
    press_with(1);
    EXPECT_EQ(solver_info().kernel, i);
  }
}

TEST_F(Solver, EveryKernelGivesTheSameBits) {
  for (const std::uint32_t precision : {CRUMBLE_PRECISION_FLOAT64, CRUMBLE_PRECISION_FLOAT32}) {
    def.precision = precision;
    def.kernel = nullptr;
    const std::uint64_t chosen = press_with(300);
    EXPECT_GT(counters().cuts, 20u);
    for (const std::string& name : kernels()) {
      def.kernel = name.c_str();
      EXPECT_EQ(press_with(300), chosen) << name << " in precision " << precision;
    }
  }
}

TEST_F(Solver, TheDefinitionKeepsWhatItWasGivenAndNotThePointer) {
  std::string name = "scalar";
  Host host;
  def.kernel = name.c_str();
  def.threads = 3;
  def.precision = CRUMBLE_PRECISION_FLOAT32;
  def.host_threads = Host::run;
  def.host_context = &host;
  press_with(1);
  name = "garbage";
  ASSERT_OK(crumble_sim_reset(sim));
  crumble_sim_def now{};
  now.struct_size = sizeof now;
  ASSERT_OK(crumble_sim_get_def(sim, &now));
  EXPECT_STREQ(now.kernel, "scalar");
  EXPECT_EQ(now.kernel, crumble_kernel_name(0)) << "static text";
  EXPECT_EQ(now.threads, 3u);
  EXPECT_EQ(now.precision, std::uint32_t{CRUMBLE_PRECISION_FLOAT32});
  EXPECT_EQ(now.host_threads, &Host::run);
  EXPECT_EQ(now.host_context, &host);
  ASSERT_OK(crumble_sim_configure(sim, &now));
  now.kernel = nullptr;
  ASSERT_OK(crumble_sim_configure(sim, &now));
  ASSERT_OK(crumble_sim_get_def(sim, &now));
  EXPECT_EQ(now.kernel, nullptr) << "the library's choice";
}

TEST_F(Solver, SinglePrecisionDiffersByLittle) {
  def.length_limit = 2;  // nothing is cut: a crack would grow from the last bit
  const auto press_force = [&](std::uint32_t precision) {
    def.precision = precision;
    const std::uint64_t bits = press_with(400);
    return std::pair(wrench.force[1], bits);
  };
  const auto [exact, exact_bits] = press_force(CRUMBLE_PRECISION_FLOAT64);
  const auto [single, single_bits] = press_force(CRUMBLE_PRECISION_FLOAT32);
  ASSERT_EQ(counters().cuts, 0u);
  EXPECT_GT(exact, 0.1);
  EXPECT_NEAR(single, exact, 1e-3 * exact);
  EXPECT_NE(single, exact);
  EXPECT_NE(single_bits, exact_bits);
}

TEST_F(Solver, SnapshotsAndRecordingsFitEveryKernelAndNumberOfThreadsButOnePrecision) {
  def.kernel = "scalar";
  press_with(250);
  std::uint64_t size = 0;
  ASSERT_OK(crumble_sim_snapshot(sim, nullptr, 0, &size));
  Vector<std::uint8_t> saved(size);
  ASSERT_OK(crumble_sim_snapshot(sim, saved.data(), size, nullptr));
  press(251, 300);
  const std::uint64_t live = hash();
  def.kernel = nullptr;
  def.threads = 2;
  press_with(1);
  ASSERT_OK(crumble_sim_restore(sim, saved.data(), size));
  press(251, 300);
  EXPECT_EQ(hash(), live);

  def.precision = CRUMBLE_PRECISION_FLOAT32;
  press_with(1);
  expect_failure(CRUMBLE_E_VERSION, crumble_sim_restore(sim, saved.data(), size), {"definition"});
  saved[7] = '1';  // of "CRMSNP02": as the library wrote them before there were precisions
  expect_failure(CRUMBLE_E_VERSION, crumble_sim_restore(sim, saved.data(), size), {"another version"});
}

TEST_F(Solver, TellsHowTheBodyIsLaidOut) {
  const auto springs = static_cast<std::uint32_t>(cube.mesh.springs.size());
  const crumble_sim_info now = solver_info();
  EXPECT_GT(now.springs_in_segments, springs / 2) << "a lattice";
  EXPECT_LE(now.springs_in_segments, springs);
  EXPECT_GE(now.lanes, springs);
  EXPECT_LE(now.lanes, 4 * springs);
  EXPECT_GT(now.segments, 0u);
  EXPECT_GE(8 * now.batches, springs - now.springs_in_segments);
  EXPECT_EQ(now.partitions, 1u) << "small";
  EXPECT_EQ(now.struct_size, sizeof now);
}

TEST_F(LargeSolver, ThreadsAndHostsGiveTheSameBits) {
  const std::uint64_t alone = press_with(40);
  const crumble_sim_info laid_out = solver_info();
  ASSERT_GE(laid_out.partitions, 2u);
  def.threads = 2;
  EXPECT_EQ(press_with(40), alone);

  Host host;
  def.threads = 1;
  def.host_threads = Host::run;
  def.host_context = &host;
  EXPECT_EQ(press_with(40), alone);
  EXPECT_GE(host.calls, 40u);
  EXPECT_EQ(host.least, laid_out.partitions);
  EXPECT_EQ(host.most, laid_out.partitions);
  EXPECT_EQ(host.tasks, host.calls * laid_out.partitions);

  host.own_sim = sim;
  press(41, 41);
  EXPECT_RESULT(CRUMBLE_E_BUSY, host.answer_to_itself);
}

}  // namespace
}  // namespace crumble
