// The bubbles of one body while they look for their places.
#pragma once

#include <cstddef>

#include "crumble/base/memory.hpp"
#include "crumble/base/vec.hpp"
#include "crumble/tetmesh/tet_mesh.hpp"

namespace crumble {

/// Three groups in this order: features (corners, then creases), surface, inside. Features never move.
struct Cloud {
  Vector<Vec3> positions;  // metres
  Vector<NodeKind> kinds;
  Vector<Vec3> normals;  // outward unit vector at surface nodes, zero elsewhere
  std::size_t feature_count = 0;
  std::size_t surface_count = 0;  // features + surface

  std::size_t size() const { return positions.size(); }
  void add(const Vec3& position, NodeKind kind, const Vec3& normal = Vec3::Zero()) {
    positions.push_back(position);
    kinds.push_back(kind);
    normals.push_back(normal);
    if (kind <= NodeKind::crease) ++feature_count;
    if (kind <= NodeKind::surface) ++surface_count;
  }
  /// Keeps the nodes with keep[i], in their order.
  void select(const Vector<char>& keep) {
    Cloud kept;
    for (std::size_t i = 0; i < size(); ++i) {
      if (keep[i]) kept.add(positions[i], kinds[i], normals[i]);
    }
    *this = std::move(kept);
  }
};

}  // namespace crumble
