#include <algorithm>
#include <array>
#include <cmath>

#include "contact/tool_bounds.hpp"
#include "crumble/contact/contacts.hpp"

// A tool thinner than the distance between nodes meets the faces between them.
//
// Points are spread over each open face near the tool, no farther apart than half its thickness, or that of its point
// or edge a little way up. Of those inside the tool the one counts that has the longest way out along the face's inward
// normal: the face is pressed in by that way, w_i / sum(w^2) of it for a corner with barycentric weight w_i, which
// moves the point by the whole. The corners so moved are held where they are put, off the tool's surface, with the
// inward normal as that of the contact. From then on they are contacts like others: each sticks, slips or lets go by
// its own force, and Eq (6) sums them with their own places as levers.
//
// Why along the face's normal and not to the tool's nearest surface: a needle that comes down on a face has its side
// nearer than its tip as soon as it is a radius deep, and what touches is mostly an edge or a tip of the tool and the
// flat of the face, whose common normal is that of the face (Ericson, Real-Time Collision Detection, 5.2.1, on
// separating axes). A face that is deeper in the tool than this step's motion explains was not entered from outside: it
// came to lie open round the tool, or let go of it. It is left alone, or it would leap out by the length of the tool.

namespace crumble {
namespace {

constexpr double kRounding = 1e-12;   // metres
constexpr double kLeastShare = 0.05;  // a corner of less weight than this is not held
// The corners that can be moved may be those with little weight; they go no farther than as if they had this much of
// the sum of squares.
constexpr double kLeastPart = 0.25;
constexpr double kLetBackSpeed = 0.02;  // m/s

using Weights = std::array<double, 3>;

struct FaceInTool {
  std::array<Vec3, 3> corners;  // in the tool's frame

  Vec3 at(const Weights& w) const noexcept { return (w[0] * corners[0] + w[1] * corners[1]) + w[2] * corners[2]; }
  bool reaches_into(const Vec3& box_low, const Vec3& box_high) const noexcept {
    const Vec3 low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
    const Vec3 high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
    for (int axis = 0; axis < 3; ++axis) {
      if (!(low[axis] <= box_high[axis] && high[axis] >= box_low[axis])) return false;
    }
    return true;
  }
  // Visits the samples until `visit` says to stop; whether it did.
  template <class Visit>
  bool any_sample(double spacing, Visit&& visit) const {
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, norm(corners[(k + 1) % 3] - corners[k]));
    const std::uint32_t n = SurfaceSamples::parts(longest, spacing);
    for (std::uint32_t i = 0; i <= n; ++i) {
      for (std::uint32_t j = 0; i + j <= n; ++j) {
        const Weights w{static_cast<double>(i) / n, static_cast<double>(j) / n, static_cast<double>(n - i - j) / n};
        if (visit(w)) return true;
      }
    }
    return false;
  }
};

struct Sample {
  Weights weights{};
  double depth = 0;
};

Sample deepest_sample(const SolidModel& tool, double spacing, const FaceInTool& face, const Vec3& inward) noexcept {
  Sample deepest;
  std::uint32_t hint = 0;
  face.any_sample(spacing, [&](const Weights& weights) {
    const Vec3 p = face.at(weights);
    SolidPoint nearest, out;
    if (tool.find_inside(p, hint, nearest) && tool.leave_along(p, inward, out) &&
        -out.signed_distance > deepest.depth) {
      deepest = {weights, -out.signed_distance};
    }
    return false;
  });
  return deepest;
}

}  // namespace

// Half of it: the solid's own, or that of its point or edge when this is sunk in by the distance between nodes.
double Contacts::thickness_met(const SolidModel& shape) const noexcept {
  const double of_edge = shape.edge_sine() * surface_.node_spacing();
  return of_edge > 0 ? std::min(shape.half_thickness(), of_edge) : shape.half_thickness();
}

bool Contacts::is_thin(const Tool& tool) const noexcept {
  return rule_ == ContactRule::nearest_surface && 2 * thickness_met(*tool.shape) < surface_.node_spacing();
}

Vec3 Contacts::position_of(std::uint32_t node, const NodeSource& nodes) const noexcept {
  return uses_[node] == Use::held ? constraints_[held_at_[node]].point : nodes.position(node);
}

// Whether a sample of an open face is no farther from the tool than `gap`.
bool Contacts::is_near(std::uint32_t face, std::uint32_t t, const Frame& frame, double gap,
                       const NodeSource& nodes) const noexcept {
  if (!surface_.is_open(face)) return false;
  const auto [a, b, c] = surface_.nodes_of(face);
  const FaceInTool here{
      {frame.to_local(nodes.position(a)), frame.to_local(nodes.position(b)), frame.to_local(nodes.position(c))}};
  const Vec3 grown = Vec3::Constant(gap);
  if (!here.reaches_into(bounds_[t].low - grown, bounds_[t].high + grown)) return false;
  const SolidModel& tool = *tools_[t].shape;
  return here.any_sample(thickness_met(tool),
                         [&](const Weights& w) { return tool.nearest(here.at(w), gap).signed_distance <= gap; });
}

// A corner that slides keeps its height over the tool.
void Contacts::keep_height(const Vec3& local, Place& place) noexcept {
  place.anchor = local + dot(place.anchor - local, place.normal) * place.normal;
}

// The corner of a face that has left the tool, or is torn, goes back by and by until the body pulls on it: dropped at
// once it would take its force from the hand in one step.
void Contacts::let_back(const Motion& motion, Place& place) noexcept {
  place.anchor -= (kLetBackSpeed * motion.tau / motion.places) * place.normal;
}

// Where a corner gets to may lie inside the tool; then it is held there like any node.
void Contacts::stay_outside(const Tool& tool, Place& place) noexcept {
  std::uint32_t hint = 0;
  SolidPoint nearest;
  if (tool.shape->find_inside(place.anchor, hint, nearest)) place = {.anchor = nearest.point, .normal = nearest.normal};
}

void Contacts::meet_faces(std::uint32_t t, const Frame& frame, NodeSource& nodes) noexcept {
  const Box box = box_of(*tools_[t].shape, frame);
  const Vec3 reach = Vec3::Constant(surface_.reach());
  for (const std::uint32_t face : surface_.faces_of(nodes.inside(box.low - reach, box.high + reach))) {
    press_face(face, t, frame, nodes);
  }
}

void Contacts::press_face(std::uint32_t face, std::uint32_t t, const Frame& frame, const NodeSource& nodes) noexcept {
  const SolidModel& tool = *tools_[t].shape;
  const Triangle corners = surface_.nodes_of(face);
  if (std::none_of(corners.begin(), corners.end(), [&](std::uint32_t node) { return can_press(node, t); })) return;
  FaceInTool here;
  for (std::size_t k = 0; k < 3; ++k) here.corners[k] = frame.to_local(position_of(corners[k], nodes));
  if (!here.reaches_into(bounds_[t].low, bounds_[t].high)) return;
  const Vec3 across = cross(here.corners[2] - here.corners[0], here.corners[1] - here.corners[0]);
  if (!(norm(across) > 0)) return;
  const Vec3 inward = normalized(across);
  const auto [weights, depth] = deepest_sample(tool, thickness_met(tool), here, inward);
  if (!(depth > kRounding)) return;

  const Motion& motion = motions_[t];
  Vec3 velocity = Vec3::Zero();
  double squares = 0, movable = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double square = weights[k] * weights[k];
    velocity += weights[k] * nodes.velocity(corners[k]);
    squares += square;
    if (weights[k] > kLeastShare && can_press(corners[k], t)) movable += square;
  }
  if (depth > motion.travel + norm(velocity) * motion.tau + kKeepGap) return;
  const double way = depth / std::max(movable, kLeastPart * squares);
  for (std::size_t k = 0; k < 3; ++k) {
    if (weights[k] <= kLeastShare || !can_press(corners[k], t)) continue;
    Place place{.anchor = here.corners[k] + weights[k] * way * inward, .normal = inward, .face = face};
    stay_outside(tools_[t], place);
    hold_pressed(corners[k], t, frame, place);
  }
}

// Free, or already held by this tool off its surface without sticking.
bool Contacts::can_press(std::uint32_t node, std::uint32_t t) const noexcept {
  if (uses_[node] != Use::held) return uses_[node] == Use::free || uses_[node] == Use::asleep;
  const std::uint32_t at = held_at_[node];
  return constraints_[at].holder == t && constraints_[at].state != ContactState::stick && places_[at].face != kNoFace;
}

// One that is held keeps its face and normal: under the faces round it, pressing in turn, its force would swing about.
void Contacts::hold_pressed(std::uint32_t node, std::uint32_t t, const Frame& frame, const Place& place) noexcept {
  if (uses_[node] == Use::held) {
    NodeConstraint& held = constraints_[held_at_[node]];
    Place& at = places_[held_at_[node]];
    if (place.face == kNoFace) at = place;
    at.anchor = place.anchor;
    const double approach = held.approach;
    held = on_tool(t, frame, node, held.state, at);
    held.approach = approach;
    return;
  }
  if (uses_[node] == Use::asleep) roused_.push_back(node);
  add(on_tool(t, frame, node, ContactState::fresh, place), place);
}

}  // namespace crumble
