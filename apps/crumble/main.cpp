#include <cstdio>
#include <new>

#include "commands.hpp"
#include "crumble/base/error.hpp"
#include "crumble/device/open.hpp"
#include "crumble/network/solver.hpp"
#include "scenes/scene.hpp"

namespace {

std::string version_text() {
  std::string text = "crumble " CRUMBLE_VERSION ", built by " CRUMBLE_COMPILER "\nprecision: float64 float32\nkernels:";
  for (const std::string& name : crumble::kernel_names()) text += " " + name;
  text += "\nthreads: 1 to 64\ndevices:";
  for (const crumble::DeviceKind kind : crumble::available_devices()) text += std::string(" ") + to_string(kind);
  text += "\nscenes:";
  for (const std::string& name : crumble::scene_names()) text += " " + name;
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Real-time destruction of soft, brittle bodies with force feedback");
  app.require_subcommand(1);
  app.set_version_flag("--version", version_text);
  crumble::app::add_run(app);
  crumble::app::add_mesh(app);
  crumble::app::add_replay(app);
  crumble::app::add_export(app);
  crumble::app::add_bench(app);
  crumble::app::add_patterns(app);
  crumble::app::add_loop(app);
  crumble::app::add_zwidth(app);
  crumble::app::add_devices(app);
  crumble::app::add_device_check(app);
  crumble::app::add_record(app);
  crumble::app::add_import(app);
  try {
    CLI11_PARSE(app, argc, argv);
  } catch (const crumble::Error& error) {
    std::fprintf(stderr, "crumble: %s\n", error.what());
    return 1;
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "crumble: out of memory\n");
    return 1;
  } catch (const std::exception& error) {  // of the standard library: a file system that answers strangely
    std::fprintf(stderr, "crumble: %s\n", error.what());
    return 1;
  }
  if (std::fflush(stdout) != 0 || std::ferror(stdout)) {
    std::fprintf(stderr, "crumble: cannot write the output\n");
    return 1;
  }
  return 0;
}
