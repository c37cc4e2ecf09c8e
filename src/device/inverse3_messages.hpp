// The messages of Haply's service: JSON text on one side, quantities in our frame on the other. No network here.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "crumble/base/memory.hpp"
#include "crumble/device/device.hpp"

namespace crumble::device {

/// What one message tells of one Inverse3 and of the first wireless grip; device frame of device.hpp.
struct Inverse3State {
  std::uint32_t measured = 0;  // quantity bits of what it tells; the rest is at its default
  Vec3 position = Vec3::Zero();
  Vec3 velocity = Vec3::Zero();
  Quat orientation = Quat::Identity();  // unit length
  std::uint32_t buttons = 0;            // a, b, c in bits 0, 1, 2
};

enum class MessageKind : std::uint8_t {
  state = 0,      // tells the position of the device
  other = 1,      // well formed, and does not
  malformed = 2,  // no JSON, or a part of the wrong type, or a number that is not finite
};

/// Fills `state` only when it answers MessageKind::state. Parts that it does not know are ignored.
MessageKind read_state(std::string_view text, std::string_view device_id, Inverse3State& state) noexcept;

/// The ids of all Inverse3 in the message, in its order; nothing when it is malformed.
std::optional<Vector<std::string>> inverse3_ids(std::string_view text);

/// The command that puts `force` (N, device frame of device.hpp, finite) on the device.
std::string force_command(const std::string& device_id, const Vec3& force);

}  // namespace crumble::device
