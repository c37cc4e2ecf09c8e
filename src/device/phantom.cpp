#include "crumble/device/phantom.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "crumble/base/clock.hpp"
#include "crumble/base/error.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/text.hpp"
#include "device/check.hpp"
#include "device/hd_driver.hpp"
#include "device/phantom_values.hpp"

namespace crumble {
namespace {

using namespace device;

constexpr double kLeastRate = 500, kMostRate = 8000;  // Hz
constexpr std::uint64_t kCalibrationTicks = 100;      // from one look at a device that is calibrated to the next
constexpr double kHot = 1;                            // of DeviceSample::motor_temperature

class PhantomDevice final : public Device {
 public:
  PhantomDevice(hd::Driver& driver, hd::Place& place, const PhantomOptions& options)
      : driver_(driver), api_(driver.api()), place_(place), tip_(options.tip), disable_(options.disable_on_close) {}
  ~PhantomDevice() override { driver_.close(place_, disable_); }

  /// The device is the current one. Throws Error, see open_phantom.
  void set_up(const PhantomOptions& options) {
    info_ = hd::read_info(driver_, options);
    gives_torque_ = info_.max_torque > 0;
    int style = 0;
    api_.GetIntegerv(hd::kCalibrationStyle, &style);
    style_ = static_cast<unsigned>(style);
    if (options.reset_encoders) {
      if (!(style_ & hd::kEncoderReset)) {
        throw Error(Code::unsupported, "phantom.reset_encoders: '" + info_.name + "' is not calibrated that way");
      }
      api_.UpdateCalibration(hd::kEncoderReset);
    }
    api_.Enable(hd::kForceOutput);
    if (const hd::ErrorInfo error = driver_.take_error(); error.code != hd::kSuccess) {
      if (hd::describe(error.code).kind != hd::ErrorClass::warm) {
        throw Error(Code::device_lost, "'" + info_.name + "' cannot be set up: " + driver_.text_of(error));
      }
    }
  }

  const DeviceInfo& info() const noexcept override { return info_; }

  ReadStatus read(DeviceSample& sample) noexcept override {
    if (lost_text_.load(std::memory_order_relaxed)) return ReadStatus::lost;
    end_frame();
    api_.MakeCurrentDevice(place_.handle);
    const bool calibrated = look_at_calibration();
    api_.BeginFrame(place_.handle);
    in_frame_ = true;
    fill(sample);
    if (!look_at_errors(sample)) {
      end_frame();
      return ReadStatus::lost;
    }
    if (!calibrated) sample.flags |= sample_flag::kUncalibrated;
    return ReadStatus::ok;
  }

  // What is written outside the frame that read() began is not sent: this tick's force is zero, or has been sent.
  void write(const Vec3& force, const Vec3& torque) noexcept override {
    if (!in_frame_) return;
    api_.MakeCurrentDevice(place_.handle);
    const double newtons[3] = {force.x(), force.y(), force.z()};
    const double millinewton_metres[3] = {1e3 * torque.x(), 1e3 * torque.y(), 1e3 * torque.z()};
    if (is_finite(force)) api_.SetDoublev(hd::kCurrentForce, newtons);
    if (gives_torque_ && is_finite(torque)) api_.SetDoublev(hd::kCurrentGimbalTorque, millinewton_metres);
    end_frame();
  }

  void start_servo(const ServoTick& tick) override {
    tick_ = tick;
    driver_.start(place_, {run, this});
  }
  void stop_servo() noexcept override { driver_.stop(place_); }
  const char* error_text() const noexcept override {
    if (const char* const lost = lost_text_.load(std::memory_order_acquire)) return lost;
    if (const char* const advice = advice_.load(std::memory_order_relaxed)) return advice;
    return force_off_text_.load(std::memory_order_relaxed);
  }

 private:
  static bool run(void* self) noexcept {
    auto& device = *static_cast<PhantomDevice*>(self);
    const bool again = device.tick_.call(device.tick_.context);
    device.end_frame();  // one that nobody has written to
    return again;
  }

  void end_frame() noexcept {
    if (!in_frame_) return;
    api_.MakeCurrentDevice(place_.handle);
    api_.EndFrame(place_.handle);
    in_frame_ = false;
  }

  // Outside the frame, since an update may move the position. In its tick the device still counts as uncalibrated.
  bool look_at_calibration() noexcept {
    if (calibrated_ && ++ticks_since_look_ < kCalibrationTicks) return true;
    ticks_since_look_ = 0;
    const unsigned state = api_.CheckCalibration();
    if (state == hd::kCalibrationNeedsUpdate) api_.UpdateCalibration(style_ & ~hd::kEncoderReset);
    calibrated_ = state == hd::kCalibrationOk;
    advice_.store(calibrated_ ? nullptr : hd::calibration_advice(style_), std::memory_order_relaxed);
    return calibrated_;
  }

  void fill(DeviceSample& sample) noexcept {
    double transform[16] = {}, velocity[3] = {}, turning[3] = {}, heat[6] = {};
    int buttons = 0;
    api_.GetDoublev(hd::kCurrentTransform, transform);
    api_.GetDoublev(hd::kCurrentVelocity, velocity);
    api_.GetDoublev(hd::kCurrentAngularVelocity, turning);
    api_.GetDoublev(hd::kMotorTemperature, heat);
    api_.GetIntegerv(hd::kCurrentButtons, &buttons);
    sample = {};
    sample.time = wall_seconds() - opened_;
    sample.sequence = count_++;
    sample.buttons = static_cast<std::uint32_t>(buttons) & 0xFu;
    sample.pose = hd::to_pose(transform);
    sample.angular_velocity = {turning[0], turning[1], turning[2]};
    const Vec3 arm = rotate(rotation_matrix(sample.pose.orientation), tip_);
    sample.linear_velocity = 1e-3 * Vec3(velocity[0], velocity[1], velocity[2]) + cross(sample.angular_velocity, arm);
    sample.pose.position += arm;
    sample.motor_temperature = *std::ranges::max_element(heat);
  }

  /// False when the device is lost.
  bool look_at_errors(DeviceSample& sample) noexcept {
    driver_.sort_errors();
    if (place_.warm.exchange(false, std::memory_order_relaxed)) sample.motor_temperature = kHot;
    if (const std::uint64_t lost = place_.lost.load(std::memory_order_relaxed)) {
      hd::write_error_text(static_cast<unsigned>(lost >> 32), static_cast<int>(lost & 0xFFFFFFFFu), lost_buffer_);
      lost_text_.store(lost_buffer_.data(), std::memory_order_release);
      return false;
    }
    if (const unsigned code = place_.force_off.exchange(0, std::memory_order_relaxed)) {
      force_off_text_.store(hd::describe(code).text, std::memory_order_relaxed);
      sample.flags |= sample_flag::kForceOff;
    }
    return true;
  }

  hd::Driver& driver_;
  const hd::Api& api_;
  hd::Place& place_;
  DeviceInfo info_;
  Vec3 tip_;
  bool disable_, gives_torque_ = false;
  unsigned style_ = 0;
  double opened_ = wall_seconds();

  // The servo thread's
  ServoTick tick_;
  bool in_frame_ = false, calibrated_ = false;
  std::uint64_t count_ = 0, ticks_since_look_ = 0;
  hd::ErrorBuffer lost_buffer_{};                // written once, before lost_text_
  std::atomic<const char*> lost_text_{nullptr};  // of a lost device
  std::atomic<const char*> advice_{nullptr};     // of one that is not calibrated
  std::atomic<const char*> force_off_text_{""};  // why the driver took the force away, the last time
};

void check(const PhantomOptions& o) {
  require_finite("phantom.rate", o.rate);
  require_in_range("phantom.rate", o.rate, kLeastRate, kMostRate);
  require_vector("phantom.tip", o.tip);
}

// A named device is that one or none: another might be in somebody else's hand.
Vector<const char*> names_of(const PhantomOptions& options) {
  if (!options.name.empty()) return {options.name.c_str()};
  return {nullptr, "Default Device", "Default PHANToM"};  // the first fails with some installations
}

}  // namespace

std::unique_ptr<Device> open_phantom(const PhantomOptions& options) {
  check(options);
  hd::Driver& driver = hd::Driver::get(options.library);
  if (!options.license_vendor.empty() &&
      !driver.has_license(options.license_vendor, options.license_application, options.license_password)) {
    throw Error(Code::unsupported, "the driver refuses the deployment license of phantom.license_application '" +
                                       options.license_application + "'");
  }
  auto device = std::make_unique<PhantomDevice>(driver, driver.open(names_of(options)), options);
  device->set_up(options);
  return device;
}

PhantomLibrary find_phantom_library(const std::string& library) {
  try {
    hd::Driver& driver = hd::Driver::get(library);
    return {driver.path(), driver.version(), {}};
  } catch (const Error& error) {
    return {{}, {}, error.what()};
  }
}

}  // namespace crumble
