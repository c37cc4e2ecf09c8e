// The one file with Boost. Asynchronous operations on a context that only this thread runs, and only while it waits for
// one of them: that is how Asio's blocking calls get a deadline. A read whose time is over is not cancelled, since a
// WebSocket does not survive that; it goes on at the next call.
#include "device/websocket_client.hpp"

#include <array>
#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>

#include "crumble/base/error.hpp"

namespace crumble::device {
namespace {

namespace asio = boost::asio;
namespace websocket = boost::beast::websocket;
using Tcp = asio::ip::tcp;
using SystemError = boost::system::error_code;
using Clock = std::chrono::steady_clock;

Clock::time_point after(double seconds) {
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

[[noreturn]] void fail(const std::string& where, const std::string& what) {
  throw Error(Code::io, what + " at " + where + ": is the Haply service running?");
}

}  // namespace

class WebSocketClient::Connection {
 public:
  Connection(const std::string& host, std::uint16_t port, double timeout, std::size_t longest_message)
      : longest_(longest_message), socket_(context_) {
    const std::string where = host + ":" + std::to_string(port);
    const Clock::time_point deadline = after(timeout);
    connect(host, port, where, deadline);
    SystemError ignored;
    socket_.next_layer().set_option(Tcp::no_delay(true), ignored);  // each message is waited for by the other side
    socket_.read_message_max(0);                                    // read() has its own limit, and lives on
    shake_hands(where, deadline);
    socket_.text(true);
  }

  Result read(std::string& message, double timeout) {
    const Clock::time_point deadline = after(timeout);
    while (reason_.empty()) {
      if (!reading_) start_read();
      if (!wait(reading_, deadline)) return Result::late;
      if (read_error_) return over(read_error_);
      take_chunk();
      if (!socket_.is_message_done()) continue;
      const bool too_long = too_long_;
      message.swap(partial_);
      partial_.clear();
      too_long_ = false;
      return too_long ? Result::too_long : Result::done;
    }
    return Result::closed;
  }

  Result write(std::string_view text, double timeout) {
    if (!reason_.empty()) return Result::closed;
    if (writing_) return Result::late;
    outgoing_ = text;
    writing_ = true;
    socket_.async_write(asio::buffer(outgoing_), [this](SystemError error, std::size_t) {
      writing_ = false;
      write_error_ = error;
    });
    if (!wait(writing_, after(timeout))) return Result::late;
    return write_error_ ? over(write_error_) : Result::done;
  }

  void close(double timeout) {
    if (!reason_.empty() || writing_) return;
    bool closing = true;
    socket_.async_close(websocket::close_code::normal, [&closing](SystemError) { closing = false; });
    const bool closed = wait(closing, after(timeout));
    SystemError ignored;
    socket_.next_layer().close(ignored);
    if (!closed) wait(closing, after(1));  // closed under it, it ends at once, and with it the use of `closing`
    reason_ = "closed by this side";
  }

  const std::string& reason() const noexcept { return reason_; }

 private:
  // Runs the context until `busy` is false; false when the time is over first.
  bool wait(const bool& busy, Clock::time_point deadline) {
    context_.restart();
    while (busy) {
      if (context_.poll_one() > 0) continue;  // what is there already is not late, whatever the deadline
      if (context_.run_one_until(deadline) == 0) return !busy;
    }
    return true;
  }

  void connect(const std::string& host, std::uint16_t port, const std::string& where, Clock::time_point deadline) {
    Tcp::resolver resolver(context_);
    SystemError error;
    Tcp::resolver::results_type addresses;
    bool busy = true;
    resolver.async_resolve(host, std::to_string(port), [&](SystemError e, const Tcp::resolver::results_type& found) {
      busy = false, error = e, addresses = found;
    });
    if (!wait(busy, deadline)) {
      resolver.cancel();
      context_.run();
      fail(where, "no address was found in time");
    }
    if (error && host == "localhost") {  // a system without a table of names: RFC 6761 says what it means
      const auto loopback = asio::ip::address_v4::loopback();
      addresses = Tcp::resolver::results_type::create(Tcp::endpoint(loopback, port), host, std::to_string(port));
    } else if (error) {
      fail(where, "no address is known (" + error.message() + ")");
    }
    busy = true;
    asio::async_connect(socket_.next_layer(), addresses, [&](SystemError e, const Tcp::endpoint&) {
      busy = false;
      error = e;
    });
    if (!wait(busy, deadline)) abandon(), fail(where, "nothing answers in time");
    if (error == asio::error::connection_refused) fail(where, "nothing listens");
    if (error) fail(where, "no connection (" + error.message() + ")");
  }

  void shake_hands(const std::string& where, Clock::time_point deadline) {
    SystemError error;
    bool busy = true;
    socket_.async_handshake(where, "/", [&](SystemError e) {
      busy = false;
      error = e;
    });
    if (!wait(busy, deadline)) abandon(), fail(where, "something listens and answers nothing");
    if (error) fail(where, "what answers is no WebSocket (" + error.message() + ")");
  }

  // Ends what is under way, whose handlers hold on to the locals of the caller.
  void abandon() {
    SystemError ignored;
    socket_.next_layer().close(ignored);
    context_.restart();
    context_.run();
  }

  void start_read() {
    reading_ = true;
    socket_.async_read_some(asio::buffer(chunk_), [this](SystemError error, std::size_t size) {
      reading_ = false;
      read_error_ = error;
      chunk_size_ = size;
    });
  }

  void take_chunk() {
    too_long_ = too_long_ || partial_.size() + chunk_size_ > longest_;
    if (too_long_)
      partial_.clear();
    else
      partial_.append(chunk_.data(), chunk_size_);
  }

  Result over(SystemError error) {
    reason_ = error == websocket::error::closed ? "closed by the other side" : error.message();
    return Result::closed;
  }

  std::array<char, 16384> chunk_;
  std::string partial_, outgoing_, reason_;
  std::size_t chunk_size_ = 0, longest_;
  bool reading_ = false, writing_ = false, too_long_ = false;
  SystemError read_error_, write_error_;
  asio::io_context context_{1};
  websocket::stream<Tcp::socket> socket_;
};

WebSocketClient::WebSocketClient(const std::string& host, std::uint16_t port, double timeout,
                                 std::size_t longest_message)
    : connection_(std::make_unique<Connection>(host, port, timeout, longest_message)) {}
WebSocketClient::~WebSocketClient() = default;

WebSocketClient::Result WebSocketClient::read(std::string& message, double timeout) {
  return connection_->read(message, timeout);
}
WebSocketClient::Result WebSocketClient::write(std::string_view text, double timeout) {
  return connection_->write(text, timeout);
}
void WebSocketClient::close(double timeout) {
  connection_->close(timeout);
}
const std::string& WebSocketClient::reason() const noexcept {
  return connection_->reason();
}

}  // namespace crumble::device
