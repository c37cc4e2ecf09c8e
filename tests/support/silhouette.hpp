// What a parallel camera sees of a surface, worked out without OpenGL and without a pixel too many or too few.
//
// Corners are rounded to 1/256 of a pixel; from there on all is integer arithmetic, and a pixel whose middle lies on an
// edge belongs to the triangle on one side of it (the top-left rule). So a ray through a pixel crosses a closed surface
// as often inwards as outwards, exactly, however the surface is folded: any other balance is a hole.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "crumble/base/memory.hpp"
#include "crumble/geometry/triangle_mesh.hpp"

namespace crumble {

/// Looks against `towards`; `up` is the picture's upper side. Unit vectors, square to each other.
struct ParallelCamera {
  Vec3 towards = {0, 0, 1};
  Vec3 up = {0, 1, 0};
  Vec3 center = Vec3::Zero();  // metres; seen in the middle
  double pixel = 1e-4;         // metres
  int size = 256;              // pixels, both ways
};

/// A camera of `size` pixels whose picture takes in a sphere. `towards`: any length, not straight up or down.
ParallelCamera make_camera(const Vec3& towards, const Vec3& center, double radius, int size);

class Silhouette {
 public:
  explicit Silhouette(const ParallelCamera& camera);

  /// Counter-clockwise triangles are front faces.
  void draw(std::span<const Vec3> vertices, std::span<const Triangle> triangles);

  int size() const { return camera_.size; }
  bool covered(int x, int y) const { return pixels_[index(x, y)].crossings != 0; }
  std::size_t covered_count() const;
  /// Pixels whose ray enters and leaves the surface unequally often.
  std::size_t hole_count() const;
  /// Pixels where the nearest triangle shows its back: one looks into the surface.
  std::size_t back_count() const;

 private:
  struct Pixel {
    double nearest = 0;  // along `towards`; with crossings
    int crossings = 0;   // all of them
    int balance = 0;     // front minus back faces
    bool is_front = false;
  };
  struct Corner {
    std::int64_t x, y;  // 1/256 pixel
    double depth;
  };

  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * camera_.size + x; }
  void draw(Corner a, Corner b, Corner c);

  ParallelCamera camera_;
  Vec3 right_;
  Vector<Pixel> pixels_;
  Vector<Corner> corners_;
};

}  // namespace crumble
