#include <algorithm>
#include <cmath>

#include "crumble/base/memory.hpp"
#include "crumble/contact/contacts.hpp"

// Nodes that a frame holds for good.

namespace crumble {

std::span<Vec3> Contacts::anchors(std::size_t attachment) noexcept {
  std::size_t first = 0;
  for (std::size_t a = 0; a < attachment; ++a) first += attachments_[a].nodes.size();
  return std::span(anchors_).subspan(first, attachments_[attachment].nodes.size());
}

// A hand that was put elsewhere must not tear the body to pieces: the nodes stay and are taken hold of anew.
void Contacts::move_attachment(std::size_t holder) noexcept {
  Motion& m = motions_[holder];
  m.travel = 0;
  if (m.engaged) {
    for (const Vec3& anchor : anchors(holder - tools_.size())) {
      m.travel = std::max(m.travel, norm(m.to_frame.to_scene(anchor) - m.from_frame.to_scene(anchor)));
    }
  }
  m.jumped = m.travel > kMaxAttachedSpeed * m.tau;
  if (m.jumped) m.from = m.to, m.from_frame = m.to_frame, m.travel = 0, m.engaged = false;
}

void Contacts::find_attached(std::size_t attachment, const NodeSource& nodes) noexcept {
  const std::size_t holder = tools_.size() + attachment;
  Motion& motion = motions_[holder];
  if (!motion.placed) return;
  const Vector<std::uint32_t>& attached = attachments_[attachment].nodes;
  const std::span<Vec3> anchors = this->anchors(attachment);
  if (!motion.engaged) {
    for (std::size_t k = 0; k < attached.size(); ++k) {
      anchors[k] = motion.to_frame.to_local(nodes.position(attached[k]));
    }
  }
  motion.engaged = true;
  for (std::size_t k = 0; k < attached.size(); ++k) {
    if (uses_[attached[k]] != Use::attached) continue;
    NodeConstraint c;
    c.node = attached[k];
    c.holder = static_cast<std::uint32_t>(holder);
    c.state = ContactState::attached;
    c.point = motion.to_frame.to_scene(anchors[k]);
    c.velocity = motion.velocity + rotate(motion.turning, anchors[k]);
    add(c, {.anchor = anchors[k]});
  }
}

}  // namespace crumble
