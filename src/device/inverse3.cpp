#include "crumble/device/inverse3.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <limits>
#include <thread>

#include "crumble/base/clock.hpp"
#include "crumble/base/error.hpp"
#include "crumble/base/latest_value.hpp"
#include "crumble/base/memory.hpp"
#include "crumble/base/shared_value.hpp"
#include "crumble/base/text.hpp"
#include "device/inverse3_messages.hpp"
#include "device/websocket_client.hpp"

namespace crumble {
namespace {

using device::Inverse3State;
using device::MessageKind;
using device::WebSocketClient;
using Result = WebSocketClient::Result;

// N. The service tells no limit, and we know of no figure that its maker guarantees; this is what the Haply device of
// Isaac Lab (its option limit_force) keeps to.
constexpr double kFallbackForce = 2.0;
// The service answers each command with one state, as fast as commands come; so this is the rate of both.
constexpr double kPeriod = 1e-3;     // s
constexpr double kStopAge = 0.02;    // s without a write, or without a state, after which the force is zero
constexpr double kSilence = 0.5;     // s without a state after which the device is lost
constexpr double kPatience = 0.1;    // s for the service to take one of our messages
constexpr int kMalformedLimit = 10;  // in a row
constexpr int kBurst = 64;           // messages that are read before the next is sent
constexpr std::size_t kLongestMessage = 64 * 1024;

std::string address(const Inverse3Options& options) {
  return options.host + ":" + std::to_string(options.port);
}

struct Written {
  Vec3 force = Vec3::Zero();  // N
  double time = -std::numeric_limits<double>::infinity();
};

class Inverse3Device final : public Inverse3 {
 public:
  Inverse3Device(std::unique_ptr<WebSocketClient> client, std::string id, const Inverse3State& first)
      : client_(std::move(client)), id_(std::move(id)), opened_(wall_seconds()), last_message_(opened_) {
    info_ = {.name = "Haply Inverse3 " + id_,
             .kind = DeviceKind::inverse3,
             .max_force = kFallbackForce,
             .measured = first.measured,
             .rate = 1 / kPeriod};
    publish(first, opened_);
    thread_ = std::thread([this] { run(); });
  }
  ~Inverse3Device() override {
    stop_.store(true, std::memory_order_relaxed);
    thread_.join();
  }

  const DeviceInfo& info() const noexcept override { return info_; }
  Inverse3Counters counters() const noexcept override { return shared_counters_.load(); }

  ReadStatus read(DeviceSample& sample) noexcept override {
    if (lost_.load(std::memory_order_acquire)) return ReadStatus::lost;
    if (!samples_.fetch()) return ReadStatus::no_new_sample;
    sample = samples_.front();
    return ReadStatus::ok;
  }

  void write(const Vec3& force, const Vec3&) noexcept override {
    const double size = norm(force);
    Written& out = written_.back();
    out.force = Vec3::Zero();
    if (is_finite(force) && std::isfinite(size))
      out.force = size > kFallbackForce ? force * (kFallbackForce / size) : force;
    out.time = wall_seconds();
    written_.publish();
  }

  const char* error_text() const noexcept override {
    return lost_.load(std::memory_order_acquire) ? error_.data() : "";
  }

 private:
  // All below runs in the network thread.

  void run() noexcept {
    try {
      talk();
      client_->write(device::force_command(id_, Vec3::Zero()), kPatience);
      client_->close(kPatience);
    } catch (const std::exception& error) {  // no memory left, say
      lose(error.what());
    }
  }

  void talk() {
    send();
    while (alive()) {
      if (hear(kStopAge)) {
        wait_for_period();
        // More than one when the service had been held up: all are answered at once, lest as many stay under way.
        for (int more = 0; more < kBurst && hear(0); ++more) continue;
      }
      check_silence();
      if (alive()) send();
    }
  }

  bool alive() const noexcept {
    return !stop_.load(std::memory_order_relaxed) && !lost_.load(std::memory_order_relaxed);
  }

  // One message at most; false when none came in time.
  bool hear(double timeout) {
    switch (client_->read(text_, timeout)) {
      case Result::done:
        take();
        return true;
      case Result::too_long:
        ++counters_.messages;
        count_malformed();
        return true;
      case Result::closed:
        lose("the connection to the Haply service is over: " + client_->reason());
        return false;
      case Result::late:
        break;
    }
    return false;
  }

  void take() {
    ++counters_.messages;
    Inverse3State state;
    const MessageKind kind = device::read_state(text_, id_, state);
    // A velocity that was promised and does not come would be a wrong one.
    const bool lacks_velocity =
        kind == MessageKind::state && (info_.measured & ~state.measured & quantity::kLinearVelocity);
    if (kind == MessageKind::malformed || lacks_velocity) return count_malformed();
    malformed_in_a_row_ = 0;
    last_message_ = wall_seconds();
    if (kind == MessageKind::state) publish(state, last_message_);
    shared_counters_.store(counters_);
  }

  void publish(const Inverse3State& state, double now) noexcept {
    const std::uint32_t told = state.measured & info_.measured;
    newest_.time = now - opened_;
    newest_.pose.position = state.position;
    if (told & quantity::kLinearVelocity) newest_.linear_velocity = state.velocity;
    // The grip is another device: what it told last stays.
    if (told & quantity::kOrientation) newest_.pose.orientation = state.orientation;
    if (told & quantity::kButtons) newest_.buttons = state.buttons;
    newest_.sequence = counters_.samples++;
    samples_.back() = newest_;
    samples_.publish();
    last_state_ = now;
  }

  void count_malformed() {
    ++counters_.malformed;
    shared_counters_.store(counters_);
    if (++malformed_in_a_row_ >= kMalformedLimit) {
      lose("what answers speaks no Inverse3 protocol: ten malformed messages in a row");
    }
  }

  void check_silence() {
    const double now = wall_seconds();
    if (now - last_state_ < kSilence) return;
    lose(now - last_message_ < kSilence ? "the Haply service tells nothing of Inverse3 " + id_ + " any more: unplugged?"
                                        : "the Haply service has said nothing of use for 0.5 s");
  }

  void wait_for_period() {
    const double left = last_send_ + kPeriod - wall_seconds();
    if (left > 0) std::this_thread::sleep_for(std::chrono::duration<double>(left));
  }

  void send() {
    const double now = wall_seconds();
    if (client_->write(device::force_command(id_, due_force(now)), kPatience) == Result::late) {
      lose("the Haply service takes no messages any more");
    }
    last_send_ = now;
  }

  Vec3 due_force(double now) {
    written_.fetch();
    const Written& written = written_.front();
    const bool fed = now - written.time < kStopAge;
    if (fed_ && !fed) {
      ++counters_.starved;
      shared_counters_.store(counters_);
    }
    fed_ = fed;
    // Where the hand is now nobody knows when no state has come for so long: no force either.
    return fed && now - last_state_ < kStopAge ? written.force : Vec3::Zero();
  }

  void lose(const std::string& why) noexcept {
    if (lost_.load(std::memory_order_relaxed)) return;
    std::snprintf(error_.data(), error_.size(), "%s", why.c_str());
    lost_.store(true, std::memory_order_release);
  }

  DeviceInfo info_;
  std::unique_ptr<WebSocketClient> client_;
  std::string id_, text_;
  double opened_, last_message_, last_state_ = 0, last_send_ = 0;
  int malformed_in_a_row_ = 0;
  bool fed_ = false;
  DeviceSample newest_;
  Inverse3Counters counters_;

  LatestValue<DeviceSample> samples_{DeviceSample{}};  // from the network thread
  LatestValue<Written> written_{Written{}};            // to the network thread
  SharedValue<Inverse3Counters> shared_counters_;
  std::array<char, 200> error_{};  // written before lost_ is set
  std::atomic<bool> lost_{false}, stop_{false};
  std::thread thread_;
};

struct Found {
  std::string id;
  Inverse3State state;
};

std::string pick(const Vector<std::string>& ids, const Inverse3Options& options) {
  if (ids.empty()) {
    throw Error(Code::device_lost, "no Inverse3 is attached to the Haply service at " + address(options));
  }
  if (options.device_id.empty()) return ids.front();
  if (std::find(ids.begin(), ids.end(), options.device_id) != ids.end()) return options.device_id;
  std::string list;
  for (const std::string& id : ids) list += (list.empty() ? "" : ", ") + id;
  throw Error(Code::device_lost, "no Inverse3 '" + options.device_id + "' is attached to the Haply service at " +
                                     address(options) + ", which has: " + list);
}

[[noreturn]] void refuse_protocol(const Inverse3Options& options) {
  throw Error(Code::format, "what answers at " + address(options) + " speaks no Inverse3 protocol");
}

// The first message lists the devices, with states as a rule; when ours has none yet, a command brings the next
// message.
Found find_device(WebSocketClient& client, const Inverse3Options& options, double deadline) {
  Found found;
  std::string text;
  for (int malformed = 0; malformed < kMalformedLimit;) {
    const Result result = client.read(text, std::max(0.0, deadline - wall_seconds()));
    if (result == Result::closed) {
      throw Error(Code::io, "the Haply service at " + address(options) + " ended the connection: " + client.reason());
    }
    if (result == Result::late && malformed > 0) break;
    if (result == Result::late || wall_seconds() > deadline) {
      throw Error(Code::io, "the Haply service at " + address(options) + " told no state of an Inverse3 within " +
                                to_text(options.timeout) + " s");
    }
    const auto ids = result == Result::done ? device::inverse3_ids(text) : std::nullopt;
    if (ids && found.id.empty()) found.id = pick(*ids, options);
    const MessageKind kind = ids ? device::read_state(text, found.id, found.state) : MessageKind::malformed;
    if (kind == MessageKind::state) return found;
    malformed = kind == MessageKind::malformed ? malformed + 1 : 0;
    if (!found.id.empty()) client.write(device::force_command(found.id, Vec3::Zero()), kPatience);
  }
  refuse_protocol(options);
}

}  // namespace

std::unique_ptr<Inverse3> open_inverse3(const Inverse3Options& options) {
  if (options.host.empty()) throw Error(Code::out_of_range, "inverse3.host is empty");
  if (options.port == 0) throw Error(Code::out_of_range, "inverse3.port is 0");
  require_positive("inverse3.timeout", options.timeout);
  require_in_range("inverse3.timeout", options.timeout, 0, 3600);
  const double deadline = wall_seconds() + options.timeout;
  auto client = std::make_unique<WebSocketClient>(options.host, options.port, options.timeout, kLongestMessage);
  Found found = find_device(*client, options, deadline);
  return std::make_unique<Inverse3Device>(std::move(client), std::move(found.id), found.state);
}

}  // namespace crumble
