#include "output.hpp"

#include <array>
#include <cstdio>

#include "crumble/base/file.hpp"
#include "crumble/base/text.hpp"
#include "render/force_plot.hpp"
#include "render/mesh_file.hpp"
#include "render/offscreen_context.hpp"
#include "render/renderer.hpp"

namespace crumble::app {
namespace {

std::string force_table(const Experiment& experiment) {
  std::string text = "time_s,depth_mm,fx_n,fy_n,fz_n,tx_nm,ty_nm,tz_nm,cuts\n";
  for (const Sample& s : experiment.samples) {
    text += to_text(s.time) + ',' + to_text(1e3 * s.depth);
    for (const Vec3& v : {s.wrench.force, s.wrench.torque}) {
      for (int axis = 0; axis < 3; ++axis) text += ',' + to_text(v[axis]);
    }
    text += ',' + std::to_string(s.cuts) + '\n';
  }
  return text;
}

const char* name_of(EventKind kind) {
  switch (kind) {
    case EventKind::cut:
      return "cut";
    case EventKind::split:
      return "split";
    case EventKind::contact_begin:
      return "contact_begin";
    default:
      return "contact_end";
  }
}

// What does not apply is empty.
std::string event_table(const Experiment& experiment) {
  std::string text = "time_s,step,kind,spring,node,holder,fragment,parent,x_m,y_m,z_m,energy_j\n";
  for (const Event& event : experiment.events) {
    text += to_text(event.time) + ',' + std::to_string(event.step) + ',' + name_of(event.kind);
    for (const std::uint32_t index : {event.spring, event.node, event.holder, event.fragment, event.parent}) {
      text += index == Event::kNone ? "," : ',' + std::to_string(index);
    }
    for (int axis = 0; axis < 3; ++axis) text += ',' + to_text(event.place[axis]);
    text += ',' + to_text(event.energy) + '\n';
  }
  return text;
}

void write_plot(const Experiment& experiment, const std::filesystem::path& path) {
  std::vector<render::ForceSample> samples;
  for (const Sample& s : experiment.samples) samples.push_back({s.time, s.depth, s.wrench.force, s.cuts});
  const auto axis = experiment.scene.trajectory ? render::PlotAxis::time : render::PlotAxis::depth;
  render::write_force_plot(samples, axis, experiment.scene.name + ": force on the stick", path);
}

// One camera for all phases, so that they can be compared.
render::Camera phase_camera(const Experiment& experiment, double aspect) {
  Vec3 low = experiment.scene.def.mesh.positions[0], high = low;
  for (const Vec3& p : experiment.scene.def.mesh.positions) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const Vec3 size = high - low;
  low -= Vec3(0.1 * size.x(), 0, 0.1 * size.z());
  high += Vec3(0.1 * size.x(), 0.2 * size.y(), 0.1 * size.z());
  return render::fit_camera(low, high, {-0.45, -0.5, -1}, 0.4, aspect, 0.02);
}

// `bare`: without the tool, which hides much of what it has broken.
void write_phases(const Experiment& experiment, const std::vector<Capture>& captures, bool bare,
                  render::Renderer& renderer, const std::filesystem::path& path) {
  constexpr int kWidth = 640, kHeight = 480;
  render::Scene scene;
  scene.camera = phase_camera(experiment, double{kWidth} / kHeight);
  std::array<render::Image, 4> images;
  std::array<std::string, 4> captions;
  for (std::size_t i = 0; i < 4; ++i) {
    const Capture& capture = captures[i];
    scene.meshes = {capture.body.mesh};
    if (!bare) scene.meshes.push_back(tool_mesh(experiment.scene.def.tools[0].shape, capture.tool));
    images[i] = renderer.draw(scene, kWidth, kHeight);
    const Sample& sample = experiment.samples[capture.step];
    char text[80];
    std::snprintf(text, sizeof text, "t = %.2f s, depth %.1f mm, %llu cuts", sample.time, 1e3 * sample.depth,
                  static_cast<unsigned long long>(sample.cuts));
    captions[i] = text;
  }
  render::write_png(render::tile_phases(images, captions), path);
}

}  // namespace

void require_extension(const std::filesystem::path& path, const std::string& extensions) {
  if (!path.has_extension() || (extensions + " ").find(path.extension().string() + " ") == std::string::npos) {
    throw Error(Code::unsupported, "--out '" + path.string() + "' must end in one of " + extensions);
  }
}

void write_outputs(const Experiment& experiment, const Rerun& again, OutputFolder& folder) {
  const std::filesystem::path& place = folder.temporary();
  write_text(place / "force.csv", force_table(experiment));
  write_text(place / "events.csv", event_table(experiment));
  experiment.recording.save(place / "experiment.crec");
  for (std::size_t i = 0; i < again.captures.size(); ++i) {
    render::write_mesh_file(again.captures[i].body, place / ("surface_" + std::to_string(i) + ".ply"));
  }
  write_plot(experiment, place / "force.svg");
  render::OffscreenContext context;
  render::Renderer renderer;
  write_phases(experiment, again.captures, false, renderer, place / "phases.png");
  write_phases(experiment, again.captures, true, renderer, place / "phases_bare.png");
  folder.commit();
}

}  // namespace crumble::app
