#include "inverse3/fake_service.hpp"

#include <gtest/gtest.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "crumble/base/memory.hpp"

namespace crumble {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using Tcp = asio::ip::tcp;
using SystemError = boost::system::error_code;

Tcp::endpoint loopback() {
  return {asio::ip::make_address("127.0.0.1"), 0};
}

}  // namespace

// Everything but what is behind the mutex belongs to the server's thread. One client at a time.
class FakeService::Server {
 public:
  Server(Script script, Manner manner) : script_(std::move(script)), manner_(manner), acceptor_(context_, loopback()) {
    port_ = acceptor_.local_endpoint().port();
    accept();
    thread_ = std::thread([this] { context_.run(); });
  }
  ~Server() {
    context_.stop();
    thread_.join();
  }

  std::uint16_t port() const { return port_; }
  Vector<std::string> received() const {
    const std::lock_guard lock(mutex_);
    return received_;
  }
  bool saw_close() const {
    const std::lock_guard lock(mutex_);
    return saw_close_;
  }

 private:
  void accept() {
    acceptor_.async_accept([this](SystemError error, Tcp::socket socket) {
      if (error) return;
      socket_ = std::make_unique<beast::websocket::stream<Tcp::socket>>(std::move(socket));
      if (manner_ == Manner::plain_http) return answer_http();
      if (manner_ == Manner::service) greet();
    });
  }

  void answer_http() {
    static const std::string kAnswer = "HTTP/1.1 200 OK\r\nContent-Length: 5\r\n\r\nhello";
    asio::async_write(socket_->next_layer(), asio::buffer(kAnswer), [](SystemError, std::size_t) {});
  }

  void greet() {
    socket_->async_accept([this](SystemError error) {
      if (!error) act();
    });
  }

  void act() {
    const Reply reply = script_(count_++);
    SystemError ignored;
    switch (reply.action) {
      case Reply::Action::say:
        outgoing_ = reply.text;
        socket_->text(true);
        socket_->async_write(asio::buffer(outgoing_), [this](SystemError error, std::size_t) {
          if (!error) listen();
        });
        break;
      case Reply::Action::nothing:
        listen();
        break;
      case Reply::Action::freeze:
        break;
      case Reply::Action::drop:
        socket_->next_layer().close(ignored);
        accept();
        break;
      case Reply::Action::bye:
        socket_->async_close(beast::websocket::close_code::going_away, [](SystemError) {});
        break;
    }
  }

  void listen() {
    socket_->async_read(incoming_, [this](SystemError error, std::size_t) {
      {
        const std::lock_guard lock(mutex_);
        if (error == beast::websocket::error::closed) saw_close_ = true;
        if (!error) received_.push_back(beast::buffers_to_string(incoming_.data()));
      }
      incoming_.clear();
      if (error) return accept();
      act();
    });
  }

  Script script_;
  Manner manner_;
  int count_ = 0;
  std::uint16_t port_ = 0;
  std::string outgoing_;
  beast::flat_buffer incoming_;
  mutable std::mutex mutex_;
  Vector<std::string> received_;
  bool saw_close_ = false;
  asio::io_context context_{1};
  Tcp::acceptor acceptor_;
  std::unique_ptr<beast::websocket::stream<Tcp::socket>> socket_;
  std::thread thread_;
};

FakeService::FakeService(Script script, Manner manner) : server_(std::make_unique<Server>(std::move(script), manner)) {}
FakeService::~FakeService() = default;
std::uint16_t FakeService::port() const {
  return server_->port();
}
Vector<std::string> FakeService::received() const {
  return server_->received();
}
bool FakeService::saw_close() const {
  return server_->saw_close();
}

std::uint16_t free_port() {
  asio::io_context context;
  return Tcp::acceptor(context, loopback()).local_endpoint().port();
}

std::array<double, 3> force_in(const std::string& command, const std::string& id) {
  try {
    const auto message = nlohmann::json::parse(command);
    const auto& device = message.at("inverse3").at(0);
    EXPECT_EQ(message.size(), 1u) << command;
    EXPECT_EQ(message.at("inverse3").size(), 1u) << command;
    EXPECT_EQ(device.at("device_id").get<std::string>(), id);
    const auto& values = device.at("commands").at("set_cursor_force").at("values");
    return {values.at("x").get<double>(), values.at("y").get<double>(), values.at("z").get<double>()};
  } catch (const nlohmann::json::exception& error) {
    ADD_FAILURE() << error.what() << " in " << command;
    return {};
  }
}

}  // namespace crumble
