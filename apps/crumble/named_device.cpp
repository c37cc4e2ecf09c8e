#include "named_device.hpp"

#include <algorithm>
#include <cmath>

#include "crumble/base/error.hpp"
#include "crumble/base/text.hpp"
#include "crumble/device/open.hpp"
#include "scenes/scene.hpp"

namespace crumble::app {
namespace {

constexpr double kWait = 0.8;                        // s: a loop lets nothing in before, and the force comes slowly
constexpr double kMove = 1, kHold = 2, kRest = 0.2;  // s, of the hand and of pokes
constexpr double kMostDepth = 6e-3;                  // m, of all but a press, which goes as deep as the scene says
constexpr double kWide = 0.01;                       // m to each side, of a random hand

/// "kind" or "kind:rest".
struct Word {
  std::string kind, rest;
  bool has_rest;
};

Word split(const std::string& name) {
  const std::size_t colon = name.find(':');
  if (colon == std::string::npos) return {name, {}, false};
  return {name.substr(0, colon), name.substr(colon + 1), true};
}

[[noreturn]] void refuse(const DeviceChoice& choice, Code code, const std::string& why) {
  throw Error(code, "--device '" + choice.name + "' " + why);
}

// m/s
double speed_of(const DeviceChoice& choice, const Word& word) {
  const auto speed = parse_double(word.rest);
  if (!speed) refuse(choice, Code::format, "needs a speed: " + word.kind + ":MM_PER_S");
  require_positive("--device " + word.kind + ":MM_PER_S", *speed);
  return *speed * 1e-3;
}

std::uint64_t seed_of(const DeviceChoice& choice, const Word& word) {
  if (!word.has_rest) return 0;
  const auto seed = parse_double(word.rest);
  const bool whole = seed && *seed >= 0 && *seed <= 1e15 && std::floor(*seed) == *seed;
  if (!whole) refuse(choice, Code::format, "needs a whole number for its seed: " + word.kind + ":SEED");
  return static_cast<std::uint64_t>(*seed);
}

Pose above(const DeviceChoice& choice) {
  return {{0, choice.clearance, 0}, Quat::Identity()};
}

NamedDevice open_pressing_hand(const DeviceChoice& choice) {
  const Vec3 deep{0, -(choice.clearance + std::min(choice.depth, kMostDepth)), 0};
  HandOptions hand;
  hand.start = above(choice);
  hand.points = {{kWait, Vec3::Zero()},
                 {kWait + kMove, deep},
                 {kWait + kMove + kHold, deep},
                 {kWait + kMove + kHold + kMove, Vec3::Zero()}};
  hand.encoder_step = choice.encoder_step;
  return {open_hand(hand, 1 / choice.rate), hand.points.back().time + kRest};
}

NamedDevice open_straight_press(const DeviceChoice& choice, const Word& word) {
  const double way = choice.clearance + choice.depth;
  const double seconds = kWait + way / speed_of(choice, word);
  return {open_path({above(choice), {{kWait, Vec3::Zero()}, {seconds, {0, -way, 0}}}}, 1 / choice.rate), seconds};
}

// A loop feels only those after the first: its interlock and its ramp come before.
NamedDevice open_pokes(const DeviceChoice& choice, const Word& word) {
  const double way = choice.clearance + std::min(choice.depth, kMostDepth), time = way / speed_of(choice, word);
  const PokeOptions poke{
      .start = above(choice), .depth = way, .in = time, .hold = kHold, .out = time, .rest = kWait, .count = 3};
  return {open_poke(poke, 1 / choice.rate), poke.count * (2 * time + kHold) + (poke.count - 1) * kWait};
}

NamedDevice open_wandering(const DeviceChoice& choice, const Word& word) {
  WanderOptions wander{.start = above(choice)};
  wander.low = {-kWide, -(choice.clearance + std::min(choice.depth, kMostDepth)), -kWide};
  wander.high = {kWide, choice.clearance, kWide};
  wander.seed = seed_of(choice, word);
  return {open_wander(wander, 1 / choice.rate), std::nullopt};
}

NamedDevice open_trembling(const DeviceChoice& choice, const Word& word) {
  return {open_tremor({.start = above(choice), .seed = seed_of(choice, word)}, 1 / choice.rate), std::nullopt};
}

NamedDevice open_trajectory(const DeviceChoice& choice, const Word& word) {
  const Trajectory trajectory = load_trajectory(word.rest);
  const double seconds = trajectory.rows.back().time - trajectory.rows.front().time;
  return {open_replay(trajectory, {.clock = choice.clock}, 1 / choice.rate), seconds};
}

NamedDevice open_phantom_named(const DeviceChoice& choice, const Word& word) {
  PhantomOptions options;
  options.library = choice.library;
  options.name = word.rest;
  options.rate = choice.rate;
  return {open_phantom(options), std::nullopt};
}

NamedDevice open_inverse3_at(const DeviceChoice& choice, const Word& word) {
  Inverse3Options options;
  if (word.has_rest) {
    const Word place = split(word.rest);
    options.host = place.kind;
    if (place.has_rest) {
      const auto port = parse_double(place.rest);
      if (!port || !(*port >= 1 && *port <= 65535) || std::floor(*port) != *port) {
        refuse(choice, Code::format, "needs a port from 1 to 65535: inverse3:HOST:PORT");
      }
      options.port = static_cast<std::uint16_t>(*port);
    }
  }
  return {open_inverse3(options), std::nullopt};
}

constexpr std::array<std::string_view, 8> kKinds = {"hand",   "press",  "poke",    "wander",
                                                    "tremor", "replay", "phantom", "inverse3"};

}  // namespace

void check(const DeviceChoice& choice) {
  require_finite("--rate", choice.rate);
  require_in_range("--rate", choice.rate, 100, 10'000);
  const Word word = split(choice.name);
  if (std::ranges::find(kKinds, word.kind) == kKinds.end() || (word.kind == "hand" && word.has_rest)) {
    refuse(choice, Code::unsupported, std::string("is not known; there are ") + kDeviceHelp);
  }
  if (word.kind == "press" || word.kind == "poke") speed_of(choice, word);
  if (word.kind == "wander" || word.kind == "tremor") seed_of(choice, word);
  if (word.kind == "replay" && word.rest.empty()) refuse(choice, Code::format, "needs a file: replay:FILE");
  if (word.kind != "hand" && choice.encoder_step != 0) {
    throw Error(Code::state, "--encoder needs --device hand, which is '" + choice.name + "'");
  }
  if (word.kind != "phantom" && !choice.library.empty()) {
    throw Error(Code::state, "--library needs --device phantom, which is '" + choice.name + "'");
  }
}

NamedDevice open_named(const DeviceChoice& choice) {
  const Word word = split(choice.name);
  if (word.kind == "press") return open_straight_press(choice, word);
  if (word.kind == "poke") return open_pokes(choice, word);
  if (word.kind == "wander") return open_wandering(choice, word);
  if (word.kind == "tremor") return open_trembling(choice, word);
  if (word.kind == "replay") return open_trajectory(choice, word);
  if (word.kind == "phantom") return open_phantom_named(choice, word);
  if (word.kind == "inverse3") return open_inverse3_at(choice, word);
  return open_pressing_hand(choice);
}

}  // namespace crumble::app
