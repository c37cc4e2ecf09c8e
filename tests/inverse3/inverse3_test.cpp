// The device against the double of its service. Nothing here depends on how fast the machine is: what must happen is
// waited for, ten seconds at most.
#include "crumble/device/inverse3.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <limits>
#include <thread>

#include "crumble/device/open.hpp"
#include "device/samples.hpp"
#include "inverse3/fake_service.hpp"
#include "inverse3/messages.hpp"
#include "support/allocation_counter.hpp"
#include "support/lock_counter.hpp"

namespace crumble {
namespace {

using Force = std::array<double, 3>;
constexpr Force kZero = {0, 0, 0};
constexpr std::uint32_t kEverything =
    quantity::kPosition | quantity::kLinearVelocity | quantity::kOrientation | quantity::kButtons;

Inverse3Options options_for(const FakeService& service) {
  return {.host = "127.0.0.1", .port = service.port(), .timeout = 10};
}

// `condition` is asked again and again.
bool soon(const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (std::chrono::steady_clock::now() < end) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return condition();
}

void push(Device& device, const Vec3& force) {
  device.write(force, Vec3::Zero());
}

Reply well(int n) {
  return {state_message(n)};
}

// The n-th reply is another from `first` on, `count` times.
FakeService::Script with_fault(int first, int count, Reply fault) {
  return [=](int n) { return n >= first && n < first + count ? fault : well(n); };
}

Force last_force(const FakeService& service) {
  const auto commands = service.received();
  return commands.empty() ? kZero : force_in(commands.back(), "049D");
}

// A number of samples more than there are now.
bool goes_on(Device& device) {
  int samples = 0;
  DeviceSample sample;
  return soon([&] { return (samples += device.read(sample) == ReadStatus::ok) >= 20; });
}

bool gets_lost(Device& device) {
  DeviceSample sample;
  return soon([&] { return device.read(sample) == ReadStatus::lost; });
}

TEST(Inverse3, TellsWhatItIs) {
  const FakeService service(well);
  const auto device = open_inverse3(options_for(service));
  const DeviceInfo& info = device->info();
  EXPECT_EQ(info.name, "Haply Inverse3 049D");
  EXPECT_EQ(info.kind, DeviceKind::inverse3);
  EXPECT_EQ(info.measured, kEverything);
  EXPECT_EQ(info.rate, 1000);
  EXPECT_EQ(info.max_force, 2);
  EXPECT_FALSE(info.step_locked);
  EXPECT_FALSE(info.servo_driven);
  EXPECT_STREQ(device->error_text(), "");
  EXPECT_EQ(error_of([&] { device->start_servo({}); }).code(), Code::unsupported);
}

TEST(Inverse3, SamplesFollowTheService) {
  const FakeService service(well);
  const auto device = open_inverse3(options_for(service));
  DeviceSample sample;
  ASSERT_EQ(device->read(sample), ReadStatus::ok) << "the one that it was opened with";
  double time = -1, x = -1;
  std::uint64_t sequence = 0;
  ASSERT_TRUE(soon([&] {
    if (device->read(sample) != ReadStatus::ok) return false;
    EXPECT_GT(sample.sequence, sequence);
    EXPECT_GT(sample.time, time);
    EXPECT_GT(sample.pose.position.x(), x);
    EXPECT_NEAR(sample.pose.position.y(), 0.15, 1e-12);
    EXPECT_NEAR(sample.pose.position.z(), 0.12, 1e-12);
    EXPECT_NEAR(norm(sample.linear_velocity - Vec3(0.1, 0.3, -0.2)), 0, 1e-12);
    EXPECT_NEAR(sample.pose.orientation.y(), 0.5, 1e-12);
    EXPECT_TRUE(is_valid(sample.pose));
    EXPECT_EQ(sample.buttons, 5u);
    EXPECT_EQ(sample.flags, 0u);
    time = sample.time, x = sample.pose.position.x(), sequence = sample.sequence;
    return sequence >= 100;
  }));
  const Inverse3Counters counters = device->counters();
  EXPECT_EQ(counters.malformed, 0u);
  EXPECT_EQ(counters.starved, 0u);
  EXPECT_GE(counters.samples, 100u);
  EXPECT_EQ(counters.samples, counters.messages + 1);  // the first was read before the device was there
}

TEST(Inverse3, TheForceReachesTheService) {
  const FakeService service(well);
  const auto device = open_inverse3(options_for(service));
  EXPECT_TRUE(soon([&] {
    push(*device, {0.25, 0.5, 1.5});
    return last_force(service) == Force{0.25, -1.5, 0.5};
  }));
  const double nan = std::numeric_limits<double>::quiet_NaN(), huge = std::numeric_limits<double>::max();
  for (const Vec3& bad :
       {Vec3(nan, 0, 0), Vec3(0, -std::numeric_limits<double>::infinity(), 0), Vec3(huge, huge, huge)}) {
    EXPECT_TRUE(soon([&] { return push(*device, {0, 1, 0}), last_force(service) == Force{0, 0, 1}; }));
    EXPECT_TRUE(soon([&] { return push(*device, bad), last_force(service) == kZero; }));
  }
  EXPECT_TRUE(soon([&] {  // clamped by its norm, not per axis
    push(*device, {30, 40, 0});
    const Force f = last_force(service);
    return std::abs(f[0] - 1.2) < 1e-12 && f[1] == 0 && std::abs(f[2] - 1.6) < 1e-12;
  }));
}

TEST(Inverse3, NoWriteNoForce) {
  const FakeService service(well);
  const auto device = open_inverse3(options_for(service));
  ASSERT_TRUE(soon([&] { return push(*device, {1, 0, 0}), last_force(service) == Force{1, 0, 0}; }));
  ASSERT_TRUE(soon([&] { return last_force(service) == kZero; }));
  EXPECT_TRUE(soon([&] { return device->counters().starved >= 1; }));
  EXPECT_TRUE(goes_on(*device));
  EXPECT_EQ(last_force(service), kZero);
  EXPECT_TRUE(soon([&] { return push(*device, {0, 0, 1}), last_force(service) == Force{0, -1, 0}; }));
}

TEST(Inverse3, TheServiceSilentForAWhile) {
  // Of what is sent in between, one in three is answered: nothing comes by itself, the device has to ask again.
  const FakeService service([](int n) { return n >= 40 && n % 3 ? Reply{{}, Reply::Action::nothing} : well(n); });
  const auto device = open_inverse3(options_for(service));
  ASSERT_TRUE(soon([&] { return push(*device, {1, 0, 0}), service.received().size() >= 60; }));
  DeviceSample sample;
  EXPECT_NE(device->read(sample), ReadStatus::lost) << device->error_text();
  // Each question of its own accord is one without force: where the hand is, is not known.
  const auto commands = service.received();
  int without = 0;
  for (std::size_t i = 40; i < 60; ++i) without += force_in(commands[i], "049D") == kZero;
  EXPECT_GE(without, 10);
}

struct Fault {
  const char* name;
  Reply reply;
  int count;  // of such replies
  const char* text;
  bool malformed;
};
constexpr int kForEver = 1'000'000;

void PrintTo(const Fault& fault, std::ostream* out) {
  *out << fault.name;
}

class Faults : public testing::TestWithParam<Fault> {};
class FewFaults : public Faults {};

TEST_P(Faults, LoseTheDeviceForGood) {
  const Fault& fault = GetParam();
  const FakeService service(with_fault(5, fault.count, fault.reply));
  const auto device = open_inverse3(options_for(service));
  DeviceSample sample;
  ASSERT_TRUE(gets_lost(*device));
  EXPECT_NE(std::string(device->error_text()).find(fault.text), std::string::npos) << device->error_text();
  sample.sequence = 4711;
  for (int i = 0; i < 50; ++i) {
    push(*device, {1, 0, 0});
    EXPECT_EQ(device->read(sample), ReadStatus::lost);
  }
  EXPECT_EQ(sample.sequence, 4711u) << "touched";
  EXPECT_EQ(device->counters().malformed, fault.malformed ? 10u : 0u);
}

TEST_P(FewFaults, AreBorne) {
  const Fault& fault = GetParam();
  const int count = fault.reply.action == Reply::Action::nothing ? 1 : 9;
  const FakeService service(with_fault(5, count, fault.reply));
  const auto device = open_inverse3(options_for(service));
  EXPECT_TRUE(goes_on(*device)) << device->error_text();
  EXPECT_TRUE(soon([&] { return !fault.malformed || device->counters().malformed == 9; }));
  EXPECT_STREQ(device->error_text(), "");
}

const std::string kProtocol = "speaks no Inverse3 protocol";
const Fault kLastOnes[] = {
    Fault{"Dropped", {{}, Reply::Action::drop}, 1, "connection to the Haply service is over", false},
    Fault{"Closed", {{}, Reply::Action::bye}, 1, "closed by the other side", false},
    Fault{"BadText", {"\xff\xfe\xfd"}, 1, "connection to the Haply service is over", false}};
const Fault kBearable[] = {
    Fault{"Silent", {{}, Reply::Action::nothing}, kForEver, "said nothing of use for 0.5 s", false},
    Fault{"Garbage", {"hello"}, 10, kProtocol.c_str(), true},
    Fault{"Empty", {""}, 10, kProtocol.c_str(), true},
    Fault{"HalfJson", {state_message(5).substr(0, 150)}, 10, kProtocol.c_str(), true},
    Fault{"Huge", {"{\"a\":\"" + std::string(200'000, 'x') + "\"}"}, 10, kProtocol.c_str(), true},
    Fault{"HugeState", {state_message(5) + std::string(70'000, ' ')}, 10, kProtocol.c_str(), true},
    Fault{"Null", {message(device_entry("049D", R"({"x":null,"y":0,"z":0})"))}, 10, kProtocol.c_str(), true},
    Fault{"NotFinite", {message(device_entry("049D", R"({"x":1e999,"y":0,"z":0})"))}, 10, kProtocol.c_str(), true},
    Fault{"WrongType", {message(device_entry("049D", "[0,0,0]"))}, 10, kProtocol.c_str(), true},
    Fault{"NoVelocity",
          {R"({"inverse3":[{"device_id":"049D","state":{"cursor_position":{"x":0,"y":0,"z":0}}}]})"},
          10,
          kProtocol.c_str(),
          true},
    Fault{"Unplugged", {message("")}, kForEver, "nothing of Inverse3 049D any more", false},
    Fault{"NoStates", {R"({"session_id":7})"}, kForEver, "nothing of Inverse3 049D any more", false},
    Fault{"OnlyTheOther", {message(device_entry("0A11", place(0)))}, kForEver, "nothing of Inverse3 049D", false}};
std::string name_of(const testing::TestParamInfo<Fault>& tested) {
  return tested.param.name;
}
INSTANTIATE_TEST_SUITE_P(Once, Faults, testing::ValuesIn(kLastOnes), name_of);
INSTANTIATE_TEST_SUITE_P(Many, Faults, testing::ValuesIn(kBearable), name_of);
INSTANTIATE_TEST_SUITE_P(Few, FewFaults, testing::ValuesIn(kBearable), name_of);

TEST(Inverse3, OnlyTenInARowAreTooMany) {
  const FakeService service([](int n) { return n % 10 ? Reply{"hello"} : well(n); });
  const auto device = open_inverse3(options_for(service));
  EXPECT_TRUE(soon([&] { return device->counters().malformed >= 50; })) << device->error_text();
  EXPECT_STREQ(device->error_text(), "");
}

TEST(Inverse3, FreezesAndIsLost) {
  const FakeService service(with_fault(5, 1, {{}, Reply::Action::freeze}));
  const auto device = open_inverse3(options_for(service));
  EXPECT_TRUE(gets_lost(*device));
}

TEST(Inverse3, AForceIsTakenBackWhenTheDeviceIsLost) {
  const FakeService service(with_fault(200, kForEver, {"hello"}));
  const auto device = open_inverse3(options_for(service));
  DeviceSample sample;
  ASSERT_TRUE(soon([&] { return push(*device, {1, 0, 0}), device->read(sample) == ReadStatus::lost; }));
  EXPECT_TRUE(soon([&] { return last_force(service) == kZero && service.saw_close(); }));
}

TEST(Inverse3, PicksOneOfTwo) {
  const FakeService service([](int n) {
    return Reply{message(device_entry("049D", place(1)) + "," + device_entry("0A11", place(n + 1000)))};
  });
  Inverse3Options options = options_for(service);
  EXPECT_EQ(open_inverse3(options)->info().name, "Haply Inverse3 049D");
  options.device_id = "0A11";
  {
    const auto device = open_inverse3(options);
    EXPECT_EQ(device->info().name, "Haply Inverse3 0A11");
    DeviceSample sample;
    ASSERT_EQ(device->read(sample), ReadStatus::ok);
    EXPECT_GE(sample.pose.position.x(), 0.01);
    EXPECT_TRUE(goes_on(*device));
  }
  EXPECT_EQ(force_in(service.received().back(), "0A11"), kZero);
  options.device_id = "FFFF";
  const Error error = error_of([&] { open_inverse3(options); });
  EXPECT_EQ(error.code(), Code::device_lost);
  EXPECT_TRUE(mentions(error, "'FFFF'") && mentions(error, "049D, 0A11")) << error.what();
}

TEST(Inverse3, WithoutAGrip) {
  const FakeService service([](int n) { return Reply{state_message(n, n < 5 ? "" : kGrip)}; });
  const auto device = open_inverse3(options_for(service));
  EXPECT_EQ(device->info().measured, quantity::kPosition | quantity::kLinearVelocity);
  ASSERT_TRUE(goes_on(*device));
  DeviceSample sample;
  ASSERT_TRUE(soon([&] { return device->read(sample) == ReadStatus::ok; }));
  EXPECT_EQ(sample.pose.orientation.w(), 1) << "a grip that turned up later is not looked at";
  EXPECT_EQ(sample.buttons, 0u);
}

TEST(Inverse3, AGripThatGoesLeavesItsOrientation) {
  const FakeService service([](int n) { return Reply{state_message(n, n < 5 ? kGrip : "")}; });
  const auto device = open_inverse3(options_for(service));
  ASSERT_TRUE(goes_on(*device));
  DeviceSample sample;
  ASSERT_TRUE(soon([&] { return device->read(sample) == ReadStatus::ok; }));
  EXPECT_NEAR(sample.pose.orientation.y(), 0.5, 1e-12);
}

TEST(Inverse3, WaitsForAFirstState) {
  const FakeService service(
      [](int n) { return n < 3 ? Reply{R"({"inverse3":[{"device_id":"049D","config":{}}]})"} : well(n); });
  const auto device = open_inverse3(options_for(service));
  EXPECT_EQ(force_in(service.received().front(), "049D"), kZero);
  EXPECT_TRUE(goes_on(*device));
}

TEST(Inverse3, LeavesWithZeroForceAndAGoodbye) {
  const FakeService service(well);
  {
    const auto device = open_inverse3(options_for(service));
    ASSERT_TRUE(soon([&] { return push(*device, {1, 0, 0}), last_force(service) == Force{1, 0, 0}; }));
  }
  EXPECT_TRUE(soon([&] { return service.saw_close(); }));
  EXPECT_EQ(last_force(service), kZero);
  EXPECT_TRUE(goes_on(*open_inverse3(options_for(service)))) << "the next one";
}

TEST(Inverse3, LeavesAServiceThatHangs) {
  for (const auto action : {Reply::Action::nothing, Reply::Action::freeze}) {
    const FakeService service(with_fault(5, kForEver, {{}, action}));
    auto device = open_inverse3(options_for(service));
    ASSERT_TRUE(soon([&] { return service.received().size() >= 5; }));
    const auto start = std::chrono::steady_clock::now();
    device.reset();
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
  }
}

TEST(Inverse3, ReadAndWriteNeitherAllocateNorLock) {
  if (!AllocationCounter::available() || !LockCounter::available()) GTEST_SKIP() << "a sanitizer stands there";
  const FakeService service(with_fault(300, kForEver, {{}, Reply::Action::drop}));
  const auto device = open_inverse3(options_for(service));
  DeviceSample sample;
  std::size_t seen = 0;
  ASSERT_TRUE(soon([&] {
    const AllocationCounter allocations;
    const LockCounter locks;
    const ReadStatus status = device->read(sample);
    push(*device, {1, 2, 3});
    static_cast<void>(device->error_text());
    seen += allocations.count() + locks.count();
    return status == ReadStatus::lost;  // and then too
  }));
  EXPECT_EQ(seen, 0u);
}

void expect_refusal(const Inverse3Options& options, Code code, const std::string& words) {
  const Error error = error_of([&] { open_inverse3(options); });
  EXPECT_EQ(error.code(), code) << error.what();
  EXPECT_TRUE(mentions(error, words)) << error.what();
}

TEST(Inverse3Refusal, NothingThere) {
  const std::uint16_t port = free_port();
  expect_refusal({.host = "localhost", .port = port}, Code::io,
                 "nothing listens at localhost:" + std::to_string(port) + ": is the Haply service running?");
  // No name at all: no server of names is asked.
  expect_refusal({.host = std::string(300, 'a'), .port = port}, Code::io, "no address is known");
  DeviceDef def{.kind = DeviceKind::inverse3};
  def.inverse3.port = port;
  EXPECT_TRUE(mentions(error_of([&] { open_device(def); }), "nothing listens"));
}

TEST(Inverse3Refusal, SomethingElseThere) {
  const FakeService mute(well, FakeService::Manner::mute), http(well, FakeService::Manner::plain_http);
  expect_refusal({.host = "127.0.0.1", .port = mute.port(), .timeout = 0.1}, Code::io, "answers nothing");
  expect_refusal({.host = "127.0.0.1", .port = http.port(), .timeout = 10}, Code::io, "is no WebSocket");
}

TEST(Inverse3Refusal, AServiceThatIsOfNoUse) {
  const auto refused = [](const Reply& reply, Code code, const std::string& words, double timeout = 10) {
    const FakeService service([=](int) { return reply; });
    expect_refusal({.host = "127.0.0.1", .port = service.port(), .timeout = timeout}, code, words);
  };
  refused({message("")}, Code::device_lost, "no Inverse3 is attached");
  refused({R"({"session_id":7})"}, Code::device_lost, "no Inverse3 is attached");
  refused({"hello"}, Code::format, "speaks no Inverse3 protocol", 0.2);
  refused({std::string(100'000, ' ')}, Code::format, "speaks no Inverse3 protocol", 0.2);
  refused({message(device_entry("049D", "null"))}, Code::format, "speaks no Inverse3 protocol");
  refused({R"({"inverse3":[{"device_id":"049D"}]})"}, Code::io, "no state of an Inverse3 within 0.2 s", 0.2);
  refused({{}, Reply::Action::freeze}, Code::io, "no state of an Inverse3 within 0.2 s", 0.2);
  refused({{}, Reply::Action::bye}, Code::io, "ended the connection");
  refused({{}, Reply::Action::drop}, Code::io, "ended the connection");
}

TEST(Inverse3Refusal, OptionsThatMakeNoSense) {
  expect_refusal({.host = ""}, Code::out_of_range, "inverse3.host");
  expect_refusal({.port = 0}, Code::out_of_range, "inverse3.port");
  expect_refusal({.timeout = 0}, Code::out_of_range, "inverse3.timeout");
  expect_refusal({.timeout = std::numeric_limits<double>::quiet_NaN()}, Code::invalid_value, "inverse3.timeout");
  expect_refusal({.timeout = 1e9}, Code::out_of_range, "inverse3.timeout");
}

}  // namespace
}  // namespace crumble
