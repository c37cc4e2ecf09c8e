// Close-packed lattices: hexagonal layers stacked along +Y, rows along +X.
#pragma once

#include <cmath>
#include <cstdint>

#include "crumble/bubblemesh/generate.hpp"

namespace crumble {

/// Point (place, row, layer) lies at
///   x = place + ((row + m) mod 2) / 2,  z = sqrt(3)/2 (row + m/3),  y = sqrt(2/3) layer
/// from the origin, in units of the spacing, where m = layer mod 2 (HCP) or layer mod 3 (FCC) is the layer's letter.
class LatticeFrame {
 public:
  LatticeFrame(Lattice kind, const Vec3& origin, double spacing)
      : origin_(origin), spacing_(spacing), period_(kind == Lattice::hcp ? 2 : 3) {}

  double spacing() const { return spacing_; }
  double row_height() const { return spacing_ * std::sqrt(0.75); }
  double layer_height() const { return spacing_ * std::sqrt(2.0 / 3.0); }

  Vec3 point(std::int64_t place, std::int64_t row, std::int64_t layer) const {
    const std::int64_t letter = letter_of(layer);
    return {origin_.x() + spacing_ * (static_cast<double>(place) + 0.5 * static_cast<double>((row + letter) & 1)),
            origin_.y() + layer_height() * static_cast<double>(layer),
            origin_.z() + row_height() * (static_cast<double>(row) + static_cast<double>(letter) / 3)};
  }
  std::int64_t nearest_layer(const Vec3& p) const { return rounded((p.y() - origin_.y()) / layer_height()); }
  std::int64_t nearest_row(const Vec3& p, std::int64_t layer) const {
    return rounded((p.z() - origin_.z()) / row_height() - static_cast<double>(letter_of(layer)) / 3);
  }
  std::int64_t nearest_place(const Vec3& p, std::int64_t row, std::int64_t layer) const {
    return rounded((p.x() - point(0, row, layer).x()) / spacing_);
  }
  /// Whether lattice points this far apart are nearest neighbours, or the ends of an octahedron's diagonal across the
  /// rows (sqrt 2 d long, from layer to layer), along which all perfect octahedra are cut.
  bool is_neighbour_step(const Vec3& step) const {
    constexpr double kTolerance = 1e-3;
    const double squares = squared_norm(step) / (spacing_ * spacing_);
    if (std::abs(squares - 1) < kTolerance) return true;
    const bool across = std::abs(step.x()) < kTolerance * spacing_ && std::abs(step.y()) > kTolerance * spacing_;
    return across && std::abs(squares - 2) < kTolerance;
  }

  /// visit(point) for every lattice point in the box, by layer, row, place.
  template <class Visit>
  void for_each_in(const Vec3& lower, const Vec3& upper, Visit visit) const {
    const std::int64_t top = rounded_down((upper.y() - origin_.y()) / layer_height());
    for (std::int64_t layer = -rounded_down((origin_.y() - lower.y()) / layer_height()); layer <= top; ++layer) {
      const double shift = static_cast<double>(letter_of(layer)) / 3;
      const std::int64_t last = rounded_down((upper.z() - origin_.z()) / row_height() - shift);
      for (std::int64_t row = -rounded_down((origin_.z() - lower.z()) / row_height() + shift); row <= last; ++row) {
        const double half = 0.5 * static_cast<double>((row + letter_of(layer)) & 1);
        const std::int64_t end = rounded_down((upper.x() - origin_.x()) / spacing_ - half);
        for (std::int64_t place = -rounded_down((origin_.x() - lower.x()) / spacing_ + half); place <= end; ++place) {
          visit(point(place, row, layer));
        }
      }
    }
  }

 private:
  std::int64_t letter_of(std::int64_t layer) const { return ((layer % period_) + period_) % period_; }
  static std::int64_t rounded_down(double x) { return static_cast<std::int64_t>(std::floor(x)); }
  static std::int64_t rounded(double x) { return rounded_down(x + 0.5); }

  Vec3 origin_;
  double spacing_;
  std::int64_t period_;
};

}  // namespace crumble
