#include "crumble/fracture/cut.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "crumble/base/error.hpp"
#include "states.hpp"

namespace crumble {
namespace {

using namespace fracture_test;

// A chain along x with the given spring lengths; rest length 1 each.
struct Chain {
  explicit Chain(const std::vector<double>& lengths, double length_limit)
      : positions(lengths.size() + 1), intact(lengths.size(), 1), newly_cut(lengths.size()) {
    for (std::uint32_t s = 0; s < lengths.size(); ++s) {
      positions.x[s + 1] = positions.x[s] + lengths[s];
      springs.push_back({s, s + 1});
    }
    limits = squared_length_limits(std::vector<double>(lengths.size(), 1.0), length_limit);
  }
  std::vector<std::uint32_t> cut() {
    const std::size_t count = cut_springs(positions, springs, limits, intact, newly_cut);
    return {newly_cut.begin(), newly_cut.begin() + static_cast<std::ptrdiff_t>(count)};
  }
  VecArray positions;
  std::vector<Edge> springs;
  std::vector<double> limits;
  Flags intact;
  std::vector<std::uint32_t> newly_cut;
};

using Ids = std::vector<std::uint32_t>;

TEST(Cut, LongerThanTheLimitOnly) {
  // Powers of two: every length and limit is exact, so "exactly at the limit" means that.
  Chain chain({1.0, 1.25, 1.5, 1.75, 0.25, 4.0}, 1.5);
  EXPECT_EQ(chain.cut(), (Ids{3, 5}));
  EXPECT_EQ(chain.intact, (Flags{1, 1, 1, 0, 1, 0}));
}

TEST(Cut, EachSpringOnce) {
  Chain chain({2.0, 1.0, 2.0}, 1.5);
  EXPECT_EQ(chain.cut(), (Ids{0, 2}));
  EXPECT_TRUE(chain.cut().empty());
  chain.positions.x[1] = 0.25;  // cut spring 0 shortens: it stays cut; spring 1 is 2.75 now
  EXPECT_EQ(chain.cut(), Ids{1});
  EXPECT_EQ(chain.intact, (Flags{0, 0, 0}));
}

TEST(Cut, AllAtOnceFillsTheBuffer) {
  Chain chain(std::vector<double>(100, 3.0), 1.5);
  Ids all(100);
  std::iota(all.begin(), all.end(), 0u);
  EXPECT_EQ(chain.cut(), all);
}

TEST(Cut, RestHoldsAtTheLeastLimit) {
  const TetMesh mesh = make_lattice_box({0.03, 0.03, 0.03}, 0.007);
  const VecArray positions(mesh.positions);
  std::vector<double> rest;
  for (const auto& [a, b] : mesh.springs) rest.push_back(norm(mesh.positions[b] - mesh.positions[a]));
  const auto limits = squared_length_limits(rest, 1.0 + 1e-15);
  Flags intact(mesh.springs.size(), 1);
  Ids newly_cut(mesh.springs.size());
  EXPECT_EQ(cut_springs(positions, mesh.springs, limits, intact, newly_cut), 0u);
}

TEST(Cut, NanLengthIsLeftAlone) {
  Chain chain({2.0, 2.0}, 1.5);
  chain.positions.y[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(chain.cut(), Ids{1});
}

TEST(Cut, RefusesALimitThatBreaksABodyAtRest) {
  const std::vector<double> rest{1.0};
  for (const double bad : {0.99, -1.0, 1e7, std::numeric_limits<double>::quiet_NaN()}) {
    try {
      squared_length_limits(rest, bad);
      FAIL() << bad;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("length_limit"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace crumble
