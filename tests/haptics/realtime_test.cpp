// A tick allocates nothing, locks nothing and calls no system, whatever breaks in it.
#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <mutex>

#ifdef __linux__
#include <linux/filter.h>
#include <linux/seccomp.h>

#include <cstddef>
#include <iterator>
#endif

#include "crumble/base/clock.hpp"
#include "haptics/loop_rig.hpp"
#include "support/allocation_counter.hpp"
#include "support/lock_counter.hpp"
#include "support/long_lane.hpp"

namespace crumble {
namespace {

/// A stick that stirs in a brittle cube: cuts, contacts that come and go, glitches, the clutch, the edge of the
/// workspace. The cube is made whole again every 6000 ticks.
class Stirring {
 public:
  explicit Stirring(BodyCoupling coupling)
      : rig_(
            [&](LoopDef& def) {
              def.coupling = coupling;
              def.hands[0].clutch_buttons = 1;
              def.hands[0].passivity.controller = true;
            },
            brittle()),
        publisher_(rig_.sim) {
    rig_.loop->publish_to(publisher_);
    rig_.device.info().workspace_low.setConstant(-0.03), rig_.device.info().workspace_high.setConstant(0.03);
  }
  void tick(int k) {
    const double t = 1e-3 * k;
    Vec3& p = rig_.device.sample.pose.position;
    p = {0.008 * std::sin(2.1 * t), -0.004 - 0.008 * std::cos(1.7 * t), 0.008 * std::sin(1.3 * t)};
    if (k % 5003 == 7) p.x() += 0.1;
    rig_.device.sample.buttons = k % 7001 < 20;
    rig_.loop->tick();
    if (k % 100 == 0) publisher_.latest();
    cuts_ += rig_.sim.info().new_cuts;
    touched_ += rig_.hand().contacts > 0 && rig_.device.force != Vec3::Zero();
    if (k % 6000 == 5999) rig_.sim.reset();
  }
  std::uint64_t cuts() const { return cuts_; }
  std::uint64_t touched() const { return touched_; }

 private:
  static SimulationDef brittle() {
    SimulationDef def = small_body(3);
    def.material.length_limit = 1.15;
    return def;
  }
  LoopRig rig_;
  StatePublisher publisher_;
  std::uint64_t cuts_ = 0, touched_ = 0;
};

const int kTicks = in_long_lane(1'000'000);

TEST(RealTime, ManyTicksAllocateAndLockNothing) {
  if (!AllocationCounter::available()) GTEST_SKIP() << "a sanitizer owns malloc";
  Stirring stirring(BodyCoupling::direct);
  const AllocationCounter allocations;
  const LockCounter locks;
  for (int k = 0; k < kTicks; ++k) stirring.tick(k);
  EXPECT_EQ(allocations.count(), 0u);
  EXPECT_EQ(locks.count(), 0u);
  EXPECT_GT(stirring.cuts(), 1000u);
  EXPECT_GT(stirring.touched(), kTicks / 10u);
}

TEST(RealTime, TheOtherCouplingsAllocateAndLockNothingEither) {
  if (!AllocationCounter::available()) GTEST_SKIP() << "a sanitizer owns malloc";
  for (const BodyCoupling coupling : {BodyCoupling::local_model, BodyCoupling::paper}) {
    Stirring stirring(coupling);
    const AllocationCounter allocations;
    const LockCounter locks;
    for (int k = 0; k < kTicks / 10; ++k) stirring.tick(k);
    EXPECT_EQ(allocations.count(), 0u);
    EXPECT_EQ(locks.count(), 0u);
    EXPECT_GT(stirring.cuts(), 100u);
  }
}

TEST(RealTime, LocksAreCounted) {
  if (!LockCounter::available()) GTEST_SKIP() << "a sanitizer owns the locks";
  std::mutex mutex;
  const LockCounter locks;
  mutex.lock(), mutex.unlock();
  EXPECT_EQ(locks.count(), 1u);
}

#ifdef __linux__
// The kernel ends the process at its first system call other than exit. (Its strict mode would also take away the
// processor's clock.)
bool forbid_system_calls() {
  sock_filter program[] = {
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_exit, 0, 1),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS),
  };
  const sock_fprog filter{std::size(program), program};
  return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) == 0;
}

template <class Work>
int fate_without_system_calls(Work&& work) {
  const pid_t child = fork();
  if (child == 0) {
    if (!forbid_system_calls()) syscall(SYS_exit, 3);
    work();
    syscall(SYS_exit, 0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return status;
}

TEST(RealTime, AHundredThousandTicksCallNoSystem) {
  if (!AllocationCounter::available()) GTEST_SKIP() << "a sanitizer's run time calls the system";
  const int control = fate_without_system_calls([] { static_cast<void>(getppid()); });
  if (WIFEXITED(control)) GTEST_SKIP() << "this kernel does not filter system calls";
  if (WIFSIGNALED(fate_without_system_calls([] { static_cast<void>(wall_seconds()); }))) {
    GTEST_SKIP() << "this machine's clock is a system call";
  }
  Stirring stirring(BodyCoupling::direct);
  const int status = fate_without_system_calls([&] {
    for (int k = 0; k < kTicks / 10; ++k) stirring.tick(k);
  });
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0)
      << (WIFSIGNALED(status) ? "a system call ended it, signal " : "status ") << status;
}
#endif

}  // namespace
}  // namespace crumble
