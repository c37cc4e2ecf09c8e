#include "crumble/contact/tool.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/contact/contacts.hpp"

namespace crumble {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The code and, in the text, all of `words`.
void expect_error(const std::function<void()>& call, Code code, const Vector<std::string>& words) {
  try {
    call();
    ADD_FAILURE() << "accepted, although " << words.front() << " is wrong";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    for (const std::string& word : words)
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
  }
}

void expect_friction_error(const Friction& friction, Code code, const Vector<std::string>& words) {
  expect_error([&] { check(friction); }, code, words);
  expect_error([&] { check(Wall{{{0, 1, 0}, 0}, friction}); }, code, words);
  const Vector<std::uint8_t> none;
  expect_error(
      [&] {
        Contacts({{make_bar({1, 1, 1}), friction}}, {}, none, ContactRule::nearest_surface);
      },
      code, words);
  expect_error([&] { Contacts({}, {{{{0, 1, 0}, 0}, friction}}, none, ContactRule::nearest_surface); }, code, words);
}

TEST(ToolInput, GoodFrictionIsAccepted) {
  for (const Friction& good : {Friction{0, 0}, Friction{3.0, 1.5}, Friction{1, 1}, Friction{0.1, 0}})
    EXPECT_NO_THROW(check(good));
}

TEST(ToolInput, BadFrictionNamesItsFieldAndValue) {
  expect_friction_error({kNan, 0.5}, Code::invalid_value, {"friction.static", "nan"});
  expect_friction_error({1, kNan}, Code::invalid_value, {"friction.dynamic", "nan"});
  expect_friction_error({kInfinity, 1}, Code::invalid_value, {"friction.static", "inf"});
  expect_friction_error({-0.25, 0}, Code::out_of_range, {"friction.static", "-0.25"});
  expect_friction_error({1, -0.25}, Code::out_of_range, {"friction.dynamic", "-0.25"});
  expect_friction_error({0.5, 0.75}, Code::out_of_range, {"friction.static", "0.5", "friction.dynamic", "0.75"});
}

TEST(ToolInput, BadWallNamesItsField) {
  const Friction friction{3, 1.5};
  EXPECT_NO_THROW(check(Wall{{{0, 0.6, 0.8}, -2}, friction}));
  const auto expect_wall_error = [&](const Vec3& normal, double offset, Code code, const Vector<std::string>& words) {
    expect_error([&] { check(Wall{{normal, offset}, friction}); }, code, words);
  };
  expect_wall_error({0, 1, 0}, kNan, Code::invalid_value, {"wall.offset", "nan"});
  expect_wall_error({0, 1, 0}, -kInfinity, Code::invalid_value, {"wall.offset", "-inf"});
  expect_wall_error({0, kNan, 0}, 0, Code::invalid_value, {"wall.normal", "nan"});
  expect_wall_error({kInfinity, 0, 0}, 0, Code::invalid_value, {"wall.normal", "inf"});
  expect_wall_error({0, 0, 0}, 0, Code::out_of_range, {"wall.normal", "0"});
  expect_wall_error({0, 2, 0}, 0, Code::out_of_range, {"wall.normal", "2"});
  expect_wall_error({0, 1.00001, 0}, 0, Code::out_of_range, {"wall.normal", "1.00001"});
}

TEST(ToolInput, ToolWithoutFacesIsRefused) {
  const Vector<std::uint8_t> none;
  expect_error([&] { Contacts({Tool{}}, {}, none, ContactRule::nearest_surface); }, Code::empty, {"tool.shape"});
}

}  // namespace
}  // namespace crumble
