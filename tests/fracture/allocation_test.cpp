// What runs in a step or in every frame takes no memory from the heap.
#include <gtest/gtest.h>

#include <utility>

#include "crumble/fracture/cut.hpp"
#include "states.hpp"
#include "support/allocation_counter.hpp"

namespace crumble {
namespace {

using namespace fracture_test;

TEST(Allocation, NoneAfterConstruction) {
  if (!AllocationCounter::available()) GTEST_SKIP() << "allocations are not counted in this build";
  Random random(41);
  const TetMesh mesh = make_lattice_box({0.03, 0.03, 0.02}, 0.005);
  const VecArray positions(mesh.positions);
  const std::size_t spring_count = mesh.springs.size();
  const std::vector<std::uint32_t> overlong{1, 4, 5, 200};
  std::vector<std::uint32_t> newly_cut(spring_count);
  std::vector<double> masses(mesh.node_count(), 1e-5);
  std::vector<Fragment> fragments(mesh.node_count());
  FragmentLabeler labeler(mesh.node_count(), mesh.springs);
  SurfaceExtractor surface(mesh);
  Flags first(spring_count, 1);
  const Flags none(spring_count, 0), some = random_flags(spring_count, 0.5, random);

  std::size_t allocations = 0, cuts = 0;
  {
    AllocationCounter counter;
    cuts = cut_springs(overlong, first, newly_cut);
    for (const Flags* intact : {&std::as_const(first), &some, &none}) {
      const std::size_t count = labeler.label(*intact);
      measure_fragments(mesh, labeler.labels(), masses, positions, std::span(fragments).first(count));
      surface.extract(*intact, labeler.labels());
      surface.update(positions);
    }
    allocations = counter.count();
  }
  EXPECT_EQ(allocations, 0u);
  EXPECT_EQ(cuts, overlong.size());
}

}  // namespace
}  // namespace crumble
