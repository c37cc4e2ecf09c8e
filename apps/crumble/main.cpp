#include <cstdio>
#include <new>

#include "commands.hpp"
#include "crumble/base/error.hpp"

int main(int argc, char** argv) {
  CLI::App app("Real-time destruction of soft, brittle bodies with force feedback");
  app.require_subcommand(1);
  crumble::app::add_run(app);
  crumble::app::add_mesh(app);
  crumble::app::add_replay(app);
  crumble::app::add_export(app);
  try {
    CLI11_PARSE(app, argc, argv);
  } catch (const crumble::Error& error) {
    std::fprintf(stderr, "crumble: %s\n", error.what());
    return 1;
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "crumble: out of memory\n");
    return 1;
  }
  return 0;
}
