// Triangles in a tree of boxes: which is nearest, where a ray leaves, which lie in a box.
//
// The tree lies in one array, the children of a node side by side, and is built by halving the triangles at the median
// of their centres along the longest edge of the node's box, so that it is never deeper than log2 of their number.
// Queries keep their open nodes in an array on the stack. What they answer does not depend on the order in which the
// boxes are opened: of triangles at the same distance the one with the least number wins, and boxes are left closed
// only if they are farther than the best by more than what rounding can do.
#pragma once

#include <limits>

#include "crumble/base/memory.hpp"
#include "crumble/geometry/triangle_mesh.hpp"

namespace crumble {

class TriangleTree {
 public:
  explicit TriangleTree(const TriangleMesh& mesh);

  struct Nearest {
    Vec3 point = Vec3::Zero();
    double squared_distance = std::numeric_limits<double>::infinity();  // infinite: none within reach
    std::uint32_t triangle = 0;                                         // of the mesh
    std::uint32_t slot = 0;                                             // where it stands in the tree
    TriangleFeature feature = TriangleFeature::face;
  };
  /// Of the triangles no farther than `reach` metres. `slot`: that of a triangle likely to be near, or any number.
  Nearest nearest(const Vec3& p, double reach, std::uint32_t slot) const noexcept;

  struct Exit {
    double way = std::numeric_limits<double>::infinity();  // metres; infinite: none
    std::uint32_t triangle = 0;
  };
  /// First triangle that the ray from p along the unit vector `direction` passes from behind.
  Exit first_exit(const Vec3& p, const Vec3& direction) const noexcept;

  /// Numbers of the triangles whose boxes meet that of `triangle` and that come after it, ascending.
  void find_later_neighbours(const Triangle& corners, std::uint32_t triangle, const TriangleMesh& mesh,
                             Vector<std::uint32_t>& found) const;

 private:
  static constexpr std::uint32_t kLeafSize = 4;
  static constexpr std::size_t kMaxOpen = 64;  // twice the depth for 2^31 triangles

  struct Box {
    Vec3 low, high;
  };
  struct Node {
    Box box;
    std::uint32_t first;  // child, the other one follows; of a leaf its first slot
    std::uint32_t count;  // of triangles; 0: not a leaf
  };
  struct Corners {
    Vec3 a, b, c;
  };

  void build(std::uint32_t node, std::uint32_t first, std::uint32_t end, const Vector<Box>& boxes);
  void consider(const Vec3& p, std::uint32_t slot, Nearest& best) const noexcept;
  static double squared_distance(const Box& box, const Vec3& p) noexcept;
  bool meets(const Box& box, const Vec3& p, const Vec3& direction, double way) const noexcept;

  Vector<Node> nodes_;
  Vector<Corners> corners_;          // by slot
  Vector<std::uint32_t> triangles_;  // by slot
  double size_ = 0;                  // greatest coordinate
};

}  // namespace crumble
