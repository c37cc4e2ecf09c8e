#include "zwidth_presses.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <thread>

#include "crumble/base/memory.hpp"

namespace crumble::app {
namespace {

using namespace closed_loop;

constexpr double kSlowBody = 3e-3;        // s, of a step of a body that is slower than the servo, about
constexpr double kCappedDamping = 4;      // N s/m: what real devices bear
constexpr double kCoupledSprings = 100;   // N/m, of the body's springs in the map over the coupling
constexpr double kQuickHold = 1;          // s; shorter than it takes a soft coupling to come to rest
constexpr std::size_t kSampleStride = 9;  // of the 48 combinations, so that every choice comes up
const Vector<double> kRates{300, 350, 500, 1000, 2000, 4000};
const Vector<double> kBodyStiffnesses{10, 30, 100, 300, 1000};
const Vector<double> kCouplingStiffnesses{100, 200, 500, 1000, 2000, 5000};

Setup named(Setup setup, const std::string& name) {
  setup.name = name;
  return setup;
}

Setup with_encoder(Setup setup) {
  setup.name += " + encoder";
  setup.encoder_step = kEncoderStep;
  return setup;
}

Setup to_the_sides(Setup setup) {
  setup.name += " + lateral";
  setup.lateral = true;
  return setup;
}

Setup capped(Setup setup) {
  setup.name += ", cap 4";
  setup.max_damping = kCappedDamping;
  return setup;
}

Setup local_model() {
  Setup setup = named(default_setup(), "local model");
  setup.body = BodyCoupling::local_model;
  return setup;
}

Vector<Setup> compared_setups() {
  const Setup plain = default_setup(), moving = to_the_sides(with_encoder(plain));
  return {plain,          with_encoder(plain),    moving,       capped(moving), local_model(),
          damping_only(), capped(damping_only()), bare_setup(), paper_setup()};
}

// Where the body does not step in the tick it takes three of 1 ms, one of 2.9 ms.
Setup fitted(Setup setup, const Case& what) {
  if (setup.body != BodyCoupling::direct) {
    setup.body_ticks = std::max(1u, static_cast<std::uint32_t>(std::lround(kSlowBody / what.tick)));
  }
  return setup;
}

Vector<SetupPresses> plan_combinations(bool quick) {
  const Vector<Case> cases = all_cases();
  Vector<SetupPresses> all;
  for (const Setup& setup : compared_setups()) {
    SetupPresses row{setup.name, {}};
    for (std::size_t i = 0; i < cases.size(); i += quick ? kSampleStride : 1) {
      row.presses.push_back({cases[i], fitted(setup, cases[i]), {}});
      if (quick) row.presses.back().setup.hold = kQuickHold;
    }
    all.push_back(std::move(row));
  }
  return all;
}

Vector<double> sample(const Vector<double>& values, bool quick) {
  return quick ? Vector<double>{values[0], values[2], values[3]} : values;
}

std::string map_title(const Setup& setup, const Grip& grip) {
  const std::string name =
      setup.coupling || setup.damping || setup.body != BodyCoupling::direct ? setup.name : "no stabiliser";
  return name + (grip.mass == kBare.mass ? ", hardly held" : ", held loosely");
}

using Plan = std::function<Press(double stiffness, double rate)>;

StabilityMap plan_map(const std::string& title, const Vector<double>& stiffnesses, bool quick, const Plan& plan) {
  StabilityMap map{title, sample(stiffnesses, quick), sample(kRates, quick), {}, {}};
  for (const double stiffness : map.stiffnesses) {
    for (const double rate : map.rates) {
      map.presses.push_back(plan(stiffness, rate));
      if (quick) map.presses.back().setup.hold = kQuickHold;
    }
  }
  return map;
}

Vector<StabilityMap> plan_body_maps(bool quick) {
  Vector<StabilityMap> maps;
  for (const Setup& setup : {with_encoder(default_setup()), damping_only(), bare_setup(), paper_setup()}) {
    for (const Grip& grip : {kBare, kLoose}) {
      maps.push_back(plan_map(map_title(setup, grip), kBodyStiffnesses, quick, [&](double stiffness, double rate) {
        return Press{{grip, stiffness, 1 / rate, false, 0}, setup, {}};
      }));
    }
  }
  return maps;
}

Vector<StabilityMap> plan_coupling_maps(bool quick) {
  Vector<StabilityMap> maps;
  for (const Grip& grip : {kBare, kLoose}) {
    for (const std::uint32_t delay : {0u, 1u}) {
      Setup setup = with_encoder(default_setup());
      const std::string title = map_title(setup, grip) + ", delay " + std::to_string(delay);
      const auto what = [&](double rate) { return Case{grip, kCoupledSprings, 1 / rate, false, delay}; };
      maps.push_back(plan_map(title, kCouplingStiffnesses, quick, [&](double stiffness, double rate) {
        setup.coupling_stiffness = stiffness;
        return Press{what(rate), setup, {}};
      }));
      for (const double rate : maps.back().rates) maps.back().chosen.push_back(chosen_stiffness(what(rate), setup));
    }
  }
  return maps;
}

Vector<Press*> all_presses(ZWidth& zwidth) {
  Vector<Press*> all;
  const auto add = [&](Vector<Press>& presses) {
    for (Press& p : presses) all.push_back(&p);
  };
  for (SetupPresses& row : zwidth.setups) add(row.presses);
  for (StabilityMap& map : zwidth.body) add(map.presses);
  for (StabilityMap& map : zwidth.coupling) add(map.presses);
  return all;
}

// Each thread takes the next that nobody has taken.
void press_all(const Vector<Press*>& presses, const std::function<void(double)>& progress) {
  std::atomic<std::size_t> next{0};
  std::size_t done = 0;
  std::exception_ptr failure;
  std::mutex mutex;
  const auto work = [&] {
    for (std::size_t i; (i = next++) < presses.size();) {
      try {
        presses[i]->outcome = press(presses[i]->what, presses[i]->setup);
      } catch (...) {
        const std::lock_guard lock(mutex);
        failure = std::current_exception();
        next = presses.size();
      }
      const std::lock_guard lock(mutex);
      if (progress) progress(static_cast<double>(++done) / static_cast<double>(presses.size()));
    }
  };
  {
    Vector<std::jthread> threads;
    for (unsigned n = std::max(1u, std::thread::hardware_concurrency()); n > 0; --n) threads.emplace_back(work);
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace

Vector<double> StabilityMap::largest_stable() const {
  Vector<double> largest(rates.size(), 0);
  for (std::size_t rate = 0; rate < rates.size(); ++rate) {
    for (std::size_t k = 0; k < stiffnesses.size() && at(k, rate).passes(); ++k) largest[rate] = stiffnesses[k];
  }
  return largest;
}

ZWidth measure_zwidth(bool quick, const std::function<void(double)>& progress) {
  ZWidth zwidth{quick, plan_combinations(quick), plan_body_maps(quick), plan_coupling_maps(quick)};
  press_all(all_presses(zwidth), progress);
  return zwidth;
}

}  // namespace crumble::app
