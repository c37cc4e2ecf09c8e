// Two threads: this one steps the paper's tofu cube at 1 kHz under a stick, the other looks at it 60 times a second, as
// a program that draws does: triangles, what changed since the last picture, what broke off.
#include <atomic>
#include <chrono>
#include <crumble/bubblemesh/presets.hpp>
#include <crumble/fracture/surface.hpp>
#include <crumble/sim/publisher.hpp>
#include <cstdio>
#include <thread>

using namespace crumble;
using namespace std::chrono_literals;

namespace {

void watch(const TetMesh& mesh, StatePublisher& publisher, const std::atomic<bool>& done) {
  SurfaceExtractor surface(mesh);
  Event events[256];
  std::size_t uploaded = 0;
  for (auto next = std::chrono::steady_clock::now(); !done; std::this_thread::sleep_until(next += 16667us)) {
    const PublishedState& state = publisher.latest();
    surface.update({state.positions, state.intact, state.fragments, state.time});
    uploaded += surface.changed_triangles().size();  // here a renderer would send these, and all positions and normals
    for (std::size_t i = 0, count = publisher.read_events(events); i < count; ++i) {
      if (events[i].kind != EventKind::split) continue;
      std::printf("%.3f s: fragment %u came off fragment %u\n", events[i].time, events[i].fragment, events[i].parent);
    }
  }
  std::printf("%zu triangles, %zu of them skin; %zu were uploaded on the way\n", surface.triangles().size(),
              surface.skin_triangle_count(), uploaded);
}

}  // namespace

int main() {
  SimulationDef def;
  def.mesh = generate_paper_body(PaperBody::cube).mesh;
  def.fixed_nodes = nodes_below(def.mesh, 1e-6);
  def.material.length_limit = 1.1;  // a weaker tofu than the paper's: it falls to pieces sooner
  def.tools = {{make_round_stick(0.004, 0.05, 16), {}}};
  Simulation sim(def);
  StatePublisher publisher(sim);
  std::atomic<bool> done{false};
  std::thread watching(watch, std::cref(sim.mesh()), std::ref(publisher), std::cref(done));

  Pose pose{{0, 0.034, 0}, Quat::Identity()};
  auto next = std::chrono::steady_clock::now();
  for (int step = 0; step < 1200; ++step) {
    pose.position.y() -= 2e-5;
    sim.step({&pose, 1});
    publisher.publish(sim);
    std::this_thread::sleep_until(next += 1ms);
  }
  done = true;
  watching.join();
}
