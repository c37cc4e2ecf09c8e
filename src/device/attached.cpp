#include "crumble/device/attached.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/device/phantom.hpp"

namespace crumble {
namespace {

constexpr const char* kPhantomVendor = "2988";  // 3D Systems' Touch, with products 0302 and 0304

// The first line of a file of the system's; empty if there is none.
std::string line_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

Vector<std::string> phantoms_on_usb(const std::string& folder) {
  Vector<std::string> found;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
    if (line_of(entry.path() / "idVendor") != kPhantomVendor) continue;
    const std::string product = line_of(entry.path() / "product");
    found.push_back("USB " + std::string(kPhantomVendor) + ":" + line_of(entry.path() / "idProduct") +
                    (product.empty() ? "" : " " + product) + " at " + entry.path().filename().string());
  }
  std::ranges::sort(found);
  return found;
}

AttachedDevice ask_inverse3(const Inverse3Options& options) {
  const std::string place = options.host + ":" + std::to_string(options.port);
  try {
    return {DeviceKind::inverse3, open_inverse3(options)->info().name, true, "through its service at " + place};
  } catch (const Error& error) {
    return {DeviceKind::inverse3, "Haply Inverse3", false, error.what()};
  }
}

}  // namespace

Vector<AttachedDevice> attached_devices(const AttachedOptions& options) {
  Vector<AttachedDevice> out;
  const PhantomLibrary library = find_phantom_library(options.library);
  const bool usable = !library.path.empty();
  for (const std::string& name : phantoms_on_usb(options.usb)) {
    out.push_back({DeviceKind::phantom, name, usable,
                   usable ? "through " + library.version + ", " + library.path
                          : "it is there, but its driver is not: " + library.reason});
  }
  if (out.empty() && usable) {
    out.push_back({DeviceKind::phantom, library.version, true,
                   "no such device on USB; one on Ethernet or FireWire can only be tried. Driver: " + library.path});
  }
  if (options.ask_services) out.push_back(ask_inverse3(options.inverse3));
  return out;
}

}  // namespace crumble
