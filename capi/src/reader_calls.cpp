// The crumble_reader_ functions.
#include <cmath>
#include <string>

#include "arrays.hpp"
#include "defs.hpp"
#include "objects.hpp"
#include "reader.hpp"

namespace crumble::capi {
namespace {

static_assert(std::uint32_t{CRUMBLE_SURFACE_CRACKS} == static_cast<std::uint32_t>(SurfaceMode::cracks));
static_assert(std::uint32_t{CRUMBLE_SURFACE_FRAGMENTS} == static_cast<std::uint32_t>(SurfaceMode::fragments));
static_assert(std::uint32_t{CRUMBLE_SURFACE_PAPER} == static_cast<std::uint32_t>(SurfaceMode::paper));
static_assert(CRUMBLE_NONE == kNoFragment && CRUMBLE_NONE == Event::kNone);

crumble_reader_def default_reader_def() {
  const SurfaceSettings settings;
  crumble_reader_def def{};
  def.struct_size = sizeof def;
  def.surface_mode = static_cast<std::uint32_t>(settings.mode);
  def.settle = settings.settle;
  def.crease = settings.crease;
  return def;
}

SurfaceSettings read_settings(const crumble_reader_def* def) {
  if (!def) return {};
  const crumble_reader_def given = read_def("def", def, default_reader_def());
  require_at_most("surface_mode", given.surface_mode, CRUMBLE_SURFACE_PAPER);
  return {static_cast<SurfaceMode>(given.surface_mode), given.settle, given.crease};
}

crumble_reader_info describe(const Reader& reader) {
  const PublishedState& state = *reader.state;
  crumble_reader_info out{};
  out.fragment_count = static_cast<std::uint32_t>(state.fragment_count);
  out.step = state.step;
  out.time = state.time;
  out.first_step = state.first_step;
  out.cuts = state.counters.cuts;
  out.dropped_events = reader.link->publisher.events_dropped();
  out.vertex_count = static_cast<std::uint32_t>(reader.surface.positions().size());
  out.triangle_count = static_cast<std::uint32_t>(reader.surface.triangles().size());
  out.skin_triangle_count = static_cast<std::uint32_t>(reader.surface.skin_triangle_count());
  out.surface_rebuilt = reader.surface.rebuilt();
  return out;
}

crumble_fragment_info describe_fragment(Reader& reader, std::uint32_t fragment) {
  const Fragment& measured = reader.measure(fragment);
  const FragmentRecord& record = reader.state->records[fragment];
  crumble_fragment_info out{};
  out.node_count = measured.node_count;
  out.tetrahedron_count = measured.tetrahedron_count;
  out.least_node = measured.node_count > 0 ? measured.least_node : CRUMBLE_NONE;
  out.parent = record.parent;
  out.state = static_cast<std::uint32_t>(reader.state->fragment_states[fragment]);
  out.born = record.born;
  out.mass = measured.mass;
  out.rest_volume = measured.rest_volume;
  for (int axis = 0; axis < 3; ++axis) {
    out.center[axis] = measured.center[axis];
    out.low[axis] = measured.low[axis];
    out.high[axis] = measured.high[axis];
    out.inertia[axis] = measured.inertia(axis, axis);
  }
  out.inertia[3] = measured.inertia(0, 1);
  out.inertia[4] = measured.inertia(0, 2);
  out.inertia[5] = measured.inertia(1, 2);
  return out;
}

crumble_event to_c(const Event& event) {
  crumble_event out{};
  out.kind = static_cast<std::uint32_t>(event.kind);
  out.spring = event.spring;
  out.node = event.node;
  out.holder = event.holder;
  out.fragment = event.fragment;
  out.parent = event.parent;
  out.step = event.step;
  out.time = event.time;
  for (int axis = 0; axis < 3; ++axis) out.place[axis] = event.place[axis];
  out.energy = event.energy;
  return out;
}

void require_fragment(const Reader& reader, std::uint32_t fragment) {
  if (fragment >= reader.state->fragment_count) {
    throw Error(Code::out_of_range, "fragment is " + std::to_string(fragment) + ", there are " +
                                        std::to_string(reader.state->fragment_count) + " of them");
  }
}

crumble_view view_of_reader(const Reader& reader, std::uint32_t which) {
  const PublishedState& state = *reader.state;
  switch (which) {
    case CRUMBLE_ARRAY_POSITIONS:
      throw Error(Code::unsupported, "positions as rows exist as copies only; views are per axis");
    case CRUMBLE_ARRAY_POSITIONS_X:
      return view_of(std::span(state.positions.x));
    case CRUMBLE_ARRAY_POSITIONS_Y:
      return view_of(std::span(state.positions.y));
    case CRUMBLE_ARRAY_POSITIONS_Z:
      return view_of(std::span(state.positions.z));
    case CRUMBLE_ARRAY_INTACT:
      return view_of(std::span(state.intact));
    case CRUMBLE_ARRAY_NODE_FRAGMENTS:
      return view_of(std::span(state.fragments));
    case CRUMBLE_ARRAY_SURFACE_SKIN_SOURCES:
      return view_of(reader.surface.skin_sources());
    case CRUMBLE_ARRAY_SURFACE_CHANGED_TRIANGLES:
      return view_of(reader.surface.changed_triangles());
    case CRUMBLE_ARRAY_SURFACE_CHANGED_VERTICES:
      return view_of(reader.surface.changed_vertices());
    default:
      return view_of_surface(reader.surface, which);
  }
}

}  // namespace
}  // namespace crumble::capi

using namespace crumble;
using namespace crumble::capi;

crumble_result crumble_reader_def_init(crumble_reader_def* def, uint32_t struct_size) {
  return guard(__func__, [&](const Call&) {
    write_struct("def", def, struct_size, default_reader_def());
    return CRUMBLE_OK;
  });
}

crumble_result crumble_reader_create(crumble_sim sim, const crumble_reader_def* def, crumble_reader* reader) {
  return with<Sim>(__func__, sim, [&](Sim& s, const Call&) {
    require_pointer("reader", reader);
    auto object = std::make_unique<Reader>(s.mesh, s.simulation, read_settings(def));
    s.drop_closed_readers();
    s.readers.push_back(object->link);
    publish(std::move(object), reader);
    return CRUMBLE_OK;
  });
}

crumble_result crumble_reader_destroy(crumble_reader reader) {
  return destroy<Reader>(__func__, reader);
}

crumble_result crumble_reader_update(crumble_reader reader, crumble_reader_info* info) {
  return with<Reader>(__func__, reader, [&](Reader& r, const Call&) {
    if (info) check_struct_size("info", info->struct_size);
    r.update();
    if (info) write_struct("info", info, describe(r));
    return CRUMBLE_OK;
  });
}

crumble_result crumble_reader_get_view(crumble_reader reader, uint32_t which, crumble_view* view) {
  return with<Reader>(__func__, reader, [&](const Reader& r, const Call&) {
    require_pointer("view", view);
    *view = view_of_reader(r, which);
    return CRUMBLE_OK;
  });
}

crumble_result crumble_reader_copy(crumble_reader reader, uint32_t which, void* dst, uint64_t dst_bytes,
                                   uint64_t* needed) {
  return with<Reader>(__func__, reader, [&](const Reader& r, const Call& call) {
    if (which == CRUMBLE_ARRAY_POSITIONS) return copy(call, r.state->positions, dst, dst_bytes, needed);
    return copy(call, view_of_reader(r, which), dst, dst_bytes, needed);
  });
}

crumble_result crumble_reader_get_fragment(crumble_reader reader, uint32_t fragment, crumble_fragment_info* info) {
  return with<Reader>(__func__, reader, [&](Reader& r, const Call&) {
    require_pointer("info", info);
    check_struct_size("info", info->struct_size);
    require_fragment(r, fragment);
    write_struct("info", info, describe_fragment(r, fragment));
    return CRUMBLE_OK;
  });
}

crumble_result crumble_reader_get_fragment_list(crumble_reader reader, uint32_t fragment, uint32_t which,
                                                crumble_view* list) {
  return with<Reader>(__func__, reader, [&](Reader& r, const Call&) {
    require_pointer("list", list);
    require_fragment(r, fragment);
    require_at_most("which", which, CRUMBLE_LIST_TRIANGLES);
    *list = view_of(r.list(fragment, which));
    return CRUMBLE_OK;
  });
}

crumble_result crumble_reader_spread_over_skin(crumble_reader reader, const float* boundary, float* skin,
                                               uint32_t skin_count) {
  return with<Reader>(__func__, reader, [&](const Reader& r, const Call& call) -> crumble_result {
    require_pointer("boundary", boundary);
    require_pointer("skin", skin);
    using Corners = SurfaceExtractor::CornerCoordinates;
    static_assert(sizeof(Corners) == 6 * sizeof(float) && alignof(Corners) == alignof(float));
    const std::size_t needed = r.surface.skin_triangle_count();
    if (skin_count < needed) {
      return call.fail(CRUMBLE_E_BUFFER_TOO_SMALL, {"skin_count is ", skin_count, ", needed are ", needed});
    }
    r.surface.spread_over_skin({reinterpret_cast<const Corners*>(boundary), r.mesh->boundary.size()},
                               {reinterpret_cast<Corners*>(skin), needed});
    return CRUMBLE_OK;
  });
}

crumble_result crumble_reader_read_events(crumble_reader reader, crumble_event* events, uint32_t capacity,
                                          uint32_t* count) {
  return with<Reader>(__func__, reader, [&](Reader& r, const Call&) {
    if (capacity > 0) require_pointer("events", events);
    require_pointer("count", count);
    *count = 0;
    Event batch[64];
    while (*count < capacity) {
      const std::size_t room = std::min<std::size_t>(std::size(batch), capacity - *count);
      const std::size_t taken = r.link->publisher.read_events(std::span(batch).first(room));
      for (std::size_t i = 0; i < taken; ++i) events[(*count)++] = to_c(batch[i]);
      if (taken < room) break;
    }
    return CRUMBLE_OK;
  });
}
