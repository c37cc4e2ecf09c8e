#include "frames/frames.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/text.hpp"

namespace crumble::frames {
namespace {

// Bounds. Connections and holes must be perfect; so must the view while no tetrahedron is inside out: no back face is
// ever the nearest. Crushed matter does turn inside out, since the network does not mind, and shows some. The other
// bounds stand between the worst of the paper's bodies, in the modes `cracks` and `paper`, and what the same bodies
// show when a crack opens at once:
//                                       cube    slab    globe   touch       at once, from the best body to the worst
constexpr double kMaxSoundBacks = 0;  // 0       0       0       0           0
constexpr double kMaxBacks = 0.08;    // 0.024   0.068   0.008   0.045       the same
constexpr double kMaxFlicker = 20;    // 0       0       0       14          0 .. 82
constexpr double kMaxOpening = 0.5;   // 0.22    0.15    0.42    0.34        0.49 .. 1.80
constexpr double kMaxMotion = 0.9;    // 0.51    0.44    0.51    0.72        0.53 .. 1.15

constexpr std::array<std::array<double, 3>, 3> kDirections{{{0.45, 0.5, 1}, {-1, 0.25, 0.35}, {0.1, 1, 0.2}}};

double mean_spring(const TetMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b] : mesh.springs) sum += norm(mesh.positions[b] - mesh.positions[a]);
  return sum / static_cast<double>(mesh.springs.size());
}

// Cameras about the body at rest with room for what falls off.
Vector<ParallelCamera> make_cameras(const TetMesh& mesh, int size) {
  Vec3 low = mesh.positions[0], high = low;
  for (const Vec3& p : mesh.positions) low = low.cwiseMin(p), high = high.cwiseMax(p);
  Vector<ParallelCamera> cameras;
  for (const auto& [x, y, z] : kDirections) {
    cameras.push_back(make_camera({x, y, z}, 0.5 * (low + high), 0.65 * norm(high - low), size));
  }
  return cameras;
}

// Weights of the corners of a triangle for a point in its plane.
Vec3 weights_in(const std::array<Vec3, 3>& corners, const Vec3& point) {
  const auto& [a, b, c] = corners;
  const Vec3 area = cross(b - a, c - a);
  const auto part = [&](const Vec3& from, const Vec3& to) {
    return dot(cross(to - from, point - from), area) / squared_norm(area);
  };
  return {part(b, c), part(c, a), part(a, b)};
}

class Viewer {
 public:
  Viewer(const Simulation& sim, const Options& options)
      : sim_(sim),
        options_(options),
        surface_(sim.mesh(), options.surface),
        pops_(sim.mesh()),
        spring_(mean_spring(sim.mesh())) {
    for (const ParallelCamera& camera : make_cameras(sim.mesh(), options.size)) pictures_.emplace_back(camera);
  }

  void look(bool is_last) {
    const double time = sim_.info().time;
    surface_.update({sim_.positions(), sim_.intact(), sim_.node_fragments(), time});
    if (report_.frames % options_.check_every == 0 || is_last) {
      const SurfaceDefects defects =
          find_surface_defects({{surface_.rest_positions().begin(), surface_.rest_positions().end()},
                                {surface_.triangles().begin(), surface_.triangles().end()}});
      report_.defects += options_.surface.mode == SurfaceMode::paper ? defects.open_edges : defects.total();
    }
    const VecView x = sim_.positions();
    std::size_t inverted = 0;
    for (const auto& [a, b, c, d] : sim_.mesh().tetrahedra) inverted += orient(x[a], x[b], x[c], x[d]) < 0;
    for (std::size_t i = 0; i < pictures_.size(); ++i) {
      Silhouette& picture = pictures_[i];
      picture.draw(surface_.positions(), surface_.triangles());
      const auto covered = static_cast<double>(picture.covered_count());
      report_.hole_pixels += picture.hole_count();
      report_.backs.see(static_cast<double>(picture.back_count()) / covered, time);
      if (inverted == 0) report_.sound_backs.see(static_cast<double>(picture.back_count()) / covered, time);
      report_.flicker.see(static_cast<double>(flicker_[i].add(picture)), time);
    }
    const PopMeter::Pops pops = pops_.add(surface_, sim_.positions());
    report_.opening.see(pops.opening / spring_, time);
    report_.motion.see(pops.motion / spring_, time);
    ++report_.frames;
  }

  Report report() const {
    Report report = report_;
    report.cuts = sim_.counters().cuts;
    return report;
  }

 private:
  const Simulation& sim_;
  Options options_;
  SurfaceExtractor surface_;
  Vector<Silhouette> pictures_;
  std::array<FlickerCounter, kDirections.size()> flicker_;
  PopMeter pops_;
  double spring_;
  Report report_;
};

}  // namespace

std::size_t FlickerCounter::add(const Silhouette& picture) {
  const int size = picture.size();
  Vector<std::uint8_t> now(static_cast<std::size_t>(size) * size);
  const auto at = [&](int x, int y) { return static_cast<std::size_t>(y) * size + x; };
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) now[at(x, y)] = picture.covered(x, y);
  }
  const auto is_even = [&](const Vector<std::uint8_t>& frame, int x, int y) {
    for (int v = y - 1; v <= y + 1; ++v) {
      for (int u = x - 1; u <= x + 1; ++u) {
        if (frame[at(u, v)] != frame[at(x, y)]) return false;
      }
    }
    return true;
  };
  std::size_t count = 0;
  for (int y = 1; !before_.empty() && y + 1 < size; ++y) {
    for (int x = 1; x + 1 < size; ++x) {
      const bool flickers = before_[at(x, y)] == now[at(x, y)] && last_[at(x, y)] != now[at(x, y)];
      if (flickers && is_even(before_, x, y) && is_even(now, x, y)) ++count;
    }
  }
  before_ = std::move(last_);
  last_ = std::move(now);
  return count;
}

double PopMeter::way_of(const Vec3& rest, const Vec3& place, const Vector<Part>& parts) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Part& part : parts) {
    const Vec3 weights = weights_in(part.rest, rest);
    if (weights.minCoeff() < -1e-6) continue;
    const Vec3 before = weights[0] * part.place[0] + weights[1] * part.place[1] + weights[2] * part.place[2];
    nearest = std::min(nearest, norm(place - before));
  }
  return nearest;
}

PopMeter::Pops PopMeter::add(const SurfaceExtractor& surface, VecView nodes) {
  Vector<Vector<Part>> parts(mesh_->boundary.size());
  for (std::size_t t = 0; t < surface.skin_triangle_count(); ++t) {
    Part& part = parts[surface.skin_sources()[t]].emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      part.rest[k] = surface.rest_positions()[surface.triangles()[t][k]];
      part.place[k] = surface.positions()[surface.triangles()[t][k]];
    }
  }
  Pops pops;
  for (std::size_t face = 0; face < parts.size() && !nodes_.empty(); ++face) {
    double node_way = 0;
    for (const std::uint32_t node : mesh_->boundary[face]) {
      node_way = std::max(node_way, norm(nodes[node] - nodes_[node]));
    }
    double& greatest = parts[face].size() == parts_[face].size() ? pops.motion : pops.opening;
    for (const Part& part : parts[face]) {
      for (std::size_t k = 0; k < 3; ++k) {
        greatest = std::max(greatest, way_of(part.rest[k], part.place[k], parts_[face]) - node_way);
      }
    }
  }
  parts_ = std::move(parts);
  nodes_.resize(mesh_->node_count());
  for (std::size_t i = 0; i < nodes_.size(); ++i) nodes_[i] = nodes[i];
  return pops;
}

Report watch(const Scene& scene, const Options& options) {
  const double tick = scene.tick();
  MotionDevice motion = open_motion(scene.motions[0], tick);
  const auto steps = static_cast<std::size_t>(motion.seconds / tick + 1.5);
  Simulation sim(scene.def);
  Viewer viewer(sim, options);
  double due = 0;
  DeviceSample sample;
  for (std::size_t step = 0; step < steps; ++step) {
    motion.device->read(sample);
    const Pose pose = motion.workspace.to_scene(sample.pose);
    const StepInfo& info = sim.step({&pose, 1});
    if (info.status != Code{}) throw Error(info.status, scene.name + " failed at step " + std::to_string(step));
    const bool is_last = step + 1 == steps;
    if (info.time < due && !is_last) continue;
    due += kFramePeriod;
    viewer.look(is_last);
  }
  return viewer.report();
}

std::string complaint(const Report& report) {
  std::string text;
  const auto check = [&](const char* what, double value, double bound) {
    if (value > bound) text += (text.empty() ? "" : ", ") + std::string(what) + " above " + to_text(bound);
  };
  check("defects", static_cast<double>(report.defects), 0);
  check("holes", static_cast<double>(report.hole_pixels), 0);
  check("sound", report.sound_backs.value, kMaxSoundBacks);
  check("backs", report.backs.value, kMaxBacks);
  check("flicker", report.flicker.value, kMaxFlicker);
  check("opening", report.opening.value, kMaxOpening);
  check("motion", report.motion.value, kMaxMotion);
  return text;
}

}  // namespace crumble::frames
