// Views, copies, fragments and the surface, against what the C++ API says of the same body.
#include <cstring>

#include "capi/rig.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/fracture/fragments.hpp"
#include "crumble/geometry/triangle_mesh.hpp"

namespace crumble {
namespace {

template <class T>
Vector<T> rows_of(const crumble_view& view) {
  const auto* const first = static_cast<const T*>(view.data);
  EXPECT_EQ(view.stride, view.components * sizeof(T));
  return {first, first + view.count * view.components};
}

class Arrays : public CapiTest {
 protected:
  crumble_view mesh_view(std::uint32_t which) {
    crumble_view view{};
    EXPECT_RESULT(CRUMBLE_OK, crumble_mesh_get_view(mesh, which, &view));
    return view;
  }
  crumble_view sim_view(std::uint32_t which) {
    crumble_view view{};
    EXPECT_RESULT(CRUMBLE_OK, crumble_sim_get_view(sim, which, &view));
    return view;
  }
  template <class T>
  Vector<T> copy_of(std::uint32_t which) {
    std::uint64_t needed = 0;
    EXPECT_RESULT(CRUMBLE_OK, crumble_sim_copy(sim, which, nullptr, 0, &needed));
    Vector<T> values(needed / sizeof(T));
    EXPECT_RESULT(CRUMBLE_OK, crumble_sim_copy(sim, which, values.data(), needed, nullptr));
    return values;
  }
};

TEST_F(Arrays, OfAMesh) {
  const TetMesh& twin = cube.mesh;
  EXPECT_EQ(rows_of<double>(mesh_view(CRUMBLE_ARRAY_REST_POSITIONS)), cube.positions);
  EXPECT_EQ(rows_of<std::uint32_t>(mesh_view(CRUMBLE_ARRAY_TETRAHEDRA)), cube.tetrahedra);
  EXPECT_EQ(rows_of<double>(mesh_view(CRUMBLE_ARRAY_NODE_VOLUMES)), twin.node_volumes);
  const auto kinds = rows_of<std::uint8_t>(mesh_view(CRUMBLE_ARRAY_NODE_KINDS));
  ASSERT_EQ(kinds.size(), twin.node_count());
  for (std::size_t i = 0; i < kinds.size(); ++i) EXPECT_EQ(kinds[i], static_cast<std::uint8_t>(twin.kinds[i]));
  const auto springs = rows_of<std::uint32_t>(mesh_view(CRUMBLE_ARRAY_SPRINGS));
  ASSERT_EQ(springs.size(), 2 * twin.springs.size());
  for (std::size_t s = 0; s < twin.springs.size(); ++s) EXPECT_EQ(springs[2 * s + 1], twin.springs[s][1]);
  const auto boundary = rows_of<std::uint32_t>(mesh_view(CRUMBLE_ARRAY_BOUNDARY));
  ASSERT_EQ(boundary.size(), 3 * twin.boundary.size());
  for (std::size_t t = 0; t < twin.boundary.size(); ++t) EXPECT_EQ(boundary[3 * t + 2], twin.boundary[t][2]);

  crumble_mesh_info info{};
  info.struct_size = sizeof info;
  ASSERT_OK(crumble_mesh_get_info(mesh, &info));
  EXPECT_EQ(info.node_count, 343u);          // 7^3
  EXPECT_EQ(info.surface_node_count, 218u);  // 7^3 - 5^3
  EXPECT_EQ(info.tetrahedron_count, 1296u);  // 6 * 6^3
  EXPECT_EQ(info.boundary_triangle_count, 432u);
  EXPECT_EQ(info.spring_count, twin.springs.size());
  EXPECT_NEAR(info.volume, 2.7e-5, 1e-18);
  crumble_view view{};
  EXPECT_RESULT(CRUMBLE_E_OUT_OF_RANGE, crumble_mesh_get_view(mesh, CRUMBLE_ARRAY_INTACT, &view));
  EXPECT_RESULT(CRUMBLE_E_OUT_OF_RANGE, crumble_mesh_get_view(mesh, 0, &view));
}

TEST_F(Arrays, OfASimulation) {
  press(1, 250);
  const auto positions = copy_of<double>(CRUMBLE_ARRAY_POSITIONS);
  const auto velocities = copy_of<double>(CRUMBLE_ARRAY_VELOCITIES);
  for (int axis = 0; axis < 3; ++axis) {
    const auto x = rows_of<double>(sim_view(CRUMBLE_ARRAY_POSITIONS_X + axis));
    const auto v = rows_of<double>(sim_view(CRUMBLE_ARRAY_VELOCITIES_X + axis));
    ASSERT_EQ(x.size(), cube.node_count());
    EXPECT_EQ(copy_of<double>(CRUMBLE_ARRAY_POSITIONS_X + axis), x);
    for (std::size_t i = 0; i < x.size(); ++i) {
      EXPECT_EQ(positions[3 * i + axis], x[i]);
      EXPECT_EQ(velocities[3 * i + axis], v[i]);
    }
  }
  EXPECT_NE(positions, cube.positions);
  const auto intact = rows_of<std::uint8_t>(sim_view(CRUMBLE_ARRAY_INTACT));
  ASSERT_EQ(intact.size(), cube.mesh.springs.size());
  EXPECT_EQ(static_cast<std::uint64_t>(std::count(intact.begin(), intact.end(), 0)), counters().cuts);
  for (const std::uint32_t spring : rows_of<std::uint32_t>(sim_view(CRUMBLE_ARRAY_NEW_CUTS))) {
    EXPECT_EQ(intact[spring], 0);
  }
  EXPECT_EQ(sim_view(CRUMBLE_ARRAY_NEW_CUTS).count, info().new_cuts);

  crumble_view view{};
  EXPECT_RESULT(CRUMBLE_E_UNSUPPORTED, crumble_sim_get_view(sim, CRUMBLE_ARRAY_POSITIONS, &view));
  EXPECT_RESULT(CRUMBLE_E_OUT_OF_RANGE, crumble_sim_get_view(sim, CRUMBLE_ARRAY_SPRINGS, &view));
  EXPECT_RESULT(CRUMBLE_E_OUT_OF_RANGE, crumble_sim_get_view(sim, 0xffffffffu, &view));
  EXPECT_RESULT(CRUMBLE_E_STATE, crumble_sim_get_view(sim, CRUMBLE_ARRAY_SURFACE_NORMALS, &view));
  EXPECT_EQ(view.data, nullptr);
}

TEST_F(Arrays, BuffersAreFilledToTheByteOrNotAtAll) {
  const std::uint64_t exact = 24u * cube.node_count();
  std::uint64_t needed = 0;
  Vector<unsigned char> buffer(exact + 1, 0xab);
  expect_failure(CRUMBLE_E_BUFFER_TOO_SMALL,
                 crumble_sim_copy(sim, CRUMBLE_ARRAY_POSITIONS, buffer.data(), exact - 1, &needed),
                 {"dst_bytes", std::to_string(exact - 1), std::to_string(exact)});
  EXPECT_EQ(needed, exact);
  EXPECT_EQ(std::count(buffer.begin(), buffer.end(), 0xab), static_cast<std::ptrdiff_t>(exact + 1));
  ASSERT_OK(crumble_sim_copy(sim, CRUMBLE_ARRAY_POSITIONS, buffer.data(), exact, &needed));
  EXPECT_EQ(buffer.back(), 0xab);
  EXPECT_EQ(std::memcmp(buffer.data(), cube.positions.data(), exact), 0);
  // a buffer that is not aligned
  ASSERT_OK(crumble_sim_copy(sim, CRUMBLE_ARRAY_POSITIONS, buffer.data() + 1, exact, nullptr));
  EXPECT_EQ(std::memcmp(buffer.data() + 1, cube.positions.data(), exact), 0);

  Vector<unsigned char> springs(8 * cube.mesh.springs.size() + 1, 0xab);
  EXPECT_RESULT(CRUMBLE_E_BUFFER_TOO_SMALL, crumble_mesh_copy(mesh, CRUMBLE_ARRAY_SPRINGS, springs.data(), 8, &needed));
  EXPECT_EQ(needed, springs.size() - 1);
  EXPECT_EQ(springs[0], 0xab);
  ASSERT_OK(crumble_mesh_copy(mesh, CRUMBLE_ARRAY_SPRINGS, springs.data(), needed, nullptr));
  EXPECT_EQ(springs.back(), 0xab);
  EXPECT_EQ(std::memcmp(springs.data(), cube.mesh.springs.data(), needed), 0);
}

TEST_F(Arrays, FragmentsFollowTheCuts) {
  std::uint32_t count = 0;
  ASSERT_OK(crumble_sim_count_fragments(sim, &count));
  EXPECT_EQ(count, 1u);
  std::uint64_t size = 0;
  ASSERT_OK(crumble_sim_snapshot(sim, nullptr, 0, &size));
  Vector<std::uint8_t> whole(size);
  ASSERT_OK(crumble_sim_snapshot(sim, whole.data(), size, nullptr));
  press(1, 1000);  // far enough that pieces come off
  FragmentLabeler labeler(cube.node_count(), cube.mesh.springs);
  labeler.label(rows_of<std::uint8_t>(sim_view(CRUMBLE_ARRAY_INTACT)));
  ASSERT_OK(crumble_sim_count_fragments(sim, &count));
  EXPECT_GT(count, 1u);
  EXPECT_EQ(count, labeler.count());
  const auto labels = rows_of<std::uint32_t>(sim_view(CRUMBLE_ARRAY_NODE_FRAGMENTS));
  for (const auto& [a, b] : cube.mesh.springs) {
    EXPECT_EQ(labels[a] == labels[b], labeler.labels()[a] == labeler.labels()[b]);
  }
  crumble_surface_info surface{};
  surface.struct_size = sizeof surface;
  ASSERT_OK(crumble_sim_extract_surface(sim, &surface));
  EXPECT_EQ(surface.fragment_count, count);
  ASSERT_OK(crumble_sim_restore(sim, whole.data(), size));
  ASSERT_OK(crumble_sim_count_fragments(sim, &count));
  EXPECT_EQ(count, 1u);
  ASSERT_OK(crumble_sim_extract_surface(sim, &surface));
  EXPECT_EQ(surface.triangle_count, 432u);
}

TEST_F(Arrays, TheSurfaceIsWholeAndFollowsTheBody) {
  crumble_surface_info surface{};
  surface.struct_size = sizeof surface;
  ASSERT_OK(crumble_sim_extract_surface(sim, &surface));
  EXPECT_EQ(surface.vertex_count, 218u);
  EXPECT_EQ(surface.triangle_count, 432u);
  EXPECT_EQ(surface.skin_triangle_count, 432u);
  EXPECT_EQ(surface.fragment_count, 1u);

  const auto expect_whole = [&] {
    EXPECT_RESULT(CRUMBLE_OK, crumble_sim_extract_surface(sim, &surface));
    TriangleMesh triangles;
    const auto p = copy_of<double>(CRUMBLE_ARRAY_SURFACE_POSITIONS);
    for (std::size_t v = 0; v < p.size(); v += 3) triangles.vertices.push_back({p[v], p[v + 1], p[v + 2]});
    const auto t = copy_of<std::uint32_t>(CRUMBLE_ARRAY_SURFACE_TRIANGLES);
    for (std::size_t i = 0; i < t.size(); i += 3) triangles.triangles.push_back({t[i], t[i + 1], t[i + 2]});
    EXPECT_EQ(triangles.vertices.size(), surface.vertex_count);
    EXPECT_EQ(triangles.triangles.size(), surface.triangle_count);
    EXPECT_EQ(find_surface_defects(triangles).total(), 0u);
    const crumble_view normals = sim_view(CRUMBLE_ARRAY_SURFACE_NORMALS);
    EXPECT_EQ(normals.scalar_type, std::uint32_t{CRUMBLE_SCALAR_FLOAT32});
    EXPECT_EQ(rows_of<float>(normals).size(), 9 * triangles.triangles.size());
    for (const std::uint32_t f : rows_of<std::uint32_t>(sim_view(CRUMBLE_ARRAY_SURFACE_FRAGMENTS))) {
      EXPECT_LT(f, surface.fragment_count);
    }
    for (const std::uint32_t each : rows_of<std::uint32_t>(sim_view(CRUMBLE_ARRAY_SURFACE_TETRAHEDRA))) {
      EXPECT_LT(each, cube.tetrahedron_count());
    }
    EXPECT_EQ(sim_view(CRUMBLE_ARRAY_SURFACE_REST_POSITIONS).count, surface.vertex_count);
  };
  press(1, 400);
  expect_whole();
  EXPECT_GT(surface.triangle_count, surface.skin_triangle_count);
  const auto before = copy_of<double>(CRUMBLE_ARRAY_SURFACE_POSITIONS);
  press(401, 410);
  EXPECT_EQ(copy_of<double>(CRUMBLE_ARRAY_SURFACE_POSITIONS), before) << "only asking brings it up to date";
  expect_whole();
  EXPECT_NE(copy_of<double>(CRUMBLE_ARRAY_SURFACE_POSITIONS), before);
  ASSERT_OK(crumble_sim_reset(sim));
  expect_whole();
  EXPECT_EQ(surface.triangle_count, 432u);
}

}  // namespace
}  // namespace crumble
