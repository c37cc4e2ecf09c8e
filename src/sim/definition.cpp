#include "crumble/sim/definition.hpp"

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"

namespace crumble {

void apply_paper_preset(SimulationDef& def) {
  def.step.tau = 2.9e-3;
  def.step.policy = TimeStepPolicy::unchecked;
  def.step.iterations = 1;
  def.step.contact_rule = ContactRule::along_motion;
  def.step.drag_frame = DragFrame::room;
  def.step.surface_samples = false;
  def.step.ball_contact = false;
  def.step.cut_test = CutTest::after_move;
  def.step.cut_fade = 0;
  def.step.mean_force = true;
  def.mass_rule = MassRule::equal;
  def.gravity = Vec3::Zero();
  constexpr Friction kPaper{3.0, 1.5};
  for (Tool& tool : def.tools) tool.friction = kPaper;
  for (Wall& wall : def.walls) wall.friction = kPaper;
}

namespace {

template <class Has>
Vector<std::uint32_t> nodes_where(const TetMesh& mesh, Has&& has) {
  Vector<std::uint32_t> nodes;
  for (std::uint32_t i = 0; i < mesh.node_count(); ++i) {
    if (has(mesh.positions[i])) nodes.push_back(i);
  }
  return nodes;
}

}  // namespace

Vector<std::uint32_t> nodes_below(const TetMesh& mesh, double height) {
  return nodes_where(mesh, [&](const Vec3& p) { return p.y() <= height; });
}

Vector<std::uint32_t> nodes_in_box(const TetMesh& mesh, const Vec3& low, const Vec3& high) {
  return nodes_where(mesh, [&](const Vec3& p) {
    return p.x() >= low.x() && p.x() <= high.x() && p.y() >= low.y() && p.y() <= high.y() && p.z() >= low.z() &&
           p.z() <= high.z();
  });
}

Vector<std::uint32_t> nodes_behind(const TetMesh& mesh, const Plane& plane) {
  return nodes_where(mesh, [&](const Vec3& p) { return dot(plane.normal, p) <= plane.offset; });
}

namespace {

constexpr std::uint32_t kDefinitionVersion = 3;  // 3: solids, offsets, attachments, drag frame, samples, balls

void put(ByteWriter& out, const Vec3& v) {
  out.put(v.x()), out.put(v.y()), out.put(v.z());
}

Vec3 get_vector(ByteReader& in) {
  const auto x = in.get<double>(), y = in.get<double>(), z = in.get<double>();
  return {x, y, z};
}

template <class E>
E get_enum(ByteReader& in, std::uint8_t last, const char* what) {
  const auto value = in.get<std::uint8_t>();
  if (value > last) throw Error(Code::corrupt, std::string("recording holds an unknown ") + what);
  return static_cast<E>(value);
}

template <std::size_t N>
void put_indices(ByteWriter& out, const Vector<std::array<std::uint32_t, N>>& rows) {
  out.put(std::span(reinterpret_cast<const std::uint32_t*>(rows.data()), rows.size() * N));
}

template <std::size_t N>
Vector<std::array<std::uint32_t, N>> get_indices(ByteReader& in) {
  const auto flat = in.get_vector<std::uint32_t>();
  Vector<std::array<std::uint32_t, N>> rows(flat.size() / N);
  for (std::size_t i = 0; i < rows.size() * N; ++i) rows[i / N][i % N] = flat[i];
  return rows;
}

void put(ByteWriter& out, const Vector<Vec3>& points) {
  out.put(static_cast<std::uint64_t>(points.size()));
  for (const Vec3& p : points) put(out, p);
}

Vector<Vec3> get_points(ByteReader& in) {
  const auto count = in.get<std::uint64_t>();
  if (count > in.left() / (3 * sizeof(double))) throw Error(Code::corrupt, "recording is truncated in its points");
  Vector<Vec3> points(static_cast<std::size_t>(count));
  for (Vec3& p : points) p = get_vector(in);
  return points;
}

void put(ByteWriter& out, const Pose& pose) {
  put(out, pose.position);
  const Quat& q = pose.orientation;
  out.put(q.w()), out.put(q.x()), out.put(q.y()), out.put(q.z());
}

Pose get_pose(ByteReader& in) {
  Pose pose;
  pose.position = get_vector(in);
  const auto w = in.get<double>(), x = in.get<double>(), y = in.get<double>(), z = in.get<double>();
  pose.orientation = Quat(w, x, y, z);
  return pose;
}

void put(ByteWriter& out, const Friction& f) {
  out.put(f.static_coefficient), out.put(f.dynamic_coefficient);
}

Friction get_friction(ByteReader& in) {
  const auto at_rest = in.get<double>();
  return {at_rest, in.get<double>()};
}

void put(ByteWriter& out, const StepSettings& s) {
  out.put(s.tau), out.put(static_cast<std::uint8_t>(s.policy)), out.put(s.iterations);
  out.put(static_cast<std::uint8_t>(s.contact_rule)), out.put(s.cut_fade),
      out.put(static_cast<std::uint8_t>(s.mean_force)), out.put(static_cast<std::uint8_t>(s.precision));
  out.put(static_cast<std::uint8_t>(s.cut_test)), out.put(static_cast<std::uint8_t>(s.drag_frame));
  out.put(static_cast<std::uint8_t>(s.surface_samples)), out.put(static_cast<std::uint8_t>(s.ball_contact));
}

void get_settings(ByteReader& in, StepSettings& s) {
  s.tau = in.get<double>();
  s.policy = get_enum<TimeStepPolicy>(in, 3, "time-step policy");
  s.iterations = in.get<std::uint32_t>();
  s.contact_rule = get_enum<ContactRule>(in, 1, "contact rule");
  s.cut_fade = in.get<double>();
  s.mean_force = in.get<std::uint8_t>() != 0;
  s.precision = get_enum<Precision>(in, 1, "precision");
  s.cut_test = get_enum<CutTest>(in, 1, "cut test");
  s.drag_frame = get_enum<DragFrame>(in, 1, "drag frame");
  s.surface_samples = in.get<std::uint8_t>() != 0;
  s.ball_contact = in.get<std::uint8_t>() != 0;
}

}  // namespace

// Energy audit, kernel and threads are left out: they change no bit of the state.
void write_definition(const SimulationDef& def, ByteWriter& out) {
  out.put(kDefinitionVersion);
  put(out, def.mesh.positions);
  put_indices(out, def.mesh.tetrahedra);
  for (const NodeKind kind : def.mesh.kinds) out.put(static_cast<std::uint8_t>(kind));
  write_settings(def, out);
}

void write_settings(const SimulationDef& def, ByteWriter& out) {
  for (const double v : {def.material.stiffness, def.material.damping_ratio, def.material.spring_damping,
                         def.material.length_limit, def.material.mass}) {
    out.put(v);
  }
  out.put(static_cast<std::uint8_t>(def.mass_rule));
  out.put(def.fixed_nodes);
  put(out, def.gravity);
  out.put(static_cast<std::uint64_t>(def.walls.size()));
  for (const Wall& wall : def.walls) put(out, wall.plane.normal), out.put(wall.plane.offset), put(out, wall.friction);
  out.put(static_cast<std::uint64_t>(def.tools.size()));
  for (const Tool& tool : def.tools) {
    tool.shape->write(out);
    put(out, tool.friction);
    put(out, tool.offset);
  }
  out.put(static_cast<std::uint64_t>(def.attachments.size()));
  for (const Attachment& attachment : def.attachments) out.put(attachment.nodes);
  put(out, def.ball_friction);
  put(out, def.step);
}

SimulationDef read_definition(ByteReader& in) {
  if (const auto version = in.get<std::uint32_t>(); version != kDefinitionVersion) {
    throw Error(Code::version, "recording has definition version " + std::to_string(version) + ", this library reads " +
                                   std::to_string(kDefinitionVersion));
  }
  SimulationDef def;
  auto positions = get_points(in);
  auto tetrahedra = get_indices<4>(in);
  Vector<NodeKind> kinds(positions.size());
  for (NodeKind& kind : kinds) kind = get_enum<NodeKind>(in, 3, "node kind");
  def.mesh = make_tet_mesh(std::move(positions), std::move(tetrahedra), std::move(kinds));
  read_settings(in, def);
  return def;
}

void read_settings(ByteReader& in, SimulationDef& def) {
  for (double* v : {&def.material.stiffness, &def.material.damping_ratio, &def.material.spring_damping,
                    &def.material.length_limit, &def.material.mass}) {
    *v = in.get<double>();
  }
  def.mass_rule = get_enum<MassRule>(in, 1, "mass rule");
  def.fixed_nodes = in.get_vector<std::uint32_t>();
  def.gravity = get_vector(in);
  def.walls.clear(), def.tools.clear(), def.attachments.clear();
  for (auto left = in.get<std::uint64_t>(); left > 0; --left) {
    const Vec3 normal = get_vector(in);
    const auto offset = in.get<double>();
    def.walls.push_back({{normal, offset}, get_friction(in)});
  }
  for (auto left = in.get<std::uint64_t>(); left > 0; --left) {
    Tool tool{read_solid(in), get_friction(in), {}};
    tool.offset = get_pose(in);
    def.tools.push_back(std::move(tool));
  }
  for (auto left = in.get<std::uint64_t>(); left > 0; --left) {
    def.attachments.push_back({in.get_vector<std::uint32_t>()});
  }
  def.ball_friction = get_friction(in);
  get_settings(in, def.step);
}

}  // namespace crumble
