#include "device/phantom_values.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "crumble/base/error.hpp"

namespace crumble::device::hd {
namespace {

constexpr double kMillimetre = 1e-3;
constexpr double kMostDamping = 20;  // N s/m: what is above that was meant in another unit

constexpr double kPremiumTorque = 0.188;  // N m, of the six-motor models; for drivers that do not tell

// HDAPI does not tell how fine its encoders are. From secondary sources, not measured by us; the coarsest for others.
struct Resolution {
  const char* model;
  double step;  // m
};
constexpr Resolution kResolutions[] = {{"Desktop", 2.3e-5}, {"Touch X", 2.3e-5}, {"Premium", 3e-5}};
constexpr double kCoarsestStep = 5.5e-5;

double step_of(std::string_view model) {
  for (const Resolution& known : kResolutions) {
    if (model.find(known.model) != std::string_view::npos) return known.step;
  }
  return kCoarsestStep;
}

std::string text(Driver& driver, unsigned what) {
  const char* const told = driver.api().GetString(what);
  return driver.take_error().code == kSuccess && told ? told : "";
}

/// 0 where the driver does not know it, or tells no positive number.
double number(Driver& driver, unsigned what) {
  double told[8] = {};  // more than any of them has
  driver.api().GetDoublev(what, told);
  const bool known = driver.take_error().code == kSuccess && std::isfinite(told[0]) && told[0] > 0;
  return known ? told[0] : 0;
}

int whole(Driver& driver, unsigned what) {
  int told = 0;
  driver.api().GetIntegerv(what, &told);
  return driver.take_error().code == kSuccess ? told : 0;
}

void read_workspace(Driver& driver, DeviceInfo& info) {
  double box[8] = {};
  driver.api().GetDoublev(kUsableWorkspace, box);
  const bool known = driver.take_error().code == kSuccess &&
                     std::ranges::all_of(box, [](double x) { return std::isfinite(x); }) && box[0] < box[3] &&
                     box[1] < box[4] && box[2] < box[5];
  if (!known) return;
  info.workspace_low = kMillimetre * Vec3(box[0], box[1], box[2]);
  info.workspace_high = kMillimetre * Vec3(box[3], box[4], box[5]);
}

}  // namespace

DeviceInfo read_info(Driver& driver, const PhantomOptions& options) {
  const std::string model = text(driver, kModel);
  DeviceInfo info{.name = model.empty() ? "PHANToM of an unknown model" : model, .kind = DeviceKind::phantom};
  const std::string vendor = text(driver, kVendor);
  if (!vendor.empty()) info.name = vendor + " " + info.name;
  info.serial = text(driver, kSerial);
  info.driver = driver.version() + ", driver " + text(driver, kDriverVersion) + ", " + driver.path();
  // The driver derives velocities from positions by a filter of its own that is not described; a loop has a better one.
  info.measured = quantity::kPosition | quantity::kOrientation | quantity::kButtons;
  info.servo_driven = true;
  info.servo_group = &driver;
  info.rate = driver.agree_on_rate(options.rate);
  info.max_force = number(driver, kMaxForce);
  info.continuous_force = number(driver, kContinuousForce);
  info.max_stiffness = number(driver, kMaxStiffness) / kMillimetre;
  const double damping = number(driver, kMaxDamping) / kMillimetre;
  info.max_damping = damping <= kMostDamping ? damping : 0;
  info.max_speed = number(driver, kVelocityLimit) * kMillimetre;
  if (options.torque && whole(driver, kOutputDof) == 6) {
    const double told = number(driver, kMaxTorque);
    info.max_torque = told > 0 ? 1e-3 * told : kPremiumTorque;
  }
  info.position_step = step_of(model);
  read_workspace(driver, info);
  return info;
}

// Gram and Schmidt, then the quaternion by the largest of its squares.
Pose to_pose(const double (&t)[16]) noexcept {
  constexpr double kOff = 0.05;
  Pose pose{kMillimetre * Vec3(t[12], t[13], t[14]), Quat(0, 0, 0, 0)};
  const Vec3 a(t[0], t[1], t[2]), b(t[4], t[5], t[6]), c(t[8], t[9], t[10]);
  const auto unit = [](const Vec3& v) { return std::abs(norm(v) - 1) <= kOff; };
  const bool is_rotation = unit(a) && unit(b) && unit(c) && std::abs(dot(a, b)) <= kOff &&
                           norm(cross(a, b) - c) <= 3 * kOff;  // false for what is not finite too
  if (!is_rotation) return pose;
  const Vec3 x = normalized(a), y = normalized(b - dot(a, b) / dot(a, a) * a), z = cross(x, y);
  Mat3 r;
  r << x.x(), y.x(), z.x(), x.y(), y.y(), z.y(), x.z(), y.z(), z.z();
  pose.orientation = Quat(r);
  return pose;
}

const char* calibration_advice(unsigned styles) noexcept {
  if (styles & kInkwell) return "it is not calibrated: put the stylus into its inkwell";
  if (styles & kAutoCalibration) return "it is not calibrated yet: move the arm about";
  return "it is not calibrated: hold the arm in its reset position and open it with phantom.reset_encoders";
}

void write_error_text(unsigned code, int internal_code, ErrorBuffer& out) noexcept {
  char* to = out.data();
  char* const end = to + out.size() - 1;
  const auto add = [&](std::string_view part) {
    const std::size_t length = std::min(part.size(), static_cast<std::size_t>(end - to));
    to = std::copy_n(part.data(), length, to);
  };
  const ErrorText& error = describe(code);
  add(error.name), add(", internal code ");
  if (const auto written = std::to_chars(to, end, internal_code); written.ec == std::errc{}) to = written.ptr;
  add(": "), add(error.text);
  *to = '\0';
}

}  // namespace crumble::device::hd
