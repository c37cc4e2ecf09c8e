// The same bits on every processor: each kernel that this build holds and the processor runs is taken through the same
// violence, and what comes out is compared with hashes that stand below. scripts/verify-kernels runs this program as
// built for x86-64, AArch64 and WebAssembly; as the constants are the same, so are the bits.
//
// No files, no threads, no test framework: it has to run where there is nothing else.
#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "crumble/base/memory.hpp"
#include "crumble/base/random.hpp"
#include "crumble/network/solver.hpp"
#include "crumble/tetmesh/lattice_box.hpp"

namespace crumble {
namespace {

struct Golden {
  const char* body;
  std::uint64_t float32, float64;
};
// This program prints them when they do not fit. They change with the order of sums, that is with the layout.
constexpr Golden kGolden[] = {
    {"rows", 0x807b28901dc88c9e, 0x23d6daa16d1d54bc},         {"shuffled", 0x6a9331e994011a7d, 0xf55907d2b8f338b4},
    {"tangle", 0xa9933bdda8c10360, 0xc54424f4f543e3e7},       {"large_rows", 0xff4136d320ff4df4, 0x06e83af41f830a39},
    {"large_tangle", 0x7c43084ce9e000c4, 0xda2ef4b9ff8553a7},
};

struct Body {
  std::string name;
  SpringNetwork network;
  crumble::Vector<Vec3> at;
  int steps = 0;
};

// Nearly all springs in segments, and all of a way alike.
Body crystal(const std::string& name, const Vec3& size, double spacing, int steps) {
  const TetMesh mesh = make_lattice_box(size, spacing);
  const std::uint32_t fixed[] = {0, 7, 20};
  return {name, make_network(mesh, {}, MassRule::lumped, fixed), mesh.positions, steps};
}

crumble::Vector<std::uint32_t> random_order(std::size_t count, Random& random) {
  crumble::Vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  for (std::size_t i = count; i > 1; --i) std::swap(order[i - 1], order[static_cast<std::size_t>(random.below(i))]);
  return order;
}

template <class T>
void reorder(const crumble::Vector<std::uint32_t>& order, crumble::Vector<T>& values) {
  const crumble::Vector<T> old = values;
  for (std::size_t i = 0; i < old.size(); ++i) values[order[i]] = old[i];
}

// Nodes and springs in any order, and no two springs alike. The rows are found again.
Body shuffled(const std::string& name, Body body, Random& random) {
  SpringNetwork& n = body.network;
  const auto nodes = random_order(n.node_count(), random), springs = random_order(n.spring_count(), random);
  for (auto* values : {&n.masses, &n.drags, &n.stiffness_sums}) reorder(nodes, *values);
  reorder(nodes, n.fixed), reorder(nodes, body.at);
  for (Edge& e : n.springs) {
    const auto [first, second] = std::minmax(nodes[e[0]], nodes[e[1]]);
    e = {first, second};
  }
  reorder(springs, n.springs), reorder(springs, n.rest_lengths);
  for (double& k : n.stiffnesses) k *= random.uniform(0.5, 1);
  body.name = name;
  return body;
}

Vec3 random_vector(Random& random, double size) {
  const double x = random.uniform(-size, size), y = random.uniform(-size, size);
  return {x, y, random.uniform(-size, size)};
}

// Springs between all points that are neither near nor far: no rows, many batches.
Body tangle(const std::string& name, std::size_t points, double size, int steps, Random& random) {
  TetMesh mesh;
  for (std::size_t i = 0; i < points; ++i) mesh.positions.push_back(random_vector(random, size / 2));
  for (std::uint32_t i = 0; i < points; ++i) {
    for (std::uint32_t j = i + 1; j < points; ++j) {
      const double square = squared_norm(mesh.positions[j] - mesh.positions[i]);
      if (square > 0.001 * 0.001 && square < 0.004 * 0.004) mesh.springs.push_back({i, j});
    }
  }
  const std::uint32_t fixed[] = {0, 7, 20};
  return {name, make_network(mesh, {}, MassRule::equal, fixed), mesh.positions, steps};
}

// A body that is shaken, held, dragged and torn.
class Ordeal {
 public:
  Ordeal(const Body& body, Precision precision, const std::string& kernel)
      : body_(body), external_(body.at.size()), fading_() {
    SolverSettings settings;
    settings.precision = precision;
    settings.kernel = kernel;
    settings.length_limit = 1.25;
    settings.cut_share = 0.5;
    solver_ = NetworkSolver::make(body.network, make_coefficients(body.network, 1e-3, TimeStepPolicy::guard), body.at,
                                  settings);
  }

  std::uint64_t run() {
    for (int step = 0; step < body_.steps; ++step) {
      if (step % 16 == 0) shake();
      if (step == body_.steps / 4) let_loose();
      if (step == body_.steps / 2) external_.x[external_.size() / 2] = 1e12;  // out of the world
      solver_->set_external(external_);
      const auto pushed = static_cast<std::uint32_t>(random_.below(body_.at.size()));
      solver_->push(pushed, random_vector(random_, 0.1));
      fade();
      hold();
      solver_->solve(held_);
      for (const NodeConstraint& c : held_) hash_.add(std::uint64_t{static_cast<std::uint8_t>(c.state)});
      if (solver_->lost_node()) ++lost_, external_.x[external_.size() / 2] = 0;
    }
    solver_->add_to(hash_);
    return hash_.value();
  }

  // All parts of the kernels had work to do.
  bool was_worth_it() const {
    return cut_ > 100 && cut_ < 9 * body_.network.spring_count() / 10 && lost_ > 0 && held_in_all_ > 100;
  }
  LayoutReport layout() const { return solver_->layout(); }

 private:
  void shake() {
    for (std::size_t i = 0; i < external_.size(); ++i) external_.set(i, random_vector(random_, 0.05));
  }

  // A third of the nodes, five and one, but no fixed one.
  void let_loose() {
    const auto third = static_cast<std::uint32_t>(body_.at.size() / 3);
    crumble::Vector<std::uint32_t> nodes;
    for (std::uint32_t node = 30; nodes.size() < third + 6; ++node) {
      if (!body_.network.fixed[node]) nodes.push_back(node);
    }
    const crumble::Vector<std::uint32_t> first{0, third, third + 5, third + 6};
    solver_->set_loose({first, nodes});
  }

  // A spring found too long has half its stiffness for a step and then none.
  void fade() {
    for (const std::uint32_t spring : fading_) solver_->set_share(spring, 0);
    fading_.assign(solver_->overlong().begin(), solver_->overlong().end());
    for (const std::uint32_t spring : fading_) {
      hash_.add(std::uint64_t{spring});
      solver_->set_share(spring, 0.5);
    }
    cut_ += fading_.size();
  }

  // Finds nodes in a box and behind a plane, holds some of them and moves some.
  void hold() {
    const Vec3 corner = body_.at[static_cast<std::size_t>(random_.below(body_.at.size()))];
    const Vec3 size = Vec3::Constant(0.004) + random_vector(random_, 0.003);
    const auto found = solver_->inside(corner - size, corner + size);
    crumble::Vector<std::uint32_t> nodes(found.begin(), found.end());
    hash_.add(std::uint64_t{nodes.size()});
    for (const std::uint32_t node : nodes) hash_.add(std::uint64_t{node});
    const Vec3 normal = normalized(random_vector(random_, 1));
    for (const std::uint32_t node : solver_->behind({normal, dot(normal, corner) - 0.01}))
      hash_.add(std::uint64_t{node});

    held_.clear();
    if (nodes.size() > 24) nodes.resize(24);
    for (const std::uint32_t node : nodes) {
      NodeConstraint c;
      c.node = node;
      c.normal = normal;
      c.velocity = random_vector(random_, 0.5);
      c.static_friction = random_.uniform(0, 2);
      c.dynamic_friction = c.static_friction * random_.uniform();
      held_.push_back(c);
      const Vec3 to = solver_->position(node) + random_vector(random_, 0.001);
      if (random_.below(4) == 0 && !body_.network.fixed[node]) solver_->place(node, to, c.velocity);
    }
    held_in_all_ += held_.size();
  }

  const Body& body_;
  std::unique_ptr<NetworkSolver> solver_;
  VecArray external_;
  crumble::Vector<NodeConstraint> held_;
  crumble::Vector<std::uint32_t> fading_;
  Random random_{11};
  Hash hash_;
  std::size_t cut_ = 0, held_in_all_ = 0, lost_ = 0;
};

// The hash that all kernels agree on; nothing when they do not.
std::optional<std::uint64_t> common_hash(const Body& body, Precision precision) {
  std::optional<std::uint64_t> common;
  bool agree = true;
  for (const std::string& kernel : kernel_names()) {
    Ordeal ordeal(body, precision, kernel);
    const std::uint64_t hash = ordeal.run();
    std::printf("%-12s %s %-6s %016" PRIx64 "\n", body.name.c_str(),
                precision == Precision::float32 ? "float32" : "float64", kernel.c_str(), hash);
    if (!common) common = hash;
    agree = agree && hash == *common && ordeal.was_worth_it();
  }
  return agree ? common : std::nullopt;
}

crumble::Vector<Body> make_bodies() {
  Random random(3);
  const Body rows = crystal("rows", {0.033, 0.03, 0.036}, 0.003, 160);
  return {rows, shuffled("shuffled", rows, random), tangle("tangle", 1500, 0.03, 160, random),
          crystal("large_rows", {0.06, 0.06, 0.06}, 0.003, 30), tangle("large_tangle", 6000, 0.04, 30, random)};
}

// The bodies are laid out as their names promise.
bool is_as_named(const Body& body, const LayoutReport& layout) {
  const bool large = body.name.starts_with("large"), tangled = body.name.ends_with("tangle");
  std::printf("%-12s %zu springs, %zu of them in segments, %u partitions\n", body.name.c_str(),
              body.network.spring_count(), layout.springs_in_segments, layout.partitions);
  const bool in_batches = 4 * layout.springs_in_segments < 3 * body.network.spring_count();
  return (layout.partitions > 1) == large && in_batches == tangled;
}

int run() {
  bool good = true;
  std::string table;
  const crumble::Vector<Body> bodies = make_bodies();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    good = is_as_named(bodies[b], Ordeal(bodies[b], Precision::float32, "scalar").layout()) && good;
    const auto narrow = common_hash(bodies[b], Precision::float32), wide = common_hash(bodies[b], Precision::float64);
    if (!narrow || !wide) {
      std::printf("%s: kernels differ, or had nothing to do\n", bodies[b].name.c_str());
      return 1;
    }
    good = good && bodies[b].name == kGolden[b].body && *narrow == kGolden[b].float32 && *wide == kGolden[b].float64;
    char row[100];
    std::snprintf(row, sizeof row, "    {\"%s\", 0x%016" PRIx64 ", 0x%016" PRIx64 "},\n", bodies[b].name.c_str(),
                  *narrow, *wide);
    table += row;
  }
  if (!good) std::printf("not the constants of tests/kernels/bits.cpp, which would have to be\n%s", table.c_str());
  return good ? 0 : 1;
}

}  // namespace
}  // namespace crumble

int main() {
  return crumble::run();
}
