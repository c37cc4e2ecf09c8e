// A double of Haply's service, in the test's own process: a WebSocket server on a port that the system picks.
//
// What it does is what docs.haply.co says of the simulation channel: when a client connects it is sent the list of
// devices, and from then on one state for each message that it sends. It shares no code and no constant with the
// adapter. What the real service does otherwise, this does not know.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "crumble/base/memory.hpp"

namespace crumble {

struct Reply {
  enum class Action : std::uint8_t {
    say,      // sends `text`
    nothing,  // does not answer this one
    freeze,   // answers nothing and reads nothing, from now on
    drop,     // breaks the connection off
    bye,      // closes it as the WebSocket protocol has it
  };
  std::string text = {};
  Action action = Action::say;
};

class FakeService {
 public:
  /// What it is to those that connect.
  enum class Manner : std::uint8_t { service, mute, plain_http };
  /// The reply to the n-th message of the client; 0 is what it says when one connects. Called in the double's thread.
  using Script = std::function<Reply(int n)>;

  explicit FakeService(Script script, Manner manner = Manner::service);
  ~FakeService();
  FakeService(const FakeService&) = delete;
  FakeService& operator=(const FakeService&) = delete;

  std::uint16_t port() const;
  /// All that clients sent, in its order.
  Vector<std::string> received() const;
  /// Whether a client has said goodbye as it should.
  bool saw_close() const;

 private:
  class Server;
  std::unique_ptr<Server> server_;
};

/// A port of this machine at which nothing listens.
std::uint16_t free_port();

/// x, y, z of set_cursor_force in a command for `id`, as the service would take it. A failure of the test when it is
/// no such command.
std::array<double, 3> force_in(const std::string& command, const std::string& id);

}  // namespace crumble
