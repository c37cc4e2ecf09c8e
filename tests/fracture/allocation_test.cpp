// What runs in a step or in every frame takes no memory from the heap.
#include <gtest/gtest.h>

#include <array>
#include <utility>

#include "crumble/base/memory.hpp"
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
  const Vector<std::uint32_t> overlong{1, 4, 5, 200};
  Vector<std::uint32_t> newly_cut(spring_count);
  Vector<double> masses(mesh.node_count(), 1e-5);
  Vector<Fragment> fragments(mesh.node_count());
  FragmentLabeler labeler(mesh.node_count(), mesh.springs);
  std::array<SurfaceExtractor, 3> surfaces{SurfaceExtractor(mesh), SurfaceExtractor(mesh, {SurfaceMode::fragments}),
                                           SurfaceExtractor(mesh, {SurfaceMode::paper})};
  const Flags whole(spring_count, 1);
  Flags first(spring_count, 1);
  Flags some = random_flags(spring_count, 0.5, random);
  for (const std::uint32_t s : overlong) some[s] = 0;
  const Flags none(spring_count, 0);

  std::size_t allocations = 0, cuts = 0;
  {
    AllocationCounter counter;
    cuts = cut_springs(overlong, first, newly_cut);
    double time = 0;
    for (const Flags* intact : {&whole, &std::as_const(first), &std::as_const(some), &none, &whole}) {
      const std::size_t count = labeler.label(*intact);
      measure_fragments(mesh, labeler.labels(), masses, positions, std::span(fragments).first(count));
      time += 0.01;
      for (SurfaceExtractor& surface : surfaces) surface.update({positions, *intact, labeler.labels(), time});
    }
    allocations = counter.count();
  }
  EXPECT_EQ(allocations, 0u);
  EXPECT_EQ(cuts, overlong.size());
}

}  // namespace
}  // namespace crumble
