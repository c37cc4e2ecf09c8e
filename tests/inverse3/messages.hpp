// Messages as the service sends them, typed from its documentation.
#pragma once

#include <string>

namespace crumble {

inline const std::string kGrip =
    R"("wireless_verse_grip":[{"device_id":"61576","state":{"orientation":{"w":0.5,"x":0.1,"y":0.7,"z":0.5},)"
    R"("buttons":{"a":true,"b":false,"c":true},"hall":3,"battery_level":0.9},"status":{"connected":true}}])";

/// One entry of the list of Inverse3, in Haply's frame, with things around that nobody asked for.
inline std::string device_entry(const std::string& id, const std::string& position,
                                const std::string& velocity = R"({"x":0.1,"y":0.2,"z":0.3})") {
  return R"({"device_id":")" + id +
         R"(","config":{"type":"inverse3","handedness":"right","basis":{"permutation":"XYZ"}},)" +
         R"("state":{"cursor_position":)" + position + R"(,"cursor_velocity":)" + velocity +
         R"(,"angular_position":{"a0":0.0,"a1":0.0,"a2":0.0},"body_orientation":{"w":1.0,"x":0.0,"y":0.0,"z":0.0},)" +
         R"("control_domain":"cartesian","transform":{}},"status":{"in_use":false}})";
}

inline std::string message(const std::string& entries, const std::string& grip = kGrip) {
  return R"({"session_id":7,"inverse3":[)" + entries + "]" + (grip.empty() ? "" : "," + grip) + "}";
}

/// 0.01 mm further right with each n.
inline std::string place(int n) {
  return R"({"x":)" + std::to_string(1e-5 * n) + R"(,"y":-0.12,"z":0.15})";
}

inline std::string state_message(int n, const std::string& grip = kGrip) {
  return message(device_entry("049D", place(n)), grip);
}

}  // namespace crumble
