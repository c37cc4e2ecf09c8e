#include "arrays.hpp"

#include <string>

#include "defs.hpp"
#include "objects.hpp"

namespace crumble::capi {

crumble_result copy(const Call& call, const crumble_view& view, void* dst, std::uint64_t dst_bytes,
                    std::uint64_t* needed) {
  const std::uint64_t bytes = view.count * view.stride;
  return deliver(call, bytes, dst, dst_bytes, needed, [&](void* to) {
    if (bytes > 0) std::memcpy(to, view.data, bytes);
  });
}

crumble_result copy(const Call& call, const VecView& rows, void* dst, std::uint64_t dst_bytes, std::uint64_t* needed) {
  return deliver(call, rows.size() * 3 * sizeof(double), dst, dst_bytes, needed, [&](void* to) {
    auto* out = static_cast<unsigned char*>(to);  // may lie anywhere
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (const double value : {rows.x[i], rows.y[i], rows.z[i]}) {
        std::memcpy(out, &value, sizeof value);
        out += sizeof value;
      }
    }
  });
}

namespace {

[[noreturn]] void no_such_array(std::uint32_t which) {
  throw Error(Code::out_of_range, "which is " + std::to_string(which) + ", no array of this object");
}

crumble_view view_of_mesh(const TetMesh& mesh, std::uint32_t which) {
  switch (which) {
    case CRUMBLE_ARRAY_REST_POSITIONS:
      return view_of(std::span(mesh.positions));
    case CRUMBLE_ARRAY_NODE_KINDS:
      return view_of(mesh.kinds.data(), mesh.kinds.size(), 1, CRUMBLE_SCALAR_UINT8);
    case CRUMBLE_ARRAY_NODE_VOLUMES:
      return view_of(std::span(mesh.node_volumes));
    case CRUMBLE_ARRAY_TETRAHEDRA:
      return view_of(std::span(mesh.tetrahedra));
    case CRUMBLE_ARRAY_SPRINGS:
      return view_of(std::span(mesh.springs));
    case CRUMBLE_ARRAY_BOUNDARY:
      return view_of(std::span(mesh.boundary));
    default:
      no_such_array(which);
  }
}

}  // namespace

crumble_view view_of_surface(const SurfaceExtractor& surface, std::uint32_t which) {
  switch (which) {
    case CRUMBLE_ARRAY_SURFACE_POSITIONS:
      return view_of(surface.positions());
    case CRUMBLE_ARRAY_SURFACE_REST_POSITIONS:
      return view_of(surface.rest_positions());
    case CRUMBLE_ARRAY_SURFACE_TRIANGLES:
      return view_of(surface.triangles());
    case CRUMBLE_ARRAY_SURFACE_NORMALS: {
      const auto normals = surface.corner_normals();
      static_assert(sizeof normals[0] == 9 * sizeof(float));
      return view_of(normals.data(), normals.size(), 9, CRUMBLE_SCALAR_FLOAT32);
    }
    case CRUMBLE_ARRAY_SURFACE_FRAGMENTS:
      return view_of(surface.fragments());
    case CRUMBLE_ARRAY_SURFACE_TETRAHEDRA:
      return view_of(surface.tetrahedra());
    default:
      no_such_array(which);
  }
}

namespace {

crumble_view view_of_own_surface(const SurfaceExtractor* surface, std::uint32_t which) {
  if (which < CRUMBLE_ARRAY_SURFACE_POSITIONS || which > CRUMBLE_ARRAY_SURFACE_TETRAHEDRA) no_such_array(which);
  if (!surface) throw Error(Code::state, "there is no surface yet: call crumble_sim_extract_surface first");
  return view_of_surface(*surface, which);
}

crumble_view view_of_sim(Sim& sim, std::uint32_t which) {
  const Simulation& simulation = sim.simulation;
  switch (which) {
    case CRUMBLE_ARRAY_POSITIONS:
    case CRUMBLE_ARRAY_VELOCITIES:
      throw Error(Code::unsupported, "positions and velocities as rows exist as copies only; views are per axis");
    case CRUMBLE_ARRAY_POSITIONS_X:
      return view_of(simulation.positions().x);
    case CRUMBLE_ARRAY_POSITIONS_Y:
      return view_of(simulation.positions().y);
    case CRUMBLE_ARRAY_POSITIONS_Z:
      return view_of(simulation.positions().z);
    case CRUMBLE_ARRAY_VELOCITIES_X:
      return view_of(simulation.velocities().x);
    case CRUMBLE_ARRAY_VELOCITIES_Y:
      return view_of(simulation.velocities().y);
    case CRUMBLE_ARRAY_VELOCITIES_Z:
      return view_of(simulation.velocities().z);
    case CRUMBLE_ARRAY_INTACT:
      return view_of(simulation.intact());
    case CRUMBLE_ARRAY_NEW_CUTS:
      return view_of(simulation.new_cuts());
    case CRUMBLE_ARRAY_NODE_FRAGMENTS:
      return view_of(simulation.node_fragments());
    default:
      return view_of_own_surface(sim.surface.get(), which);
  }
}

}  // namespace
}  // namespace crumble::capi

using namespace crumble::capi;

crumble_result crumble_mesh_get_view(crumble_mesh mesh, uint32_t which, crumble_view* view) {
  return with<Mesh>(__func__, mesh, [&](const Mesh& m, const Call&) {
    require_pointer("view", view);
    *view = view_of_mesh(*m.mesh, which);
    return CRUMBLE_OK;
  });
}

crumble_result crumble_mesh_copy(crumble_mesh mesh, uint32_t which, void* dst, uint64_t dst_bytes, uint64_t* needed) {
  return with<Mesh>(__func__, mesh, [&](const Mesh& m, const Call& call) {
    return copy(call, view_of_mesh(*m.mesh, which), dst, dst_bytes, needed);
  });
}

crumble_result crumble_sim_get_view(crumble_sim sim, uint32_t which, crumble_view* view) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call&) {
    require_pointer("view", view);
    *view = view_of_sim(s, which);
    return CRUMBLE_OK;
  });
}

crumble_result crumble_sim_copy(crumble_sim sim, uint32_t which, void* dst, uint64_t dst_bytes, uint64_t* needed) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call& call) {
    if (which == CRUMBLE_ARRAY_POSITIONS) return copy(call, s.simulation.positions(), dst, dst_bytes, needed);
    if (which == CRUMBLE_ARRAY_VELOCITIES) return copy(call, s.simulation.velocities(), dst, dst_bytes, needed);
    return copy(call, view_of_sim(s, which), dst, dst_bytes, needed);
  });
}

crumble_result crumble_sim_extract_surface(crumble_sim sim, crumble_surface_info* info) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call&) {
    if (info) check_struct_size("info", info->struct_size);
    if (!s.surface) s.surface = std::make_unique<crumble::SurfaceExtractor>(*s.mesh);
    const crumble::Simulation& now = s.simulation;
    s.surface->update({now.positions(), now.intact(), now.node_fragments(), now.info().time});
    if (!info) return CRUMBLE_OK;
    crumble_surface_info out{};
    out.vertex_count = static_cast<uint32_t>(s.surface->positions().size());
    out.triangle_count = static_cast<uint32_t>(s.surface->triangles().size());
    out.skin_triangle_count = static_cast<uint32_t>(s.surface->skin_triangle_count());
    out.fragment_count = static_cast<uint32_t>(now.fragments().count());
    write_struct("info", info, out);
    return CRUMBLE_OK;
  });
}
