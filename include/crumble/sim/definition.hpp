// All that a simulation is made from.
#pragma once

#include <cstdint>
#include <string>

#include "crumble/base/bytes.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/contact/tool.hpp"
#include "crumble/network/coefficients.hpp"
#include "crumble/network/solver.hpp"
#include "crumble/network/spring_network.hpp"
#include "crumble/tetmesh/tet_mesh.hpp"

namespace crumble {

/// Where a spring is found to be too long (Eq 8).
enum class CutTest : std::uint8_t {
  with_forces = 0,  // where the next step's forces are worked out, after the tool has pressed: costs nothing
  after_move =
      1,  // on the new positions, as in the paper: costs another pass over the springs, without SIMD or threads
};

/// What the drag of Eq (1) brakes a node against.
enum class DragFrame : std::uint8_t {
  fragment = 0,  // the rigid motion of its fragment, so that loose pieces fall and tumble; the room where it is fixed
  room = 1,      // the room: the paper's way
};

/// How one step is done.
struct StepSettings {
  double tau = 1e-3;  // seconds that a step (paper: an iteration) advances; (0, 0.01]
  TimeStepPolicy policy = TimeStepPolicy::guard;
  std::uint32_t iterations = 1;  // of Eqs (3) and (4) per step, each advancing tau; above 1 only unchecked
  ContactRule contact_rule = ContactRule::nearest_surface;
  CutTest cut_test = CutTest::with_forces;
  double cut_fade = 4e-3;  // seconds in which a cut spring's force goes to 0, in equal steps; [0, 1]
  DragFrame drag_frame = DragFrame::fragment;
  bool surface_samples = true;  // thin tools meet the surface between nodes too
  bool ball_contact = true;     // fragments and the lips of cracks touch each other
  bool mean_force = false;      // Eq (7): report the mean of the last five forces
  Precision precision = Precision::float64;
  // These change no bit of the result:
  bool energy_audit = false;  // keep the ledger; costs four passes over the springs
  std::string kernel;         // one of kernel_names(); empty: $CRUMBLE_KERNEL, else the fastest here
  std::uint32_t threads = 1;  // that share a step, when the body is large enough; [1, 64]
  ParallelFor host_threads;   // to share it instead, when set
};

/// Metres, kilograms, seconds, newtons; right-handed, +Y up.
struct SimulationDef {
  TetMesh mesh;
  Material material;
  MassRule mass_rule = MassRule::lumped;
  Vector<std::uint32_t> fixed_nodes;
  Vec3 gravity{0, -9.81, 0};                     // m/s^2
  Vector<Wall> walls{{{Vec3::UnitY(), 0}, {}}};  // a smooth floor at y = 0
  Vector<Tool> tools;
  Vector<Attachment> attachments;    // moved like tools: their poses stand behind those of the tools
  Friction ball_friction{0.5, 0.5};  // between fragments
  StepSettings step;
};

/// The paper's choices where it makes one: along-motion contact by nodes alone, drag against the room, equal masses,
/// tau = 2.9 ms unchecked, one iteration, cuts after the move and without fading, Eq (7)'s mean, friction 3.0 / 1.5 on
/// every tool and wall, no gravity. Body, fixed nodes and material stay.
void apply_paper_preset(SimulationDef& def);

/// Nodes whose rest position has y <= height, metres: what stands on the table.
Vector<std::uint32_t> nodes_below(const TetMesh& mesh, double height);
/// Nodes whose rest position lies in the box, its faces included; corners in metres.
Vector<std::uint32_t> nodes_in_box(const TetMesh& mesh, const Vec3& low, const Vec3& high);
/// Nodes whose rest position has n . x <= offset.
Vector<std::uint32_t> nodes_behind(const TetMesh& mesh, const Plane& plane);

/// The definition as bytes and back (recordings). Reading throws Error(corrupt) and whatever its parts refuse.
void write_definition(const SimulationDef& def, ByteWriter& out);
SimulationDef read_definition(ByteReader& in);
/// All but the mesh; reading keeps that of `def`, and what changes no bit.
void write_settings(const SimulationDef& def, ByteWriter& out);
void read_settings(ByteReader& in, SimulationDef& def);

}  // namespace crumble
