#include "hw_drivers/gcs/fake/server.h"

#include <array>
#include <utility>

#include "hw_drivers/net/steady.h"

namespace enc::gcs {
namespace {

constexpr Duration kTurn{1'000'000};
constexpr std::size_t kMostUnsent = 1U << 20U;  // a client that reads nothing is let go

}  // namespace

Server::Server(Manipulator& machine, const ControllerSettings& settings, const std::string& address,
               std::uint16_t port, Log& log)
    : log_(log), controller_(machine, settings), listener_(net::listen_tcp(address, port)) {
  thread_ = std::thread([this] { serve(); });
}

Server::~Server() {
  end_ = true;
  thread_.join();
}

void Server::serve() noexcept {
  while (!end_) {
    (client_.is_open() ? client_ : listener_).wait(kTurn);
    accept();
    if (client_.is_open()) answer();
    controller_.cycle(Time(net::steady_now()));
  }
}

// A second client is sent away at once, as there is one controller for one.
void Server::accept() {
  net::Socket next = listener_.accept();
  if (!next.is_open()) return;
  // Who came later may have waited for the first to go: what that one still said comes first.
  while (client_.is_open() && answer()) {
  }
  if (client_.is_open()) return log_.say("fake C-887: a second client was refused");
  client_ = std::move(next);
  unsent_.clear();
  controller_.forget_line();
}

bool Server::answer() {
  std::array<char, kMostText> bytes{};
  const std::size_t got = client_.receive(std::as_writable_bytes(std::span(bytes)));
  unsent_.append(controller_.take({bytes.data(), got}));
  if (!unsent_.empty()) unsent_.erase(0, client_.send(std::as_bytes(std::span(unsent_))));
  if ((got == 0 && client_.closed()) || unsent_.size() > kMostUnsent) client_ = {};
  return got > 0;
}

}  // namespace enc::gcs
