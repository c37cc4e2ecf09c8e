// A WebSocket client for one thread, whose calls block until they are done or their time is over.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace crumble::device {

class WebSocketClient {
 public:
  enum class Result : std::uint8_t {
    done = 0,
    late = 1,      // the time was over first; what a read had of a message is kept for the next
    too_long = 2,  // of read(): a message came that is longer than the limit, and was thrown away
    closed = 3,    // the connection is over: see reason(). So it stays.
  };

  /// Connects to ws://host:port/ or throws Error(io). Times in s. Looking up a name that is neither a number nor
  /// localhost may take longer than `timeout`: the system's resolver cannot be interrupted.
  WebSocketClient(const std::string& host, std::uint16_t port, double timeout, std::size_t longest_message);
  /// Breaks the connection off if close() was not called.
  ~WebSocketClient();
  WebSocketClient(const WebSocketClient&) = delete;
  WebSocketClient& operator=(const WebSocketClient&) = delete;

  /// The next message, when the result is done.
  Result read(std::string& message, double timeout);
  /// `late`: the other side takes nothing, and no more can be written.
  Result write(std::string_view text, double timeout);
  /// Says goodbye and waits for the answer that long at most.
  void close(double timeout);
  /// Why the connection is over, in the system's words.
  const std::string& reason() const noexcept;

 private:
  class Connection;
  std::unique_ptr<Connection> connection_;
};

}  // namespace crumble::device
