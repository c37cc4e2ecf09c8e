#include <algorithm>
#include <cmath>

#include "crumble/base/error.hpp"
#include "crumble/contact/contacts.hpp"

// What contact remembers between steps, as bytes. Points, normals and friction follow from it at the next find.

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

void require(bool good, const char* what) {
  if (!good) throw Error(Code::corrupt, std::string("snapshot holds an impossible ") + what);
}

}  // namespace

void Contacts::save(ByteWriter& out) const {
  for (const Motion& m : motions_) {
    put(out, m.to.position);
    const Quat& q = m.to.orientation;
    out.put(q.w()), out.put(q.x()), out.put(q.y()), out.put(q.z());
    out.put(static_cast<std::uint8_t>(m.placed | m.engaged << 1 | m.jumped << 2));
  }
  out.put(static_cast<std::uint64_t>(constraints_.size()));
  for (std::size_t k = 0; k < constraints_.size(); ++k) {
    out.put(constraints_[k].node);
    out.put(constraints_[k].holder);
    out.put(static_cast<std::uint8_t>(constraints_[k].state));
    put(out, constraints_[k].point);
    put(out, constraints_[k].normal);
    put(out, constraints_[k].reaction);
    out.put(places_[k].face);
    put(out, places_[k].anchor);
  }
}

void Contacts::load(ByteReader& in) {
  clear();
  for (Motion& m : motions_) {
    m.to.position = get_vector(in);
    const double w = get_finite(in), x = get_finite(in), y = get_finite(in), z = get_finite(in);
    m.to.orientation = Quat(w, x, y, z);
    m.from = m.to;
    m.from_frame = m.to_frame = Frame(m.to);
    require(is_valid(m.to), "tool pose");
    const auto flags = in.get<std::uint8_t>();
    require(flags < 8, "tool state");
    m.placed = flags & 1, m.engaged = flags >> 1 & 1, m.jumped = flags >> 2 & 1;
  }
  const auto count = in.get<std::uint64_t>();
  require(count <= uses_.size(), "number of contacts");
  for (std::uint64_t k = 0; k < count; ++k) {
    NodeConstraint c;
    Place place;
    c.node = in.get<std::uint32_t>();
    c.holder = in.get<std::uint32_t>();
    const auto state = in.get<std::uint8_t>();
    c.point = get_vector(in);
    c.normal = get_vector(in);
    c.reaction = get_vector(in);
    place.face = in.get<std::uint32_t>();
    place.anchor = get_vector(in);
    require(c.node < uses_.size() && uses_[c.node] == Use::free, "contact node");
    require(c.holder == kWorldHolder || c.holder < tools_.size(), "contact holder");
    require(place.face < (c.holder == kWorldHolder ? walls_.size() : tools_[c.holder].shape.planes.size()),
            "contact face");
    require(state <= static_cast<std::uint8_t>(ContactState::slip), "contact state");
    c.state = static_cast<ContactState>(state);
    constraints_.push_back(c);
    places_.push_back(place);
    uses_[c.node] = Use::held;
  }
}

}  // namespace crumble
