#include "bubblemesh/flips.hpp"

#include <gtest/gtest.h>

#include <set>

#include "bubblemesh/measures.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/random.hpp"
#include "crumble/base/transcendental.hpp"
#include "crumble/tetmesh/quality.hpp"

namespace crumble {
namespace {

std::set<std::set<std::uint32_t>> as_sets(const Vector<Tetrahedron>& tetrahedra) {
  std::set<std::set<std::uint32_t>> result;
  for (const Tetrahedron& t : tetrahedra) result.insert({t.begin(), t.end()});
  return result;
}

/// Nodes 0 and 1 at the ends of an edge of half length `half`, `count` more on a circle of radius 1 around it.
Cloud spindle(double half, std::uint32_t count, NodeKind kind) {
  Cloud cloud;
  cloud.add({0, 0, -half}, kind);
  cloud.add({0, 0, half}, kind);
  for (std::uint32_t k = 0; k < count; ++k) {
    const double angle = 2 * kPi * k / count;
    cloud.add({cos_exact(angle), sin_exact(angle), 0}, kind);
  }
  return cloud;
}
Vector<Tetrahedron> around_edge(std::uint32_t count) {
  Vector<Tetrahedron> result;
  for (std::uint32_t k = 0; k < count; ++k) result.push_back({0, 1, 2 + k, 2 + (k + 1) % count});
  return result;
}

TEST(Measures, AreOneForTheRegularTetrahedron) {
  const Vec3 a(1, 1, 1), b(-1, 1, -1), c(1, -1, -1), d(-1, -1, 1);
  ASSERT_GT(orient(a, b, c, d), 0);
  EXPECT_NEAR(volume_length(a, b, c, d), 1, 1e-15);
  EXPECT_NEAR(volume_length(a, c, b, d), -1, 1e-15);
  EXPECT_NEAR(least_sine(a, b, c, d), std::sqrt(8.0) / 3, 1e-15);
  EXPECT_EQ(least_sine({0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}), 0);
}

TEST(Measures, LeastSineIsThatOfTheAngles) {
  Random random(11);
  const auto point = [&]() -> Vec3 { return {random.uniform(), random.uniform(), random.uniform()}; };
  for (int i = 0; i < 1000; ++i) {
    const Vec3 a = point(), b = point(), c = point(), d = point();
    double least = 1;
    for (const double angle : dihedral_angles(a, b, c, d)) least = std::min(least, std::sin(angle * kPi / 180));
    if (orient(a, b, c, d) > 0) {
      EXPECT_NEAR(least_sine(a, b, c, d), least, 1e-9);
    } else {
      EXPECT_LT(least_sine(a, b, c, d), 0);
    }
  }
}

TEST(TetComplex, RingGoesOnceAroundTheEdge) {
  const TetComplex closed(8, around_edge(6));
  const Ring ring = closed.ring(0, 1);
  EXPECT_TRUE(ring.closed);
  ASSERT_EQ(ring.size, 6u);
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_EQ((ring.vertices[(k + 1) % 6] - 2), (ring.vertices[k] - 2 + 1) % 6);
  }
  Vector<Tetrahedron> part = around_edge(6);
  part.erase(part.begin() + 2);
  const Ring open = TetComplex(8, part).ring(0, 1);
  EXPECT_FALSE(open.closed);
  ASSERT_EQ(open.size, 6u);
  EXPECT_EQ(open.vertices[0], 5u);
  EXPECT_EQ(open.vertices[5], 4u);
  EXPECT_EQ(TetComplex(12, around_edge(10)).ring(0, 1).size, 0u);
}

TEST(TetComplex, UndoRestoresAll) {
  TetComplex tets(8, around_edge(6));
  const auto before = tets.tetrahedra();
  tets.begin_trial();
  tets.replace(std::array<TetId, 2>{1, 4}, std::array<Tetrahedron, 3>{{{0, 2, 4, 6}, {1, 2, 4, 6}, {2, 3, 4, 5}}});
  tets.replace(std::array<TetId, 1>{0}, {});
  EXPECT_EQ(tets.new_in_trial().size(), 3u);
  tets.undo_trial();
  EXPECT_EQ(tets.tetrahedra(), before);
  EXPECT_EQ(tets.ring(0, 1).size, 6u);
}

TEST(Flips, LongEdgeMakesRoomForAFaceAndBack) {
  const Cloud tall = spindle(1.5, 3, NodeKind::inside), flat = spindle(0.2, 3, NodeKind::inside);
  TetComplex tets(5, around_edge(3));
  EXPECT_FALSE(remove_edge(flat, least_sine, 0, 1, tets));
  EXPECT_TRUE(remove_edge(tall, least_sine, 0, 1, tets));
  EXPECT_EQ(as_sets(tets.tetrahedra()), (std::set<std::set<std::uint32_t>>{{0, 2, 3, 4}, {1, 2, 3, 4}}));
  const TetId first = tets.star(0)[0];
  const Tetrahedron t = tets[first];
  const int face = static_cast<int>(std::ranges::find(t, 0u) - t.begin());
  EXPECT_FALSE(flip_face(tall, least_sine, first, face, tets));
  EXPECT_TRUE(flip_face(flat, least_sine, first, face, tets));
  EXPECT_EQ(as_sets(tets.tetrahedra()), as_sets(around_edge(3)));
}

TEST(Flips, NothingIsMadeThatExistsAlready) {
  const Cloud tall = spindle(1.5, 4, NodeKind::inside);
  Vector<Tetrahedron> tetrahedra = around_edge(4);
  const double any = -std::numeric_limits<double>::infinity();
  TetComplex alone(6, tetrahedra);
  ASSERT_TRUE(remove_edge(tall, least_sine, 0, 1, alone, any));
  Cloud more = tall;
  more.add({0, 0, 9}, NodeKind::inside);
  more.add({0, 1, 9}, NodeKind::inside);
  tetrahedra.push_back({2, 4, 6, 7});  // both diagonals of the ring
  tetrahedra.push_back({3, 5, 6, 7});
  TetComplex tets(8, tetrahedra);
  EXPECT_FALSE(remove_edge(more, least_sine, 0, 1, tets, any));
}

TEST(Flips, CreaseStaysAndFlatTetrahedronIsTakenOff) {
  // half a spindle: the edge 0-1 is on the boundary between two faces at 90 degrees
  Cloud corner;
  for (const Vec3& p : {Vec3(0, 0, -3), Vec3(0, 0, 3), Vec3(1, 0, 0), Vec3(0.7, 0.7, 0), Vec3(0, 1, 0)})
    corner.add(p, NodeKind::crease);
  TetComplex tets(5, {{0, 1, 2, 3}, {0, 1, 3, 4}});
  const double any = -std::numeric_limits<double>::infinity();
  EXPECT_FALSE(remove_edge(corner, least_sine, 0, 1, tets, any));
  // a flat tetrahedron 0 1 2 3 on top of two that fill the space under it
  Cloud top;
  for (const Vec3& p : {Vec3(-1, 0, 0), Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0, 1, 0), Vec3(0, 0, -1)})
    top.add(p, NodeKind::surface);
  TetComplex flat(5, {{0, 1, 2, 3}, {3, 2, 0, 4}, {2, 3, 1, 4}});
  ASSERT_EQ(flat.ring(0, 1).tet_count(), 1u);
  ASSERT_TRUE(flat.ring(2, 3).closed);
  EXPECT_TRUE(remove_edge(top, least_sine, 0, 1, flat));
  EXPECT_EQ(as_sets(flat.tetrahedra()), (std::set<std::set<std::uint32_t>>{{0, 2, 3, 4}, {1, 2, 3, 4}}));
}

}  // namespace
}  // namespace crumble
