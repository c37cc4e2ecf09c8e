// What `crumble zwidth` measures: many presses of a simulated hand, each by itself.
#pragma once

#include <functional>
#include <string>

#include "closed_loop/closed_loop.hpp"
#include "crumble/base/memory.hpp"

namespace crumble::app {

struct Press {
  closed_loop::Case what;
  closed_loop::Setup setup;
  closed_loop::Outcome outcome;

  bool passes() const { return closed_loop::passes(outcome, setup); }
};

/// One setup under all combinations.
struct SetupPresses {
  std::string name;
  Vector<Press> presses;
};

/// Presses over a stiffness and the rate of the servo.
struct StabilityMap {
  std::string title;
  Vector<double> stiffnesses, rates;  // N/m, Hz
  Vector<Press> presses;              // by stiffness, then rate
  Vector<double> chosen;              // N/m by rate: what the loop would take for the coupling; may be empty

  const Press& at(std::size_t stiffness, std::size_t rate) const { return presses[stiffness * rates.size() + rate]; }
  /// The greatest stiffness up to which all pass, at each rate; 0 where the least fails.
  Vector<double> largest_stable() const;
};

struct ZWidth {
  bool quick = false;
  Vector<SetupPresses> setups;
  Vector<StabilityMap> body;      // over the stiffness of the body's springs; a row for each setup
  Vector<StabilityMap> coupling;  // over that of the coupling
};

inline constexpr std::size_t kMapColumns = 2;  // `body` and `coupling` lie in rows of so many

/// On all processors. `progress` is told the share done, by one thread at a time. `quick`: a sample of everything.
ZWidth measure_zwidth(bool quick, const std::function<void(double)>& progress);

}  // namespace crumble::app
