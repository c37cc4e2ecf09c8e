#include "output.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

#include "crumble/base/file.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/text.hpp"
#include "render/force_plot.hpp"
#include "render/mesh_file.hpp"
#include "render/offscreen_context.hpp"
#include "render/renderer.hpp"

namespace crumble::app {
namespace {

// The columns of the first tool have no number.
std::string force_table(const Experiment& experiment) {
  const std::size_t tools = experiment.scene.def.tools.size();
  std::string text = "time_s";
  for (std::size_t tool = 0; tool < tools; ++tool) {
    const std::string number = tool == 0 ? "" : std::to_string(tool + 1) + "_";
    for (const char* column : {"depth_", "fx_", "fy_", "fz_", "tx_", "ty_", "tz_"}) {
      text += std::string(",") + column + number + (*column == 'd' ? "mm" : *column == 'f' ? "n" : "nm");
    }
  }
  text += ",cuts\n";
  for (const Sample& s : experiment.samples) {
    text += to_text(s.time);
    for (const ToolSample& tool : s.tools) {
      text += ',' + to_text(1e3 * tool.depth);
      for (const Vec3& v : {tool.wrench.force, tool.wrench.torque}) {
        for (int axis = 0; axis < 3; ++axis) text += ',' + to_text(v[axis]);
      }
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

void write_plots(const Experiment& experiment, const std::filesystem::path& folder) {
  const bool over_time = !is_press(experiment.scene) || experiment.scene.motions[0].trajectory;
  for (std::size_t tool = 0; tool < experiment.scene.def.tools.size(); ++tool) {
    Vector<render::ForceSample> samples;
    for (const Sample& s : experiment.samples) {
      samples.push_back({s.time, s.tools[tool].depth, s.tools[tool].wrench.force, s.cuts});
    }
    const std::string number = tool == 0 ? "" : "_" + std::to_string(tool + 1);
    render::write_force_plot(samples, over_time ? render::PlotAxis::time : render::PlotAxis::depth,
                             experiment.scene.name + ": force on " + tool_name(experiment.scene, tool),
                             folder / ("force" + number + ".svg"));
  }
}

// One camera for all phases, so that they can be compared: around all places where there is something of the body.
render::Camera phase_camera(const Vector<Capture>& captures, double aspect) {
  Vec3 low = captures[0].body.mesh.positions[0], high = low;
  for (const Capture& capture : captures) {
    for (const Vec3& p : capture.body.mesh.positions) low = low.cwiseMin(p), high = high.cwiseMax(p);
  }
  const Vec3 size = high - low;
  low -= Vec3(0.1 * size.x(), 0, 0.1 * size.z());
  high += Vec3(0.1 * size.x(), 0.2 * size.y(), 0.1 * size.z());
  return render::fit_camera(low, high, {-0.45, -0.5, -1}, 0.4, aspect, 0.02);
}

// That of the level wall that the scene has, if any.
double floor_height(const SimulationDef& def) {
  const auto floor =
      std::ranges::find_if(def.walls, [](const Wall& wall) { return wall.plane.normal == Vec3::UnitY(); });
  return floor == def.walls.end() ? 0 : floor->plane.offset;
}

// `bare`: without the tools, which hide much of what they have broken.
void write_phases(const Experiment& experiment, const Vector<Capture>& captures, bool bare, render::Renderer& renderer,
                  const std::filesystem::path& path) {
  constexpr int kWidth = 640, kHeight = 480;
  render::Scene scene;
  scene.camera = phase_camera(captures, double{kWidth} / kHeight);
  scene.floor_height = floor_height(experiment.scene.def);
  std::array<render::Image, 4> images;
  std::array<std::string, 4> captions;
  for (std::size_t i = 0; i < 4; ++i) {
    const Capture& capture = captures[i];
    scene.meshes = {capture.body.mesh};
    const Vector<Tool>& tools = experiment.scene.def.tools;
    for (std::size_t t = 0; t < tools.size() && !bare; ++t)
      scene.meshes.push_back(tool_mesh(tools[t], capture.tools[t]));
    images[i] = renderer.draw(scene, kWidth, kHeight);
    const Sample& sample = experiment.samples[capture.step];
    char text[80];
    std::snprintf(text, sizeof text, "t = %.2f s, ", sample.time);
    captions[i] = text;
    std::snprintf(text, sizeof text, "depth %.1f mm, ", 1e3 * sample.tools[0].depth);
    if (is_press(experiment.scene)) captions[i] += text;
    captions[i] += std::to_string(sample.cuts) + " cuts";
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
  write_plots(experiment, place);
  render::OffscreenContext context;
  render::Renderer renderer;
  write_phases(experiment, again.captures, false, renderer, place / "phases.png");
  write_phases(experiment, again.captures, true, renderer, place / "phases_bare.png");
  folder.commit();
}

}  // namespace crumble::app
