#include <cstdio>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/device/attached.hpp"
#include "crumble/device/open.hpp"

namespace crumble::app {
namespace {

struct DevicesOptions {
  AttachedOptions attached;
  bool json = false;
};

void list_devices(const DevicesOptions& options) {
  const Vector<AttachedDevice> attached = attached_devices(options.attached);
  if (options.json) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const AttachedDevice& device : attached) {
      list.push_back({{"kind", to_string(device.kind)},
                      {"name", device.name},
                      {"can_be_opened", device.can_be_opened},
                      {"note", device.note}});
    }
    nlohmann::ordered_json kinds = nlohmann::ordered_json::array();
    for (const DeviceKind kind : available_devices()) kinds.push_back(to_string(kind));
    std::puts(nlohmann::ordered_json{{"kinds", kinds}, {"attached", list}}.dump(1).c_str());
    return;
  }
  std::string kinds;
  for (const DeviceKind kind : available_devices()) kinds += std::string(" ") + to_string(kind);
  std::printf("kinds of this build:%s\n", kinds.c_str());
  for (const AttachedDevice& device : attached) {
    std::printf("%s: %s\n  %s\n", to_string(device.kind), device.name.c_str(), device.note.c_str());
  }
  if (attached.empty()) std::puts("no hardware was found");
}

}  // namespace

void add_devices(CLI::App& app) {
  auto* command = app.add_subcommand("devices", "List the devices that are attached, and the drivers that they need");
  auto options = std::make_shared<DevicesOptions>();
  command->add_option("--library", options->attached.library, "HDAPI; else where its installer puts it");
  command->add_option("--usb", options->attached.usb, "Folder in which the system lists what is on USB")
      ->capture_default_str();
  command->add_flag("--ask-services", options->attached.ask_services,
                    "Open an Inverse3 for a moment, which gets zero force");
  command->add_flag("--json", options->json, "Print one JSON object");
  command->callback([options] { list_devices(*options); });
}

}  // namespace crumble::app
