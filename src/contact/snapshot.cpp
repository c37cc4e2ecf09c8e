#include <algorithm>
#include <cmath>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/contact/contacts.hpp"

// What contact remembers between steps, as bytes. A holder's velocity at the node follows at the next find.

namespace crumble {
namespace {

void put(ByteWriter& out, const Vec3& v) {
  out.put(v.x()), out.put(v.y()), out.put(v.z());
}

double get_finite(ByteReader& in) {
  const auto value = in.get<double>();
  if (!std::isfinite(value)) throw Error(Code::corrupt, "snapshot holds a contact that is not finite");
  return value;
}

Vec3 get_vector(ByteReader& in) {
  const double x = get_finite(in), y = get_finite(in), z = get_finite(in);
  return {x, y, z};
}

bool is_unit(const Vec3& v) {
  return std::abs(squared_norm(v) - 1) < 1e-9;
}

void require(bool good, const char* what) {
  if (!good) throw Error(Code::corrupt, std::string("snapshot holds an impossible ") + what);
}

}  // namespace

void Contacts::save(ByteWriter& out) const {
  for (const Motion& m : motions_) {
    put(out, m.to.position);
    const Quat& q = m.to.orientation;
    out.put(q.w()), out.put(q.x()), out.put(q.y()), out.put(q.z());
    out.put(static_cast<std::uint8_t>(m.placed | m.engaged << 1 | m.jumped << 2 | m.suspended << 3));
  }
  for (const Vec3& anchor : anchors_) put(out, anchor);
  surface_.save(out);
  out.put(static_cast<std::uint64_t>(constraints_.size()));
  for (std::size_t k = 0; k < constraints_.size(); ++k) {
    out.put(constraints_[k].node);
    out.put(constraints_[k].holder);
    out.put(static_cast<std::uint8_t>(constraints_[k].state));
    out.put(constraints_[k].approach);
    put(out, constraints_[k].point);
    put(out, constraints_[k].normal);
    put(out, constraints_[k].reaction);
    out.put(places_[k].wall);
    out.put(places_[k].face);
    put(out, places_[k].anchor);
    put(out, places_[k].normal);
  }
}

void Contacts::load(ByteReader& in) {
  clear();
  for (std::size_t holder = 0; holder < motions_.size(); ++holder) {
    Motion& m = motions_[holder];
    m.to.position = get_vector(in);
    const double w = get_finite(in), x = get_finite(in), y = get_finite(in), z = get_finite(in);
    m.to.orientation = Quat(w, x, y, z);
    require(is_valid(m.to), "tool pose");
    m.from = m.to;
    m.from_frame = m.to_frame = frame_of(holder, m.to);
    const auto flags = in.get<std::uint8_t>();
    require(flags < 8, "tool state");
    m.placed = flags & 1, m.engaged = flags >> 1 & 1, m.jumped = flags >> 2 & 1, m.suspended = flags >> 3 & 1;
  }
  for (Vec3& anchor : anchors_) anchor = get_vector(in);
  surface_.load(in);
  const auto count = in.get<std::uint64_t>();
  require(count <= uses_.size(), "number of contacts");
  for (std::uint64_t k = 0; k < count; ++k) load_contact(in);
}

void Contacts::load_contact(ByteReader& in) {
  NodeConstraint c;
  Place place;
  c.node = in.get<std::uint32_t>();
  c.holder = in.get<std::uint32_t>();
  const auto state = in.get<std::uint8_t>();
  c.approach = get_finite(in);
  c.point = get_vector(in);
  c.normal = get_vector(in);
  c.reaction = get_vector(in);
  place.wall = in.get<std::uint32_t>();
  place.face = in.get<std::uint32_t>();
  place.anchor = get_vector(in);
  place.normal = get_vector(in);
  c.state = static_cast<ContactState>(state);
  require(state <= static_cast<std::uint8_t>(ContactState::slip) || c.state == ContactState::attached, "contact state");
  const bool attached = c.state == ContactState::attached;
  require(c.node < uses_.size() && uses_[c.node] == (attached ? Use::attached : Use::free), "contact node");
  if (attached) {
    require(c.holder >= tools_.size() && c.holder < motions_.size(), "holder of an attached node");
    const Vector<std::uint32_t>& nodes = attachments_[c.holder - tools_.size()].nodes;
    require(std::find(nodes.begin(), nodes.end(), c.node) != nodes.end(), "holder of an attached node");
    const auto same = [&](const NodeConstraint& other) { return other.node == c.node; };
    require(std::none_of(constraints_.begin(), constraints_.end(), same), "attached node: it stands there twice");
  } else {
    require(c.holder == kWorldHolder || c.holder < tools_.size(), "contact holder");
  }
  require(c.holder != kWorldHolder || place.wall < walls_.size(), "wall");
  require(place.face == kNoFace || place.face < surface_.face_count(), "face");
  for (const Vec3& normal : {c.normal, place.normal}) require(attached || is_unit(normal), "normal of a contact");
  take_friction(c, place);
  add(c, place);
}

}  // namespace crumble
