// crumble.h for C++17: objects that destroy themselves, errors as exceptions, definitions with defaults, arrays as
// spans. Header only; link crumble::crumble. A method is the function of the same name: sim.step() is
// crumble_sim_step(), whose comment in crumble.h holds here too. Structs and constants are those of crumble.h. The C++
// library (crumble::Simulation and so on, crumble::core) is another thing; both can be used in one file.
//
// Where exceptions are off (-fno-exceptions), what would be thrown ends in CRUMBLE_ON_ERROR(code, text) if the program
// defines that before it includes this file, the same way everywhere and not to return, else in a line on stderr and
// abort(). Functions called try_ never do either.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "crumble/crumble.h"

namespace crumble::c {

// ---- Errors ---------------------------------------------------------------------------------------------------------

/// What a function answered; what() is crumble_last_error().
class Error : public std::runtime_error {
 public:
  Error(crumble_result code, const char* text) : std::runtime_error(text), code_(code) {}
  /// CRUMBLE_E_
  crumble_result code() const noexcept { return code_; }
  /// "CRUMBLE_E_NULL" and so on.
  const char* name() const noexcept { return crumble_result_name(code_); }

 private:
  crumble_result code_;
};

[[noreturn]] inline void fail(crumble_result code, const char* text) {
#if defined(__cpp_exceptions) || defined(_CPPUNWIND)
  throw Error(code, text);
#else
#ifdef CRUMBLE_ON_ERROR
  CRUMBLE_ON_ERROR(code, text);
#else
  std::fprintf(stderr, "%s: %s\n", crumble_result_name(code), text);
#endif
  std::abort();
#endif
}

inline void check(crumble_result result) {
  if (result != CRUMBLE_OK) fail(result, crumble_last_error());
}

/// The library that is loaded fits this header; Error(CRUMBLE_E_VERSION) else.
inline void check_version() {
  check(crumble_check_version(CRUMBLE_VERSION_NUMBER));
}

// ---- Arrays ---------------------------------------------------------------------------------------------------------

/// As much of C++20's std::span as is needed here: objects in a row, of somebody else. Made from vectors, arrays and
/// the like; Span<const T> is read only.
template <class T>
class Span {
  template <class Other>
  using enable_if_fits = std::enable_if_t<std::is_convertible_v<Other (*)[], T (*)[]>>;

 public:
  constexpr Span() noexcept = default;
  constexpr Span(T* data, std::size_t size) noexcept : data_(data), size_(size) {}
  template <std::size_t N>
  constexpr Span(T (&array)[N]) noexcept : data_(array), size_(N) {}
  template <class Rows, class = enable_if_fits<std::remove_pointer_t<decltype(std::declval<Rows&>().data())>>>
  constexpr Span(Rows&& rows) noexcept : data_(rows.data()), size_(rows.size()) {}

  constexpr T* data() const noexcept { return data_; }
  constexpr std::size_t size() const noexcept { return size_; }
  constexpr bool empty() const noexcept { return size_ == 0; }
  constexpr T& operator[](std::size_t index) const noexcept { return data_[index]; }
  constexpr T* begin() const noexcept { return data_; }
  constexpr T* end() const noexcept { return data_ + size_; }

 private:
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

/// A CRUMBLE_ARRAY_ that holds numbers of type T.
template <class T>
struct Array {
  std::uint32_t which;
};

/// The arrays with their types. All scalars of a row, x, y, z or three corners, follow each other.
inline constexpr Array<double> kRestPositions{CRUMBLE_ARRAY_REST_POSITIONS}, kNodeVolumes{CRUMBLE_ARRAY_NODE_VOLUMES};
inline constexpr Array<std::uint8_t> kNodeKinds{CRUMBLE_ARRAY_NODE_KINDS};
inline constexpr Array<std::uint32_t> kTetrahedra{CRUMBLE_ARRAY_TETRAHEDRA}, kSprings{CRUMBLE_ARRAY_SPRINGS},
    kBoundary{CRUMBLE_ARRAY_BOUNDARY};
inline constexpr Array<double> kPositions{CRUMBLE_ARRAY_POSITIONS}, kPositionsX{CRUMBLE_ARRAY_POSITIONS_X},
    kPositionsY{CRUMBLE_ARRAY_POSITIONS_Y}, kPositionsZ{CRUMBLE_ARRAY_POSITIONS_Z};
inline constexpr Array<double> kVelocities{CRUMBLE_ARRAY_VELOCITIES}, kVelocitiesX{CRUMBLE_ARRAY_VELOCITIES_X},
    kVelocitiesY{CRUMBLE_ARRAY_VELOCITIES_Y}, kVelocitiesZ{CRUMBLE_ARRAY_VELOCITIES_Z};
inline constexpr Array<std::uint8_t> kIntact{CRUMBLE_ARRAY_INTACT};
inline constexpr Array<std::uint32_t> kNewCuts{CRUMBLE_ARRAY_NEW_CUTS}, kNodeFragments{CRUMBLE_ARRAY_NODE_FRAGMENTS};
inline constexpr Array<double> kSurfacePositions{CRUMBLE_ARRAY_SURFACE_POSITIONS},
    kSurfaceRestPositions{CRUMBLE_ARRAY_SURFACE_REST_POSITIONS};
inline constexpr Array<float> kSurfaceNormals{CRUMBLE_ARRAY_SURFACE_NORMALS};
inline constexpr Array<std::uint32_t> kSurfaceTriangles{CRUMBLE_ARRAY_SURFACE_TRIANGLES},
    kSurfaceFragments{CRUMBLE_ARRAY_SURFACE_FRAGMENTS}, kSurfaceTetrahedra{CRUMBLE_ARRAY_SURFACE_TETRAHEDRA},
    kSurfaceSkinSources{CRUMBLE_ARRAY_SURFACE_SKIN_SOURCES},
    kSurfaceChangedTriangles{CRUMBLE_ARRAY_SURFACE_CHANGED_TRIANGLES},
    kSurfaceChangedVertices{CRUMBLE_ARRAY_SURFACE_CHANGED_VERTICES};

// ---- Parts of the classes below -------------------------------------------------------------------------------------

namespace detail {

/// A count for the library; what is too large for it stays too large.
template <class T>
std::uint32_t count_of(Span<T> rows, std::size_t columns = 1) {
  if (rows.size() % columns != 0) fail(CRUMBLE_E_INVALID_VALUE, "an array that has no whole number of rows");
  return static_cast<std::uint32_t>(std::min<std::size_t>(rows.size() / columns, 0xffffffffu));
}

template <class T>
Span<const T> span_of(const crumble_view& view) {
  if (view.count > 1 && view.stride != view.components * sizeof(T))
    fail(CRUMBLE_E_UNSUPPORTED, "a view with gaps between its rows");
  return {static_cast<const T*>(view.data), static_cast<std::size_t>(view.count * view.components)};
}

/// A struct that the library fills.
template <class Struct>
Struct sized() noexcept {
  Struct out{};
  out.struct_size = sizeof out;
  return out;
}

/// Owns a handle; can be moved, not copied.
template <class Handle, crumble_result (*destroy_handle)(Handle)>
class Owner {
 public:
  Owner(const Owner&) = delete;
  Owner& operator=(const Owner&) = delete;
  Owner(Owner&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
  Owner& operator=(Owner&& other) noexcept {
    if (this != &other) {
      destroy_handle(handle_);
      handle_ = std::exchange(other.handle_, nullptr);
    }
    return *this;
  }
  /// What a loop still needs stays: let the loop go first, as it does when it is declared last.
  ~Owner() { destroy_handle(handle_); }

  /// Destroys the object now and says when that is not possible. Afterwards there is none: CRUMBLE_E_NULL.
  void destroy() {
    check(destroy_handle(handle_));
    handle_ = nullptr;
  }
  /// For the functions of crumble.h; nullptr when there is no object.
  Handle get() const noexcept { return handle_; }
  /// Gives the object away.
  Handle release() noexcept { return std::exchange(handle_, nullptr); }

 protected:
  explicit Owner(Handle handle = nullptr) noexcept : handle_(handle) {}

  Handle handle_;
};

/// Adds arrays, by the pair of functions that a kind of object has for them.
template <class Handle, crumble_result (*destroy_handle)(Handle),
          crumble_result (*get_view_of)(Handle, std::uint32_t, crumble_view*),
          crumble_result (*copy_of)(Handle, std::uint32_t, void*, std::uint64_t, std::uint64_t*)>
class ArrayOwner : public Owner<Handle, destroy_handle> {
 public:
  /// Without a copy; how long it is valid crumble.h says.
  template <class T>
  Span<const T> get_view(Array<T> array) const {
    crumble_view view{};
    check(get_view_of(this->handle_, array.which, &view));
    return span_of<T>(view);
  }
  /// Packed, to the beginning of `dst`; returns how many scalars these are.
  template <class T>
  std::size_t copy(Array<T> array, Span<T> dst) const {
    std::uint64_t needed = 0;
    T nothing{};  // where `dst` has no memory: NULL would only ask
    check(copy_of(this->handle_, array.which, dst.data() ? dst.data() : &nothing, dst.size() * sizeof(T), &needed));
    return static_cast<std::size_t>(needed / sizeof(T));
  }
  template <class T, class Rows>
  std::size_t copy(Array<T> array, Rows& dst) const {
    return copy(array, Span<T>(dst));
  }
  template <class T>
  std::vector<T> copy(Array<T> array) const {
    std::uint64_t needed = 0;
    check(copy_of(this->handle_, array.which, nullptr, 0, &needed));
    std::vector<T> out(static_cast<std::size_t>(needed / sizeof(T)));
    copy(array, out);
    return out;
  }

 protected:
  using Owner<Handle, destroy_handle>::Owner;
};

/// A definition that begins with the library's defaults.
template <class Struct, crumble_result (*init)(Struct*, std::uint32_t)>
struct Def : Struct {
  Def() : Struct() { check(init(this, sizeof(Struct))); }
};

/// Text of unknown length from `get(dst, dst_bytes, needed)`.
template <class Get>
std::string text_from(Get&& get) {
  std::uint64_t needed = 0;
  check(get(nullptr, 0, &needed));
  std::string out(static_cast<std::size_t>(needed), '\0');
  check(get(out.data(), needed, &needed));
  out.resize(out.find('\0'));
  return out;
}

}  // namespace detail

// ---- Memory and log -------------------------------------------------------------------------------------------------

/// For memory_set_source: `source`, which must outlive its use, has `void* take(std::uint64_t bytes, std::uint64_t
/// alignment) noexcept` and `void give_back(void* memory, std::uint64_t bytes, std::uint64_t alignment) noexcept`, both
/// called by several threads at once.
template <class Source>
crumble_memory_source memory_source_of(Source& source) noexcept {
  static_assert(noexcept(source.take(1, 1))&& noexcept(source.give_back(nullptr, 1, 1)),
                "the library calls these, and no exception may pass through it");
  auto functions = detail::sized<crumble_memory_source>();
  functions.user = &source;
  functions.take = [](std::uint64_t bytes, std::uint64_t alignment, void* user) -> void* {
    return static_cast<Source*>(user)->take(bytes, alignment);
  };
  functions.give_back = [](void* memory, std::uint64_t bytes, std::uint64_t alignment, void* user) {
    static_cast<Source*>(user)->give_back(memory, bytes, alignment);
  };
  return functions;
}
/// Before the first object is made, or when all are gone.
inline void memory_set_source(const crumble_memory_source& source) {
  check(crumble_memory_set_source(&source));
}
/// The C++ run time's memory again.
inline void memory_set_source(std::nullptr_t) {
  check(crumble_memory_set_source(nullptr));
}
/// `block` must live until another source is set.
inline void memory_use_block(Span<std::byte> block) {
  check(crumble_memory_use_block(block.data(), block.size()));
}
inline crumble_memory_info memory_get_info() {
  auto info = detail::sized<crumble_memory_info>();
  check(crumble_memory_get_info(&info));
  return info;
}

/// `level`: CRUMBLE_LOG_. Must not throw: that ends the program.
using LogFunction = std::function<void(std::uint32_t level, const char* text)>;

namespace detail {

/// The function of log_set: whoever is in it keeps it while another one is set.
struct LogHolder {
  std::shared_ptr<const LogFunction> exchange(std::shared_ptr<const LogFunction> next) {
    const std::lock_guard<std::mutex> lock(mutex);
    return std::exchange(function, std::move(next));
  }
  std::shared_ptr<const LogFunction> get() {
    const std::lock_guard<std::mutex> lock(mutex);
    return function;
  }

  std::mutex mutex;
  std::shared_ptr<const LogFunction> function;
};

/// Never destroyed: objects that go when the program ends may still have something to say.
inline LogHolder& log_holder() {
  static LogHolder& holder = *new LogHolder;
  return holder;
}

inline void call_log(std::uint32_t level, const char* text, void* holder) noexcept {
  const std::shared_ptr<const LogFunction> function = static_cast<LogHolder*>(holder)->get();
  if (function) (*function)(level, text);
}

}  // namespace detail

/// A plain function, called with `user`.
inline void log_set(crumble_log_function function, void* user) {
  check(crumble_log_set(function, user));
}
/// Any function, which is kept; empty or nullptr: nowhere.
inline void log_set(LogFunction function) {
  const bool off = !function;
  detail::LogHolder& holder = detail::log_holder();
  holder.exchange(off ? nullptr : std::make_shared<const LogFunction>(std::move(function)));
  log_set(off ? nullptr : detail::call_log, &holder);
}

// ---- Definitions ----------------------------------------------------------------------------------------------------

using MeshDef = detail::Def<crumble_mesh_def, crumble_mesh_def_init>;
using SimDef = detail::Def<crumble_sim_def, crumble_sim_def_init>;
using ToolDef = detail::Def<crumble_tool_def, crumble_tool_def_init>;
using WallDef = detail::Def<crumble_wall_def, crumble_wall_def_init>;
using ReaderDef = detail::Def<crumble_reader_def, crumble_reader_def_init>;
using DeviceDef = detail::Def<crumble_device_def, crumble_device_def_init>;
using DeviceCallbacks = detail::Def<crumble_device_callbacks, crumble_device_callbacks_init>;
using LoopDef = detail::Def<crumble_loop_def, crumble_loop_def_init>;
using HandDef = detail::Def<crumble_hand_def, crumble_hand_def_init>;

/// At a place, m, not turned.
constexpr crumble_pose pose_at(double x, double y, double z) noexcept {
  return {{x, y, z}, {1, 0, 0, 0}};
}

// ---- Meshes ---------------------------------------------------------------------------------------------------------

class Mesh : public detail::ArrayOwner<crumble_mesh, crumble_mesh_destroy, crumble_mesh_get_view, crumble_mesh_copy> {
 public:
  explicit Mesh(const crumble_mesh_def& def) { check(crumble_mesh_create(&def, &handle_)); }
  /// Takes over a handle of crumble.h.
  explicit Mesh(crumble_mesh handle) noexcept : ArrayOwner(handle) {}
  static Mesh create_paper(std::uint32_t body) {
    Mesh made{crumble_mesh{}};
    check(crumble_mesh_create_paper(body, &made.handle_));
    return made;
  }
  static Mesh create_from_tets(Span<const double> positions, Span<const std::uint32_t> tetrahedra) {
    Mesh made{crumble_mesh{}};
    check(crumble_mesh_create_from_tets(positions.data(), detail::count_of(positions, 3), tetrahedra.data(),
                                        detail::count_of(tetrahedra, 4), &made.handle_));
    return made;
  }

  crumble_mesh_info get_info() const {
    auto info = detail::sized<crumble_mesh_info>();
    check(crumble_mesh_get_info(handle_, &info));
    return info;
  }
  void save_vtk(const std::string& path) const { check(crumble_mesh_save_vtk(handle_, path.c_str())); }
};

// ---- Simulations ----------------------------------------------------------------------------------------------------

class Sim : public detail::ArrayOwner<crumble_sim, crumble_sim_destroy, crumble_sim_get_view, crumble_sim_copy> {
 public:
  explicit Sim(const Mesh& mesh) { check(crumble_sim_create(mesh.get(), nullptr, &handle_)); }
  Sim(const Mesh& mesh, const crumble_sim_def& def) { check(crumble_sim_create(mesh.get(), &def, &handle_)); }
  explicit Sim(crumble_sim handle) noexcept : ArrayOwner(handle) {}

  // Set-up and change, also between two steps; while a loop runs by the loop's functions.
  crumble_sim_def get_def() const {
    auto def = detail::sized<crumble_sim_def>();
    check(crumble_sim_get_def(handle_, &def));
    return def;
  }
  void configure(const crumble_sim_def& def) { check(crumble_sim_configure(handle_, &def)); }
  std::uint32_t add_tool(const crumble_tool_def& def) {
    std::uint32_t index = 0;
    check(crumble_sim_add_tool(handle_, &def, &index));
    return index;
  }
  void set_tool(std::uint32_t tool, const crumble_tool_def& def) { check(crumble_sim_set_tool(handle_, tool, &def)); }
  void set_friction(std::uint32_t tool, double static_friction, double dynamic_friction) {
    check(crumble_sim_set_friction(handle_, tool, static_friction, dynamic_friction));
  }
  std::uint32_t add_attachment(Span<const std::uint32_t> nodes) {
    std::uint32_t index = 0;
    check(crumble_sim_add_attachment(handle_, nodes.data(), detail::count_of(nodes), &index));
    return index;
  }
  void add_wall(const crumble_wall_def& def) { check(crumble_sim_add_wall(handle_, &def)); }
  void set_wall(std::uint32_t wall, const crumble_wall_def& def) { check(crumble_sim_set_wall(handle_, wall, &def)); }
  void fix_nodes(Span<const std::uint32_t> nodes) {
    check(crumble_sim_fix_nodes(handle_, nodes.data(), detail::count_of(nodes)));
  }
  void fix_below(double height) { check(crumble_sim_fix_below(handle_, height)); }
  void fix_box(const double (&low)[3], const double (&high)[3]) { check(crumble_sim_fix_box(handle_, low, high)); }
  void fix_plane(const double (&normal)[3], double offset) { check(crumble_sim_fix_plane(handle_, normal, offset)); }
  void apply_paper_preset() { check(crumble_sim_apply_paper_preset(handle_)); }

  // Stepping. No memory but for the text of an error that is thrown.
  crumble_wrench step(const crumble_pose& pose) {
    crumble_wrench wrench;
    check(crumble_sim_step(handle_, &pose, &wrench));
    return wrench;
  }
  crumble_result try_step(const crumble_pose& pose, crumble_wrench& wrench) noexcept {
    return crumble_sim_step(handle_, &pose, &wrench);
  }
  void step_tools(Span<const crumble_pose> poses, Span<crumble_wrench> wrenches) {
    if (poses.size() != wrenches.size())
      fail(CRUMBLE_E_OUT_OF_RANGE, "step_tools: other numbers of poses and wrenches");
    check(crumble_sim_step_tools(handle_, poses.data(), wrenches.data(), detail::count_of(poses)));
  }
  /// Several steps within `budget` seconds of wall time (0: all of them); `mean` is the mean wrench. The first call of
  /// all places the tool at `pose`, as a step does.
  crumble_advance_info advance(const crumble_pose& pose, crumble_wrench& mean, std::uint32_t steps, double budget = 0) {
    crumble_advance_info info;
    check(try_advance(pose, mean, info, steps, budget));
    return info;
  }
  crumble_result try_advance(const crumble_pose& pose, crumble_wrench& mean, crumble_advance_info& info,
                             std::uint32_t steps, double budget = 0) noexcept {
    info = detail::sized<crumble_advance_info>();
    return crumble_sim_advance(handle_, &pose, &mean, 1, steps, budget, &info);
  }
  crumble_advance_info advance(Span<const crumble_pose> poses, Span<crumble_wrench> means, std::uint32_t steps,
                               double budget = 0) {
    if (poses.size() != means.size()) fail(CRUMBLE_E_OUT_OF_RANGE, "advance: other numbers of poses and wrenches");
    auto info = detail::sized<crumble_advance_info>();
    check(crumble_sim_advance(handle_, poses.data(), means.data(), detail::count_of(poses), steps, budget, &info));
    return info;
  }
  crumble_step_info get_step_info() const {
    auto info = detail::sized<crumble_step_info>();
    check(crumble_sim_get_step_info(handle_, &info));
    return info;
  }
  crumble_counters get_counters() const {
    auto counters = detail::sized<crumble_counters>();
    check(crumble_sim_get_counters(handle_, &counters));
    return counters;
  }
  crumble_profile get_profile() const {
    auto profile = detail::sized<crumble_profile>();
    check(crumble_sim_get_profile(handle_, &profile));
    return profile;
  }
  /// With energy_audit in the definition.
  crumble_energy get_energy() const {
    auto energy = detail::sized<crumble_energy>();
    check(crumble_sim_get_energy(handle_, &energy));
    return energy;
  }
  crumble_sim_info get_info() const {
    auto info = detail::sized<crumble_sim_info>();
    check(crumble_sim_get_info(handle_, &info));
    return info;
  }

  // Contacts, forces on nodes.
  std::size_t get_contacts(Span<crumble_contact> contacts) const {
    std::uint32_t count = 0;
    check(crumble_sim_get_contacts(handle_, contacts.data(), detail::count_of(contacts), &count));
    return count;
  }
  std::vector<crumble_contact> get_contacts() const {
    std::vector<crumble_contact> contacts(get_contacts(Span<crumble_contact>{}));
    contacts.resize(get_contacts(contacts));
    return contacts;
  }
  void get_local_model(std::uint32_t tool, crumble_local_model& model) const {
    check(crumble_sim_get_local_model(handle_, tool, &model));
  }
  double get_held_drag(std::uint32_t tool) const {
    double drag = 0;
    check(crumble_sim_get_held_drag(handle_, tool, &drag));
    return drag;
  }
  void set_node_forces(Span<const double> forces) {
    check(crumble_sim_set_node_forces(handle_, forces.data(), detail::count_of(forces, 3)));
  }
  void set_node_force(std::uint32_t node, const double (&force)[3]) {
    check(crumble_sim_set_node_force(handle_, node, force));
  }

  // Fragments, surface.
  std::uint32_t count_fragments() const {
    std::uint32_t count = 0;
    check(crumble_sim_count_fragments(handle_, &count));
    return count;
  }
  void set_fragment_state(std::uint32_t fragment, std::uint32_t state) {
    check(crumble_sim_set_fragment_state(handle_, fragment, state));
  }
  std::uint32_t get_fragment_state(std::uint32_t fragment) const {
    std::uint32_t state = 0;
    check(crumble_sim_get_fragment_state(handle_, fragment, &state));
    return state;
  }
  Span<const std::uint32_t> find_debris(std::uint32_t max_nodes, double max_speed) {
    crumble_view fragments{};
    check(crumble_sim_find_debris(handle_, max_nodes, max_speed, &fragments));
    return detail::span_of<std::uint32_t>(fragments);
  }
  crumble_surface_info extract_surface() {
    auto info = detail::sized<crumble_surface_info>();
    check(crumble_sim_extract_surface(handle_, &info));
    return info;
  }
  void publish() { check(crumble_sim_publish(handle_)); }

  // State.
  void reset() { check(crumble_sim_reset(handle_)); }
  std::vector<std::uint8_t> snapshot() const {
    std::uint64_t needed = 0;
    check(crumble_sim_snapshot(handle_, nullptr, 0, &needed));
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(needed));
    check(crumble_sim_snapshot(handle_, bytes.data(), needed, &needed));
    return bytes;
  }
  void restore(Span<const std::uint8_t> snapshot) {
    check(crumble_sim_restore(handle_, snapshot.data(), snapshot.size()));
  }
  std::uint64_t state_hash() const {
    std::uint64_t hash = 0;
    check(crumble_sim_state_hash(handle_, &hash));
    return hash;
  }
  void begin_recording() { check(crumble_sim_begin_recording(handle_)); }
  void save_recording(const char* path) { check(crumble_sim_save_recording(handle_, path)); }
  void save_recording(const std::string& path) { save_recording(path.c_str()); }
  void end_recording() { check(crumble_sim_end_recording(handle_)); }
};

inline crumble_wrench local_model_evaluate(const crumble_local_model& model, const crumble_pose& pose) {
  crumble_wrench wrench;
  check(crumble_local_model_evaluate(&model, &pose, &wrench));
  return wrench;
}

struct Verified {
  std::uint64_t step_count, equal_steps;
};
inline Verified verify_recording(const std::string& path) {
  Verified verified{};
  check(crumble_verify_recording(path.c_str(), &verified.step_count, &verified.equal_steps));
  return verified;
}

class Recording : public detail::Owner<crumble_recording, crumble_recording_destroy> {
 public:
  explicit Recording(const std::string& path) { check(crumble_recording_load(path.c_str(), &handle_)); }
  explicit Recording(crumble_recording handle) noexcept : Owner(handle) {}

  crumble_recording_info get_info() const {
    auto info = detail::sized<crumble_recording_info>();
    check(crumble_recording_get_info(handle_, &info));
    return info;
  }
  /// The simulation as it was where the recording begins; it needs the recording no more.
  Sim create_sim() const {
    crumble_sim handle = nullptr;
    check(crumble_recording_create_sim(handle_, &handle));
    return Sim(handle);
  }
  /// True when `sim`, moved by step `number` from where the one before left it, is in the recorded state.
  bool step(Sim& sim, std::uint64_t number) const {
    std::uint32_t equal = 0;
    check(crumble_recording_step(handle_, sim.get(), number, &equal));
    return equal != 0;
  }
};

// ---- Readers --------------------------------------------------------------------------------------------------------

class Reader
    : public detail::ArrayOwner<crumble_reader, crumble_reader_destroy, crumble_reader_get_view, crumble_reader_copy> {
 public:
  explicit Reader(const Sim& sim) { check(crumble_reader_create(sim.get(), nullptr, &handle_)); }
  Reader(const Sim& sim, const crumble_reader_def& def) { check(crumble_reader_create(sim.get(), &def, &handle_)); }
  explicit Reader(crumble_reader handle) noexcept : ArrayOwner(handle) {}

  crumble_reader_info update() {
    auto info = detail::sized<crumble_reader_info>();
    check(crumble_reader_update(handle_, &info));
    return info;
  }
  crumble_fragment_info get_fragment(std::uint32_t fragment) const {
    auto info = detail::sized<crumble_fragment_info>();
    check(crumble_reader_get_fragment(handle_, fragment, &info));
    return info;
  }
  /// `which`: CRUMBLE_LIST_.
  Span<const std::uint32_t> get_fragment_list(std::uint32_t fragment, std::uint32_t which) const {
    crumble_view list{};
    check(crumble_reader_get_fragment_list(handle_, fragment, which, &list));
    return detail::span_of<std::uint32_t>(list);
  }
  void spread_over_skin(Span<const float> boundary, Span<float> skin) const {
    check(crumble_reader_spread_over_skin(handle_, boundary.data(), skin.data(), detail::count_of(skin, 6)));
  }
  /// Into `events`; returns how many. As many as there is room for: there may be more.
  std::size_t read_events(Span<crumble_event> events) {
    std::uint32_t count = 0;
    check(crumble_reader_read_events(handle_, events.data(), detail::count_of(events), &count));
    return count;
  }
};

// ---- Devices --------------------------------------------------------------------------------------------------------

class Device : public detail::Owner<crumble_device, crumble_device_destroy> {
 public:
  explicit Device(const crumble_device_def& def) { check(crumble_device_open(&def, &handle_)); }
  explicit Device(crumble_device handle) noexcept : Owner(handle) {}

  crumble_device_info get_info() const {
    auto info = detail::sized<crumble_device_info>();
    check(crumble_device_get_info(handle_, &info));
    return info;
  }
  const char* get_text() const {
    const char* text = nullptr;
    check(crumble_device_get_text(handle_, &text));
    return text;
  }
  void save_trajectory(const std::string& path) const { check(crumble_device_save_trajectory(handle_, path.c_str())); }
  crumble_device_sample read() {
    auto sample = detail::sized<crumble_device_sample>();
    check(crumble_device_read(handle_, &sample));
    return sample;
  }
  void write(const double (&force)[3]) { check(crumble_device_write(handle_, force, nullptr)); }
  void write(const double (&force)[3], const double (&torque)[3]) {
    check(crumble_device_write(handle_, force, torque));
  }
};

/// The number of the kind called `name`.
inline std::uint32_t device_kind(const std::string& name) {
  std::uint32_t kind = 0;
  check(crumble_device_kind(name.c_str(), &kind));
  return kind;
}
inline void trajectory_import_hapi(const std::string& log, double length_unit, const std::string& trajectory) {
  check(crumble_trajectory_import_hapi(log.c_str(), length_unit, trajectory.c_str()));
}
/// `library`: path of HDAPI, or nullptr.
inline std::vector<crumble_attached_device> device_find_attached(const char* library = nullptr) {
  std::vector<crumble_attached_device> found(16);  // more are not at one computer
  std::uint32_t count = 0;
  check(crumble_device_find_attached(library, found.data(), static_cast<std::uint32_t>(found.size()), &count));
  found.resize(count);
  return found;
}

/// The table of a device of your own, for DeviceDef::callbacks: `device`, which must outlive it, has
/// `crumble_result read(crumble_device_sample&) noexcept` and
/// `crumble_result write(const double* force, const double* torque) noexcept`.
template <class Custom>
DeviceCallbacks callbacks_of(Custom& device) {
  static_assert(
      noexcept(device.read(std::declval<crumble_device_sample&>()))&& noexcept(device.write(nullptr, nullptr)),
      "the library calls these, and no exception may pass through it");
  DeviceCallbacks table;
  table.user = &device;
  table.read = [](crumble_device_sample* sample, void* user) { return static_cast<Custom*>(user)->read(*sample); };
  table.write = [](const double* force, const double* torque, void* user) {
    return static_cast<Custom*>(user)->write(force, torque);
  };
  return table;
}

// ---- Loops ----------------------------------------------------------------------------------------------------------

/// Declare it behind its simulation and devices, so that it goes before them. Not the other way round: what a loop
/// needs refuses to be destroyed, and would stay until the program ends.
class Loop : public detail::Owner<crumble_loop, crumble_loop_destroy> {
 public:
  Loop(const Sim& sim, const crumble_loop_def& def, Span<const crumble_hand_def> hands) {
    check(crumble_loop_create(sim.get(), &def, hands.data(), detail::count_of(hands), &handle_));
  }
  Loop(const Sim& sim, const crumble_loop_def& def, const crumble_hand_def& hand)
      : Loop(sim, def, Span<const crumble_hand_def>(&hand, 1)) {}
  explicit Loop(crumble_loop handle) noexcept : Owner(handle) {}

  void start() { check(crumble_loop_start(handle_)); }
  void stop() { check(crumble_loop_stop(handle_)); }
  void tick() { check(crumble_loop_tick(handle_)); }
  crumble_result try_tick() noexcept { return crumble_loop_tick(handle_); }
  void place(std::uint32_t tool, const crumble_pose& pose) { check(crumble_loop_place(handle_, tool, &pose)); }
  std::string get_scheduling() const {
    return detail::text_from([this](char* dst, std::uint64_t bytes, std::uint64_t* needed) {
      return crumble_loop_get_scheduling(handle_, dst, bytes, needed);
    });
  }

  // From any thread, at any time.
  bool is_running() const {
    std::uint32_t running = 0;
    check(crumble_loop_is_running(handle_, &running));
    return running != 0;
  }
  crumble_loop_status get_status() const {
    auto status = detail::sized<crumble_loop_status>();
    check(crumble_loop_get_status(handle_, &status));
    return status;
  }
  crumble_hand_status get_hand(std::uint32_t hand) const {
    auto status = detail::sized<crumble_hand_status>();
    check(crumble_loop_get_hand(handle_, hand, &status));
    return status;
  }
  crumble_loop_times get_times() const {
    auto times = detail::sized<crumble_loop_times>();
    check(crumble_loop_get_times(handle_, &times));
    return times;
  }
  std::string get_warning(std::uint32_t index) const {
    return detail::text_from([this, index](char* dst, std::uint64_t bytes, std::uint64_t* needed) {
      return crumble_loop_get_warning(handle_, index, dst, bytes, needed);
    });
  }
  void configure(const crumble_sim_def& def) { check(crumble_loop_configure(handle_, &def)); }
  void set_tool(std::uint32_t tool, const crumble_tool_def& def) { check(crumble_loop_set_tool(handle_, tool, &def)); }
  void set_friction(std::uint32_t tool, double static_friction, double dynamic_friction) {
    check(crumble_loop_set_friction(handle_, tool, static_friction, dynamic_friction));
  }
  void halt() { check(crumble_loop_halt(handle_)); }
  void reset_fault(std::uint32_t hand) { check(crumble_loop_reset_fault(handle_, hand)); }
};

inline void loop_apply_paper_preset(crumble_loop_def& def, Span<crumble_hand_def> hands) {
  check(crumble_loop_apply_paper_preset(&def, hands.data(), detail::count_of(hands)));
}

}  // namespace crumble::c
