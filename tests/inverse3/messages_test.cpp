#include "inverse3/messages.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "crumble/base/memory.hpp"
#include "crumble/base/random.hpp"
#include "device/inverse3_messages.hpp"
#include "device/samples.hpp"
#include "inverse3/fake_service.hpp"

namespace crumble {
namespace {

using device::Inverse3State;
using device::MessageKind;
using device::read_state;

MessageKind kind_of(const std::string& text) {
  Inverse3State state;
  return read_state(text, "049D", state);
}

void expect_near(const Vec3& got, const Vec3& wanted) {
  EXPECT_NEAR(norm(got - wanted), 0, 1e-15) << got.transpose();
}

TEST(Inverse3Messages, TellsAllPartsInOurFrame) {
  Inverse3State state;
  const std::string text = message(device_entry("049D", R"({"x":0.01,"y":-0.12,"z":0.15})"));
  ASSERT_EQ(read_state(text, "049D", state), MessageKind::state);
  EXPECT_EQ(state.measured,
            quantity::kPosition | quantity::kLinearVelocity | quantity::kOrientation | quantity::kButtons);
  expect_near(state.position, {0.01, 0.15, 0.12});  // up is z there and y here; forward is away from the user
  expect_near(state.velocity, {0.1, 0.3, -0.2});
  EXPECT_EQ(state.buttons, 5u);
  const Quat& q = state.orientation;
  expect_near(Vec3(q.x(), q.y(), q.z()), {0.1, 0.5, -0.7});
  EXPECT_DOUBLE_EQ(q.w(), 0.5);
}

// A turn of the grip about its own axis, seen from both frames: rotating a vector and renaming axes commute.
TEST(Inverse3Messages, OrientationsTurnTheSameWay) {
  const auto renamed = [](const Vec3& v) { return Vec3(v.x(), v.z(), -v.y()); };
  Random random(5);
  for (int i = 0; i < 50; ++i) {
    const Quat q = random_quat(random);
    const auto t = [](double v) { return std::to_string(v); };
    const std::string grip = R"("wireless_verse_grip":[{"state":{"orientation":{"w":)" + t(q.w()) + R"(,"x":)" +
                             t(q.x()) + R"(,"y":)" + t(q.y()) + R"(,"z":)" + t(q.z()) + "}}}]";
    Inverse3State state;
    ASSERT_EQ(read_state(message(device_entry("049D", place(0)), grip), "049D", state), MessageKind::state);
    const Vec3 v = random_vec(random, 1);
    const Vec3 there = rotate(rotation_matrix(q), v);
    EXPECT_NEAR(norm(rotate(rotation_matrix(state.orientation), renamed(v)) - renamed(there)), 0, 1e-5);
  }
}

TEST(Inverse3Messages, WhatIsMissingIsNotMeasured) {
  const std::string position_only =
      R"({"inverse3":[{"device_id":"049D","state":{"cursor_position":{"x":1,"y":2,"z":3}}}]})";
  Inverse3State state;
  ASSERT_EQ(read_state(position_only, "049D", state), MessageKind::state);
  EXPECT_EQ(state.measured, quantity::kPosition);
  expect_near(state.position, {1, 3, -2});  // whole numbers are numbers
  ASSERT_EQ(read_state(message(device_entry("049D", place(0)), R"("wireless_verse_grip":[])"), "049D", state),
            MessageKind::state);
  EXPECT_EQ(state.measured, quantity::kPosition | quantity::kLinearVelocity);
  // A grip that is asleep, and one with a single button.
  const std::string asleep =
      R"("wireless_verse_grip":[{"state":{"orientation":{"w":0,"x":0,"y":0,"z":0},"buttons":{"b":true}}}])";
  ASSERT_EQ(read_state(message(device_entry("049D", place(0)), asleep), "049D", state), MessageKind::state);
  EXPECT_EQ(state.measured & quantity::kOrientation, 0u);
  EXPECT_EQ(state.buttons, 2u);
}

TEST(Inverse3Messages, PicksTheDeviceByItsId) {
  const std::string two = message(device_entry("049D", place(1)) + "," + device_entry("0A11", place(2)));
  Inverse3State state;
  ASSERT_EQ(read_state(two, "0A11", state), MessageKind::state);
  EXPECT_DOUBLE_EQ(state.position.x(), 2e-5);
  EXPECT_EQ(device::inverse3_ids(two), (Vector<std::string>{"049D", "0A11"}));
  EXPECT_EQ(read_state(two, "FFFF", state), MessageKind::other);
  EXPECT_DOUBLE_EQ(state.position.x(), 2e-5) << "touched";
}

TEST(Inverse3Messages, KnowsWhatIsNoStateAndWhatIsNoMessage) {
  for (const char* text :
       {"{}", R"({"inverse3":[]})", R"({"session_id":1,"status":"ready"})", R"({"inverse3":[{"device_id":"049D"}]})",
        R"({"inverse3":[{"device_id":"049D","state":{}}]})",
        R"({"inverse3":[{"device_id":"0001","state":{"cursor_position":{"x":1,"y":2,"z":3}}}]})"}) {
    EXPECT_EQ(kind_of(text), MessageKind::other) << text;
    EXPECT_TRUE(device::inverse3_ids(text)) << text;
  }
  const auto with = [](const char* position) { return message(device_entry("049D", position)); };
  for (const std::string& text :
       {std::string(),
        std::string("hello"),
        std::string("[]"),
        std::string("null"),
        std::string("{\"inverse3\":"),
        std::string(R"({"inverse3":{}})"),
        std::string(R"({"inverse3":[7]})"),
        std::string(R"({"inverse3":[{}]})"),
        std::string(R"({"inverse3":[{"device_id":49}]})"),
        std::string(R"({"inverse3":[{"device_id":"049D","state":1}]})"),
        with("null"),
        with("[1,2,3]"),
        with(R"({"x":1,"y":2})"),
        with(R"({"x":null,"y":2,"z":3})"),
        with(R"({"x":"1","y":2,"z":3})"),
        with(R"({"x":1e999,"y":2,"z":3})"),
        with(R"({"x":NaN,"y":2,"z":3})"),
        with(R"({"x":true,"y":2,"z":3})"),
        state_message(0).substr(0, 200),
        state_message(0, R"("wireless_verse_grip":7)"),
        state_message(0, R"("wireless_verse_grip":[7])"),
        state_message(0, R"("wireless_verse_grip":[{"state":{"buttons":{"a":1}}}])"),
        state_message(0, R"("wireless_verse_grip":[{"state":{"orientation":{"x":0,"y":0,"z":0}}}])"),
        std::string(60'000, '['),
        std::string("{\"a\":\"\xff\xfe\"}")}) {
    EXPECT_EQ(kind_of(text), MessageKind::malformed) << text.substr(0, 300);
  }
}

TEST(Inverse3Messages, TheForceIsPutIntoHaplysFrame) {
  EXPECT_EQ(force_in(device::force_command("049D", {0.25, 0.5, 1.5}), "049D"), (std::array{0.25, -1.5, 0.5}));
  EXPECT_EQ(force_in(device::force_command("a\"b\\c", {1e-300, 0, 0}), "a\"b\\c"), (std::array{1e-300, 0.0, 0.0}));
}

// Bytes changed, dropped, doubled and swapped with parts of other messages: whatever it is taken for, nothing that is
// not finite gets through.
TEST(Inverse3Messages, BearsMutations) {
  Random random(2024);
  const std::string seeds[] = {state_message(3), state_message(4, ""),
                               message(device_entry("049D", place(1)) + "," + device_entry("0A11", place(2)))};
  int states = 0, malformed = 0;
  for (int round = 0; round < 30'000; ++round) {
    std::string text = seeds[random.below(3)];
    for (std::uint64_t edits = 1 + random.below(4); edits > 0 && !text.empty(); --edits) {
      const std::size_t at = random.below(text.size());
      const std::string& other = seeds[random.below(3)];
      const std::size_t from = random.below(other.size()), length = random.below(12);
      switch (random.below(5)) {
        case 0:
          text[at] = static_cast<char>(random.next());
          break;
        case 1:
          text.erase(at, length);
          break;
        case 2:
          text.insert(at, other, from, length);
          break;
        case 3:
          text.replace(at, length, other, from, length);
          break;
        default:
          text[at] = "0123456789-e.,:{}[]\""[random.below(20)];
      }
    }
    Inverse3State state;
    const MessageKind kind = read_state(text, "049D", state);
    if (kind == MessageKind::state) {
      ++states;
      ASSERT_TRUE(is_valid(Pose{state.position, state.orientation})) << text;
      ASSERT_TRUE(is_finite(state.velocity)) << text;
      ASSERT_LT(state.buttons, 8u);
    }
    malformed += kind == MessageKind::malformed;
    static_cast<void>(device::inverse3_ids(text));
  }
  EXPECT_GT(states, 1000);
  EXPECT_GT(malformed, 1000);
}

}  // namespace
}  // namespace crumble
