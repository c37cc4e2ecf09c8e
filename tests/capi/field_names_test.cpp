#include "field_names.hpp"

#include <gtest/gtest.h>

namespace crumble::capi {
namespace {

TEST(FieldNames, AreThoseOfC) {
  const std::pair<const char*, const char*> kRows[] = {
      {"hands[0].safety.max_force must be positive, is -1", "hands[0].max_force must be positive, is -1"},
      {"hands[1].coupling.stiffness is 9", "hands[1].coupling_stiffness is 9"},
      {"hands[0].holder is 3", "hands[0].tool is 3"},
      {"press.speed must be positive", "press_speed must be positive"},
      {"material.stiffness is nan", "stiffness is nan"},
      {"step.tau must not exceed 0.01", "tau must not exceed 0.01"},
      {"poke.depth / poke.in is too fast", "poke_depth / poke_in is too fast"},
      {"poke.direction is 0", "press_direction is 0"},
      {"hand.points[3].time", "points[3].time"},
      {"friction.static 1 is below friction.dynamic 2", "static_friction 1 is below dynamic_friction 2"},
      {"cannot read 'press.ctraj'", "cannot read 'press.ctraj'"},
      {"cannot read /tmp/hand.json", "cannot read /tmp/hand.json"},
      {"after that step. Reset it", "after that step. Reset it"},
      {"lockstep.tau", "lockstep.tau"},
  };
  for (const auto& [cpp, c] : kRows) EXPECT_EQ(in_names_of_c(cpp), c);
}

}  // namespace
}  // namespace crumble::capi
