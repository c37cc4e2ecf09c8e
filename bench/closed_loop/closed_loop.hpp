// Experiments with a simulated hand in the loop: what `crumble zwidth` shows and the tests of haptics hold us to.
//
// A hand presses the 8 mm stick 6 mm into the paper's cube, holds it for five seconds and draws it back. A loop that is
// stable does so quietly and never gives the hand more energy than it took.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "crumble/base/memory.hpp"
#include "crumble/haptics/loop.hpp"

namespace crumble::closed_loop {

/// Hand and device as one mass, on the spring and damper of the grip.
struct Grip {
  const char* name;
  double mass, stiffness, damping;  // kg, N/m, N s/m
};
inline constexpr Grip kLoose{"loose", 0.10, 50, 0.5};
inline constexpr Grip kFirm{"firm", 0.25, 500, 10};
inline constexpr Grip kBare{"bare", 0.075, 20, 0.05};  // a light device that nobody holds well
inline constexpr double kDeviceMass = 0.075;           // kg, as the device tells

/// What is pressed, and how.
struct Case {
  Grip grip = kLoose;
  double spring_stiffness = 30;  // of the body's springs, N/m
  double tick = 1e-3;            // s, of servo and body
  bool mean = false;             // Eq (7)
  std::uint32_t delay = 0;       // ticks, of the force in the device; the loop knows of it
};
/// Three grips, k of 30 and 100 N/m, ticks of 2.9 and 1 ms, with and without mean, delay 0 and 1.
Vector<Case> all_cases();
std::string to_string(const Case& c);

/// What stands between body and hand, and how well the device sees.
struct Setup {
  std::string name = "default";
  BodyCoupling body = BodyCoupling::direct;
  std::uint32_t body_ticks = 1;
  bool coupling = true;
  double coupling_stiffness = 0;  // N/m; 0: chosen by the loop
  bool damping = true;
  bool controller = false;
  double max_damping = 0;   // N s/m; 0: the device's
  double encoder_step = 0;  // m
  bool lateral = false;     // the hand also moves to the sides, and the stick has friction
  double hold = 5;          // s
  double depth = 6e-3;      // m, that the hand wants to press
};

struct Outcome {
  double least_energy = 0;       // J: least of what the hand has given, at any time; below 0 it was given energy
  double observed_least = 0;     // J: the same as the loop's observer has it
  double hold_speed = 0;         // m/s, rms over the last two seconds of the hold
  double hold_span = 0;          // m, peak to peak, likewise; the axis where it is greatest
  double hold_force_span = 0;    // N, of the force sent, peak to peak, likewise
  double peak_force = 0;         // N
  std::uint64_t tool_jumps = 0;  // ticks in which the tool moved by 0.1 mm more or less than the device
  double depth = 0;              // m, of the hand below the first touch, at the end of the hold
  std::uint64_t hold_cuts = 0;   // springs that broke during the hold
  std::uint64_t cuts = 0;
  double required_damping = 0;  // N s/m
  std::uint64_t capped = 0;     // ticks in which less was injected than that
  double stiffness = 0;         // N/m, that the hand felt at most
  Fault fault = Fault::none;
};

Outcome press(const Case& c, const Setup& setup);

/// Energy never below -1e-5 J and speed in the hold below 1 mm/s; with encoder or to the sides -1e-4 J, and with an
/// encoder no more than 3 steps peak to peak. No cut in the hold, no fault.
bool passes(const Outcome& outcome, const Setup& setup);
/// Why not; empty when it passes.
std::string failure(const Outcome& outcome, const Setup& setup);
/// How many times over its limit the worse of energy given and motion in the hold is: at most 1 when it passes.
double excess(const Outcome& outcome, const Setup& setup);
/// N/m of the coupling, where the setup leaves it to the loop.
double chosen_stiffness(const Case& c, const Setup& setup);

/// The setups that are compared: the library's default; the same without the coupling; without anything; the paper's.
Setup default_setup();
Setup damping_only();
Setup bare_setup();
Setup paper_setup();
inline constexpr double kEncoderStep = 5.5e-5;  // m, of a Touch

}  // namespace crumble::closed_loop
