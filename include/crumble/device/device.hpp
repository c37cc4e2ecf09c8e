// What a haptic device is to the rest: a sample comes out of it, a force goes into it.
//
// A device is open from its construction to its destruction; there is no third state to test for. What it needs
// (a tick period, a file, a library) is given when it is opened, and only opening throws.
//
// Units are SI; positions, velocities and forces are in the device's own right-handed frame: x right, y up, z towards
// the user. device/workspace.hpp maps that frame to the scene.
#pragma once

#include <cstdint>
#include <string>

#include "crumble/base/memory.hpp"
#include "crumble/geometry/pose.hpp"

namespace crumble {

enum class DeviceKind : std::uint8_t {
  null = 0,       // a pose that never moves
  press = 1,      // a scripted straight press
  replay = 2,     // a trajectory from a file
  phantom = 3,    // 3D Systems PHANToM / Touch through HDAPI, which is loaded when one is opened
  custom = 4,     // a class of the user's own that implements Device
  path = 5,       // scripted moves and turns
  hand = 6,       // a simulated hand that holds a simulated device: closes the loop
  poke = 7,       // scripted pokes of least jerk
  tremor = 8,     // a hand that only trembles
  wander = 9,     // a hand that goes from one random place to the next
  inverse3 = 10,  // Haply Inverse3 through its local service: see available_devices()
};

/// What a device senses, or a trajectory holds: bits of a mask.
namespace quantity {
inline constexpr std::uint32_t kPosition = 1u << 0;
inline constexpr std::uint32_t kOrientation = 1u << 1;
inline constexpr std::uint32_t kLinearVelocity = 1u << 2;
inline constexpr std::uint32_t kAngularVelocity = 1u << 3;
inline constexpr std::uint32_t kButtons = 1u << 4;
inline constexpr std::uint32_t kForce = 1u << 5;
inline constexpr std::uint32_t kTorque = 1u << 6;
inline constexpr std::uint32_t kFlags = 1u << 7;
inline constexpr std::uint32_t kAll = (1u << 8) - 1;
}  // namespace quantity

/// Bits of DeviceSample::flags.
namespace sample_flag {
inline constexpr std::uint32_t kResampled = 1u << 0;  // interpolated between recorded rows, not recorded at this time
inline constexpr std::uint32_t kFinished = 1u << 1;   // the script or file is over; the last pose is held
inline constexpr std::uint32_t kUncalibrated = 1u << 2;  // the pose means nothing yet
inline constexpr std::uint32_t kHeld = 1u << 3;          // set by the loop: a glitch, the pose before it stands here
inline constexpr std::uint32_t kForceOff = 1u << 4;      // the device's driver took the force away, see error_text()
}  // namespace sample_flag

/// A limit of 0 is one that the device does not tell.
struct DeviceInfo {
  std::string name = {};  // for people
  DeviceKind kind = DeviceKind::custom;
  double max_force = 0;                          // N, peak
  std::uint32_t measured = quantity::kPosition;  // what is sensed; the rest of a sample is derived or at its default
  double rate = 0;                               // nominal samples per second
  bool step_locked = false;                      // read k is tick k, whatever the wall clock says
  bool servo_driven = false;                     // has a thread of its own that calls the tick: see start_servo()
  double continuous_force = 0;                   // N, that the motors bear for long
  double max_torque = 0;                         // N m; 0 also when it has no motors for it
  double max_stiffness = 0;                      // N/m that its maker holds for stable at 1 kHz
  double max_damping = 0;                        // N s/m, likewise
  double max_speed = 0;                          // m/s, beyond which its driver stops
  double mass = 0;                               // kg, apparent at the tip
  double friction_damping = 0;                   // N s/m of its own, at least
  double position_step = 0;                      // m, of its encoders at the tip
  Vec3 workspace_low = Vec3::Zero();             // m, device frame: corners of where it can be used;
  Vec3 workspace_high = Vec3::Zero();            // equal ones: everywhere
  std::string driver = {};                       // for people: what stands between, its version, where it was found
  std::string serial = {};                       // the maker's number of the device; empty: it tells none
  const void* servo_group = nullptr;  // servo_driven devices with the same one, not null, share a thread: the
                                      // tick of one may read and write the others
};

/// Everything that belongs to one instant.
struct DeviceSample {
  double time = 0;                       // s since the device was opened
  Pose pose = {};                        // device frame
  Vec3 linear_velocity = Vec3::Zero();   // m/s
  Vec3 angular_velocity = Vec3::Zero();  // rad/s, axes of the device frame
  std::uint32_t buttons = 0;             // bit set = pressed
  std::uint32_t flags = 0;               // sample_flag bits
  std::uint64_t sequence = 0;            // counts from 0; a gap means samples that nobody read
  double motor_temperature = 0;          // of the hottest motor, 0 cold to 1 its limit; 0 where it is not sensed
};

enum class ReadStatus : std::uint8_t {
  ok = 0,
  no_new_sample = 1,  // `sample` is untouched
  finished = 2,       // `sample` is filled with the last pose, held at rest
  lost = 3,           // `sample` is untouched, and so it will stay: open the device again
};

/// What a device with a thread of its own calls each period; it reads and writes in there. False: not again.
struct ServoTick {
  bool (*call)(void* context) noexcept = nullptr;
  void* context = nullptr;
};

/// Real-time rule for read and write: no allocation, no lock, no system call that can block, no exception; they are
/// called from one thread at a time.
class Device : public Allocated {
 public:
  virtual ~Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  virtual const DeviceInfo& info() const noexcept = 0;
  /// Fills `sample` with one consistent sample: all its parts belong to the same instant.
  [[nodiscard]] virtual ReadStatus read(DeviceSample& sample) noexcept = 0;
  /// Force (N) and torque (N m) on the hand, device frame, until the next write. A lost device ignores it and says so
  /// at the next read. Limits are the haptics module's work; a device may clamp to max_force but is not trusted to.
  virtual void write(const Vec3& force, const Vec3& torque) noexcept = 0;

  /// Of servo_driven devices: `tick` is called from now on by the device's own thread, until it answers false or
  /// stop_servo() has returned. A device that is not servo_driven throws Error(unsupported).
  virtual void start_servo(const ServoTick& tick);
  /// Returns when the last call has. Does nothing when none is going on.
  virtual void stop_servo() noexcept {}
  /// What is wrong, for people: after lost, with kForceOff or kUncalibrated. Static or kept text; any thread. Empty:
  /// nothing is, or it does not tell.
  virtual const char* error_text() const noexcept { return ""; }

 protected:
  Device() = default;
};

}  // namespace crumble
