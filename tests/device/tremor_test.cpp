#include "crumble/device/tremor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "crumble/base/hash.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/device/poke.hpp"
#include "crumble/device/scripted.hpp"
#include "device/samples.hpp"

namespace crumble {
namespace {

constexpr double kTick = 1e-3;
const Vec3 kStart = {0.01, 0.05, -0.02};
const TremorOptions kPlain = {.start = {kStart, axis_angle({1, 0, 0}, 0.4)}, .amplitude = 2e-4, .seed = 7};

TEST(Tremor, HasTheRootMeanSquareThatWasAskedFor) {
  for (const std::uint64_t seed : {7u, 8u}) {
    TremorOptions options = kPlain;
    options.seed = seed;
    const auto device = open_tremor(options, 0.01);
    read_some(*device, 100);  // it grows
    Vec3 sum = Vec3::Zero();
    const auto samples = read_some(*device, 40'000);
    for (const DeviceSample& sample : samples) {
      sum += (sample.pose.position - kStart).cwiseProduct(sample.pose.position - kStart);
    }
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(std::sqrt(3 * sum[axis] / 40'000), 2e-4, 0.02 * 2e-4) << axis;
    EXPECT_NEAR(std::sqrt(sum.sum() / 40'000), 2e-4, 0.01 * 2e-4);
  }
}

/// Power of x(t) at each multiple of 1 / (n * tick) Hz, by the sum of the definition, through a Hann window.
Vector<double> spectrum(const Vector<double>& x, std::size_t bins) {
  const double n = static_cast<double>(x.size());
  Vector<double> power(bins);
  for (std::size_t bin = 0; bin < bins; ++bin) {
    double re = 0, im = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
      const double turn = 2 * std::numbers::pi * static_cast<double>(k) / n;
      const double angle = turn * static_cast<double>(bin), y = x[k] * (1 - std::cos(turn));
      re += y * std::cos(angle), im += y * std::sin(angle);
    }
    power[bin] = re * re + im * im;
  }
  return power;
}

// Every eighth of the band has one sinusoid, all have the same size, and there is nothing beside.
TEST(Tremor, HasOneWaveInEachEighthOfItsBand) {
  const auto device = open_tremor(kPlain, 0.02);
  read_some(*device, 50);
  const auto samples = read_some(*device, 3200);  // 64 s: bins of 1/64 Hz up to 25
  for (int axis = 0; axis < 3; ++axis) {
    Vector<double> x;
    for (const DeviceSample& sample : samples) x.push_back(sample.pose.position[axis] - kStart[axis]);
    const Vector<double> power = spectrum(x, 1600);
    double all = 0;
    for (const double p : power) all += p;
    for (std::size_t eighth = 0; eighth < 8; ++eighth) {
      double part = 0;
      for (std::size_t bin = 0; bin < 32; ++bin) part += power[8 * 64 + eighth * 32 + bin];
      EXPECT_NEAR(part / all, 0.125, 0.003) << axis << ' ' << eighth;
    }
  }
}

TEST(Tremor, GrowsFromRestAndFadesToRest) {
  TremorOptions options = kPlain;
  options.seconds = 3;
  const auto device = open_tremor(options, kTick);
  EXPECT_EQ(device->info().kind, DeviceKind::tremor);
  EXPECT_TRUE(device->info().step_locked);
  const auto samples = read_some(*device, 3010);
  const auto size = [&](std::size_t k) { return norm(samples[k].pose.position - kStart); };
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const bool finished = k > 3000;
    EXPECT_EQ(samples[k].flags, finished ? sample_flag::kFinished : 0u) << k;
    EXPECT_EQ(samples[k].sequence, k);
    EXPECT_NEAR(samples[k].pose.orientation.x(), std::sin(0.2), 1e-15);
    if (k == 0 || k >= 3000) {
      EXPECT_LT(size(k), 1e-16) << k;
      EXPECT_LT(norm(samples[k].linear_velocity), 1e-12) << k;
    }
    if (k > 0 && k + 1 < samples.size()) {
      // h^2 / 6 of the third derivative: (2 pi f)^3 of 24 waves
      EXPECT_LT(norm(differenced_velocity(&samples[k]) - samples[k].linear_velocity), 1e-4) << k;
    }
  }
  for (std::size_t k = 0; k < 100; ++k) EXPECT_LT(std::max(size(k), size(3000 - k)), 0.0086 * 3 * 2e-4) << k;  // at 0.1
  double speed = 0, middle = 0;
  for (std::size_t k = 1000; k < 2000; ++k) {
    speed += squared_norm(samples[k].linear_velocity) / 1000, middle += size(k) * size(k) / 1000;
  }
  EXPECT_NEAR(std::sqrt(speed / middle), 2 * std::numbers::pi * 10, 2 * std::numbers::pi * 2);
}

TEST(Tremor, OfNoLengthAtAllIsRest) {
  TremorOptions options = kPlain;
  options.seconds = kTick / 2;
  for (const DeviceSample& sample : read_some(*open_tremor(options, kTick), 5)) {
    EXPECT_EQ(sample.pose.position, kStart);
    EXPECT_EQ(sample.linear_velocity, Vec3(0, 0, 0));
  }
}

TEST(Tremor, SeedsDecide) {
  TremorOptions other = kPlain;
  other.seed = 8;
  const auto a = open_tremor(kPlain, kTick), b = open_tremor(kPlain, kTick), c = open_tremor(other, kTick);
  const auto first = read_some(*a, 2000), again = read_some(*b, 2000), third = read_some(*c, 2000);
  double apart = 0;
  for (std::size_t k = 0; k < 2000; ++k) {
    ASSERT_EQ(bits(first[k]), bits(again[k])) << k;
    apart = std::max(apart, norm(first[k].pose.position - third[k].pose.position));
  }
  EXPECT_GT(apart, 2e-4);
}

/// Stands at x = its time, which begins late.
class LateDevice final : public Device {
 public:
  explicit LateDevice(double time) : time_(time) { info_.name = "late"; }
  const DeviceInfo& info() const noexcept override { return info_; }
  ReadStatus read(DeviceSample& sample) noexcept override {
    sample = {};
    sample.time = time_ + 1e-3 * static_cast<double>(count_);
    const ReadStatus status = count_ % 7 == 3 ? ReadStatus::no_new_sample : ReadStatus::ok;
    ++count_;
    return status;
  }
  void write(const Vec3& force, const Vec3&) noexcept override { written = force; }
  void start_servo(const ServoTick&) override { started = true; }
  void stop_servo() noexcept override { started = false; }
  const char* error_text() const noexcept override { return "too late"; }

  Vec3 written = Vec3::Zero();
  bool started = false;

 private:
  DeviceInfo info_;
  double time_;
  int count_ = 0;
};

// After half a year it trembles as on the first day.
TEST(Tremor, RunsForMonths) {
  const auto device = add_tremor(std::make_unique<LateDevice>(1.5e7), kPlain);
  Vector<DeviceSample> samples;
  DeviceSample sample;
  for (int k = 0; k < 3000; ++k) {
    if (device->read(sample) == ReadStatus::ok) samples.push_back(sample);
  }
  double sum = 0;
  for (std::size_t k = 1; k + 1 < samples.size(); ++k) {
    sum += squared_norm(samples[k].pose.position) / static_cast<double>(samples.size());
    if (samples[k + 1].time - samples[k - 1].time > 2.5e-3) continue;  // a sample was not new
    // The time itself is rounded to 2e-9 s
    EXPECT_LT(norm(differenced_velocity(&samples[k]) - samples[k].linear_velocity), 1e-4) << k;
  }
  EXPECT_NEAR(std::sqrt(sum), 2e-4, 0.5e-4);
}

TEST(AddedTremor, IsThatOfTheDeviceOfItsOwn) {
  PokeOptions poke{.start = {kStart, Quat::Identity()}, .in = 0.3, .hold = 1, .out = 0.3};
  const auto still = open_poke(poke, kTick), alone = open_tremor(kPlain, kTick);
  const auto both = add_tremor(open_poke(poke, kTick), kPlain);
  EXPECT_EQ(both->info().kind, DeviceKind::poke);
  EXPECT_EQ(both->info().name, "scripted poke with tremor");
  EXPECT_TRUE(both->info().step_locked);
  DeviceSample a, b, sum;
  for (int k = 0; k <= 1600; ++k) {
    ASSERT_EQ(still->read(a), ReadStatus::ok);
    ASSERT_EQ(alone->read(b), ReadStatus::ok);
    ASSERT_EQ(both->read(sum), ReadStatus::ok);
    EXPECT_EQ(sum.sequence, a.sequence);
    EXPECT_EQ(sum.time, a.time);
    EXPECT_NEAR(norm(sum.pose.position - (a.pose.position + (b.pose.position - kStart))), 0, 1e-16) << k;
    EXPECT_NEAR(norm(sum.linear_velocity - (a.linear_velocity + b.linear_velocity)), 0, 1e-15) << k;
  }
  const Vec3 last = sum.pose.position;
  EXPECT_GT(norm(last - kStart), 1e-5);
  for (int k = 0; k < 5; ++k) {  // held, at rest
    ASSERT_EQ(both->read(sum), ReadStatus::finished);
    EXPECT_NEAR(norm(sum.pose.position - last), 0, 1e-16);
    EXPECT_EQ(sum.linear_velocity, Vec3(0, 0, 0));
  }
}

TEST(AddedTremor, PassesOnWhatIsForTheDevice) {
  auto device = std::make_unique<LateDevice>(0);
  LateDevice& inner = *device;
  const auto outer = add_tremor(std::move(device), kPlain);
  outer->write({1, 2, 3}, Vec3::Zero());
  EXPECT_EQ(inner.written, Vec3(1, 2, 3));
  outer->start_servo({});
  EXPECT_TRUE(inner.started);
  outer->stop_servo();
  EXPECT_FALSE(inner.started);
  EXPECT_STREQ(outer->error_text(), "too late");
}

// One number for every compiler and optimisation level.
TEST(Tremor, BitsAreThoseOfEveryBuild) {
  const auto device = open_tremor(kPlain, 0.0029);
  Hash hash;
  for (const DeviceSample& sample : read_some(*device, 2000)) {
    for (const std::uint64_t word : bits(sample)) hash.add(word);
  }
  EXPECT_EQ(hash.value(), 0x8cd8971416b51503u);
}

TEST(Tremor, RefusesBadOptionsByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto expect = [](const std::function<void(TremorOptions&)>& change, Code code, const std::string& text) {
    TremorOptions options = kPlain;
    change(options);
    const Error error = error_of([&] { open_tremor(options, kTick); });
    EXPECT_EQ(error.code(), code) << error.what() << ", not " << text;
    EXPECT_TRUE(mentions(error, text)) << error.what() << ", not " << text;
  };
  expect([](auto& o) { o.amplitude = 0; }, Code::out_of_range, "tremor.amplitude");
  expect([&](auto& o) { o.amplitude = nan; }, Code::invalid_value, "tremor.amplitude");
  expect([](auto& o) { o.amplitude = 1e300; }, Code::out_of_range, "tremor.amplitude * tremor.high");
  expect([](auto& o) { o.low = 0; }, Code::out_of_range, "tremor.low");
  expect([&](auto& o) { o.low = nan; }, Code::invalid_value, "tremor.low");
  expect([](auto& o) { o.high = 7; }, Code::out_of_range, "tremor.high must lie in [8, 500], is 7");
  expect([](auto& o) { o.high = 501; }, Code::out_of_range, "tremor.high must lie in [8, 500], is 501");
  expect([](auto& o) { o.high = 8; }, Code::out_of_range, "tremor.high - tremor.low");
  expect([](auto& o) { o.seconds = -1; }, Code::out_of_range, "tremor.seconds");
  expect([&](auto& o) { o.seconds = nan; }, Code::invalid_value, "tremor.seconds");
  expect([&](auto& o) { o.start.position.y() = nan; }, Code::bad_pose, "tremor.start");
  EXPECT_EQ(error_of([] { open_tremor(kPlain, 0); }).code(), Code::out_of_range);
  EXPECT_EQ(error_of([] { add_tremor(nullptr, kPlain); }).code(), Code::null);
  const Error slow = error_of([] { add_tremor(open_null({}, 0.1), kPlain); });
  EXPECT_TRUE(mentions(slow, "tremor.high must lie in [8, 5]")) << slow.what();
}

}  // namespace
}  // namespace crumble
