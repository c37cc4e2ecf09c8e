#include "grids.hpp"

#include "crumble/base/memory.hpp"
#include "crumble/fracture/masks.hpp"

namespace crumble::app {
namespace {

using render::VtkCell;
using render::VtkGrid;
using Numbers = Vector<double>;
using Ids = Vector<std::int32_t>;

constexpr std::int32_t kNone = -1;  // kNoFragment as a signed number

Ids to_ids(std::span<const std::uint32_t> numbers) {
  Ids ids;
  for (const std::uint32_t number : numbers) ids.push_back(static_cast<std::int32_t>(number));
  return ids;
}

Vector<Vec3> to_points(VecView from) {
  Vector<Vec3> points;
  for (std::size_t i = 0; i < from.size(); ++i) points.push_back(from[i]);
  return points;
}

// The fragment that all corners of a cell are in.
template <std::size_t N>
std::int32_t common_fragment(const Simulation& sim, const std::array<std::uint32_t, N>& corners) {
  const auto fragments = sim.node_fragments();
  for (const std::uint32_t node : corners) {
    if (fragments[node] != fragments[corners[0]]) return kNone;
  }
  return static_cast<std::int32_t>(fragments[corners[0]]);
}

struct NumberedFragment {
  std::uint32_t id;
  FragmentRecord record;
  Fragment measured;
};

Vector<NumberedFragment> measure(const Simulation& sim) {
  Vector<Fragment> measured(sim.fragments().count());
  measure_fragments(sim.mesh(), sim.node_fragments(), sim.network().masses, sim.positions(), measured,
                    sim.velocities());
  Vector<NumberedFragment> there;
  for (std::uint32_t id = 0; id < measured.size(); ++id) {
    if (measured[id].node_count > 0) there.push_back({id, sim.fragments().record(id), measured[id]});
  }
  return there;
}

nlohmann::ordered_json to_json(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

}  // namespace

VtkGrid spring_grid(const Simulation& sim) {
  const Vector<Edge>& springs = sim.mesh().springs;
  VtkGrid grid;
  grid.time = sim.info().time;
  grid.points = to_points(sim.positions());
  grid.cell = VtkCell::line;
  grid.corners = render::to_corners(springs);
  Ids ids, fragments;
  Numbers stretches;
  for (std::size_t s = 0; s < springs.size(); ++s) {
    const auto& [a, b] = springs[s];
    ids.push_back(static_cast<std::int32_t>(s));
    stretches.push_back(norm(grid.points[b] - grid.points[a]) / sim.network().rest_lengths[s]);
    fragments.push_back(common_fragment(sim, springs[s]));
  }
  const Vector<std::uint8_t> intact(sim.intact().begin(), sim.intact().end());
  grid.cell_data = {{"spring", ids}, {"intact", intact}, {"stretch", stretches}, {"fragment", fragments}};
  grid.point_data = {{"velocity", to_points(sim.velocities())}, {"fragment", to_ids(sim.node_fragments())}};
  return grid;
}

VtkGrid body_grid(const TetMesh& mesh) {
  VtkGrid grid;
  grid.points = mesh.positions;
  grid.cell = VtkCell::tetrahedron;
  grid.corners = render::to_corners(mesh.tetrahedra);
  Vector<std::uint8_t> kinds;
  for (const NodeKind kind : mesh.kinds) kinds.push_back(static_cast<std::uint8_t>(kind));
  grid.point_data = {{"kind", kinds}};
  return grid;
}

VtkGrid body_grid(const Simulation& sim) {
  const TetMesh& mesh = sim.mesh();
  VtkGrid grid = body_grid(mesh);
  grid.time = sim.info().time;
  grid.points = to_points(sim.positions());
  grid.point_data.push_back({"rest", mesh.positions});
  grid.point_data.push_back({"fragment", to_ids(sim.node_fragments())});
  Vector<std::uint8_t> masks;
  Ids fragments;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    masks.push_back(cut_mask(mesh.tet_springs[t], sim.intact()));
    fragments.push_back(common_fragment(sim, mesh.tetrahedra[t]));
  }
  grid.cell_data = {{"cut_mask", masks}, {"fragment", fragments}};
  return grid;
}

VtkGrid fragment_grid(const Simulation& sim) {
  VtkGrid grid;
  grid.time = sim.info().time;
  grid.cell = VtkCell::vertex;
  Ids ids, parents, nodes, tetrahedra;
  Numbers masses, volumes, born;
  Vector<Vec3> velocities;
  for (const NumberedFragment& fragment : measure(sim)) {
    grid.corners.push_back(static_cast<std::int32_t>(grid.points.size()));
    grid.points.push_back(fragment.measured.center);
    ids.push_back(static_cast<std::int32_t>(fragment.id));
    parents.push_back(static_cast<std::int32_t>(fragment.record.parent));
    born.push_back(static_cast<double>(fragment.record.born));
    nodes.push_back(static_cast<std::int32_t>(fragment.measured.node_count));
    tetrahedra.push_back(static_cast<std::int32_t>(fragment.measured.tetrahedron_count));
    masses.push_back(fragment.measured.mass);
    volumes.push_back(fragment.measured.rest_volume);
    velocities.push_back(fragment.measured.velocity);
  }
  grid.point_data = {{"fragment", ids},          {"parent", parents},     {"born", born},
                     {"nodes", nodes},           {"mass", masses},        {"rest_volume", volumes},
                     {"tetrahedra", tetrahedra}, {"velocity", velocities}};
  return grid;
}

nlohmann::ordered_json fragment_json(const Simulation& sim) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const auto& [id, record, fragment] : measure(sim)) {
    nlohmann::ordered_json inertia = nlohmann::ordered_json::array();
    for (int row = 0; row < 3; ++row) inertia.push_back(to_json(fragment.inertia.row(row)));
    list.push_back({{"id", id},
                    {"parent", nullptr},
                    {"born_step", record.born},
                    {"nodes", fragment.node_count},
                    {"tetrahedra", fragment.tetrahedron_count},
                    {"rest_volume_m3", fragment.rest_volume},
                    {"mass_kg", fragment.mass},
                    {"center_m", to_json(fragment.center)},
                    {"velocity_m_s", to_json(fragment.velocity)},
                    {"inertia_kg_m2", inertia},
                    {"low_m", to_json(fragment.low)},
                    {"high_m", to_json(fragment.high)}});
    if (record.parent != kNoFragment) list.back()["parent"] = record.parent;
  }
  return {{"time_s", sim.info().time}, {"step", sim.info().step}, {"fragments", list}};
}

}  // namespace crumble::app
